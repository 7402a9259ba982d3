"""Everything an array's momentum space says, for one file and one page."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from nullmotion.array.model import CmgArray
from nullmotion.atlas import envelope
from nullmotion.atlas.bounds import Bounds
from nullmotion.atlas.guaranteed import LEVELS
from nullmotion.atlas.sizes import Failed, Radii, failures, parts, radii
from nullmotion.atlas.state import State, inspect
from nullmotion.atlas.torque import TorqueMap, torque_map

Progress = Callable[[float], None]

MAP_RESOLUTION = 81
_SHARES = (0.2, 0.3, 0.3, 0.2)  # of the time: radii, failures, volume, maps


@dataclass(frozen=True, eq=False)
class Analysis:
    """What an array can hold and give.

    Attributes:
        array: The array.
        max_momentum: Bounds of the largest |h| of any direction [N m s].
        radii: Outer surface, largest ball, nearest impassable point, guarantee.
        volume: Bounds of the reachable momenta's volume [(N m s)^m]; None if not asked for.
        failures: The radii with each CMG failed.
        maps: Best torque capability over planes of momentum space.
        state: One state looked at: its type, and what null motion can do about it.
    """

    array: CmgArray
    max_momentum: Bounds
    radii: Radii
    volume: Bounds | None = None
    failures: tuple[Failed, ...] = ()
    maps: tuple[TorqueMap, ...] = ()
    state: State | None = None

    def as_dict(self) -> dict[str, Any]:
        """Return the numbers of ``analysis.json``, in SI units, angles in degrees."""
        volume = self.volume
        return {
            "array": _array(self.array),
            "omnidirectional_momentum": self.radii.omnidirectional.as_dict(),
            "max_momentum": self.max_momentum.as_dict(),
            "volume": None if volume is None else volume.value,
            "volume_bounds": None if volume is None else volume.as_dict(),
            "guaranteed": [row.as_dict() for row in self.radii.guaranteed],
            "radii": self.radii.as_dict(),
            "failed": [one.as_dict() for one in self.failures],
            "torque_capability": [_map(made) for made in self.maps],
            "state": None if self.state is None else self.state.as_dict(),
        }

    def to_json(self) -> str:
        """Return the numbers as text."""
        return json.dumps(self.as_dict(), indent=2, allow_nan=False) + "\n"


def analyse(
    array: CmgArray,
    gimbal: Any = None,
    levels: Sequence[float] = LEVELS,
    quick: bool = False,
    progress: Progress | None = None,
) -> Analysis:
    """Return an array's envelope, radii, torque maps and one state of it.

    Args:
        array: The array; its end stops are left out.
        gimbal: Gimbal angles to look at [rad], (n,); None for none.
        levels: Torques for the guaranteed radius, over h0 times the rate limit.
        quick: Leave out the volume, failed CMGs and torque maps.
        progress: Called with the finished share. Ctrl-C ends the work.

    Raises:
        InputError: For gimbal angles of another shape, or a torque that is not above 0.
    """
    state = None if gimbal is None else inspect(array, gimbal)
    part = parts(progress, (1.0,) if quick else _SHARES)
    found = radii(array, levels, part[0])
    most = envelope.max_momentum(array)
    if quick:
        return Analysis(array, most, found, state=state)
    lost = failures(array, levels, part[1])
    volume = envelope.volume(array, progress=part[2])
    maps = _maps(array, part[3])
    if progress is not None:
        progress(1.0)
    return Analysis(array, most, found, volume, lost, maps, state)


def _maps(array: CmgArray, progress: Progress | None) -> tuple[TorqueMap, ...]:
    """Return the torque maps that a page shows: planes across each axis, or the one there is."""
    if array.m < 2:
        return ()
    if array.m == 2:
        return (torque_map(array, resolution=MAP_RESOLUTION, progress=progress),)
    assert array.torque_axes is not None
    middle = array.torque_axes @ np.asarray(array.momentum_bias, float)
    part = parts(progress, (1 / 3,) * 3)
    return tuple(
        torque_map(array, np.eye(3)[i], middle[i], MAP_RESOLUTION, progress=part[i])
        for i in range(3)
    )


def _array(array: CmgArray) -> dict[str, Any]:
    limit = np.asarray(array.rate_limit, float)
    return {
        "label": array.label,
        "n": array.n,
        "torque_dimensions": array.m,
        "gimbal_axes": np.asarray(array.gimbal_axes, float).tolist(),
        "spin_axes": np.asarray(array.spin_axes, float).tolist(),
        "h0_Nms": np.asarray(array.h0, float).tolist(),
        "mean_momentum_Nms": float(array.mean_momentum),
        "momentum_bias_Nms": np.asarray(array.momentum_bias, float).tolist(),
        "rate_limit_deg_s": np.degrees(limit).tolist() if np.isfinite(limit).all() else None,
    }


def _map(made: TorqueMap) -> dict[str, Any]:
    """Return where the greatest torque capability is, and how much of the plane is reachable."""
    known = np.isfinite(made.capability)
    greatest = float(made.capability[known].max()) if known.any() else None
    cell = (made.x[1] - made.x[0]) * (made.y[1] - made.y[0])
    return {
        "title": made.title,
        "method": made.method,
        "greatest_Nm": greatest,
        "reachable_area": float(known.sum() * cell),
    }
