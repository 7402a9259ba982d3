"""Torque capability over momentum space: the most that null motion can make of every momentum.

    best(h) = max { TC(delta) : h(delta) = h } * h_mean * rate        [N m]

TC is `nullmotion.guarantee.torque_capability`, h_mean the mean momentum of the working CMGs and
rate the least rate limit, 1 rad/s where there is none. The maximum is over all gimbal angles of
the momentum, whether null motion connects them or not; gimbals turn freely here, end stops are
not looked at. It is searched for, not proven: a value is attained, a greater one may exist.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from nullmotion.array.capability import torque_capability
from nullmotion.array.capability_batch import scaled_limits
from nullmotion.array.model import CmgArray
from nullmotion.atlas import torque_climb
from nullmotion.atlas.envelope_rings import rings
from nullmotion.atlas.manifold_rotors import Rotors
from nullmotion.atlas.manifold_seeds import held, wrapped
from nullmotion.atlas.torque_plane import Plane, plane
from nullmotion.atlas.torque_search import Search
from nullmotion.atlas.torque_surface import surface_torque
from nullmotion.errors import UnknownNameError

__all__ = ["TorqueMap", "surface_torque", "torque_map"]

RESOLUTION = 81
_STEPS, _MORE = 5, 30  # of Newton's method at the end; where that is slow, at folds
_DIRECTIONS = 600  # that show momenta to be beyond the convex hull


@dataclass(frozen=True, eq=False)
class TorqueMap:
    """The best torque capability over a plane through momentum space, over all null motion.

    Attributes:
        basis: Orthonormal rows that span the plane, (2, m).
        origin: The plane's point closest to zero momentum [N m s], (m,).
        x: Coordinates along the first row [N m s], (k,).
        y: Coordinates along the second row [N m s], (k,).
        capability: Torque capability [N m], (len(y), len(x)); NaN where unreachable.
        delta: Gimbal angles that give it, in [-pi, pi) [rad], (len(y), len(x), n); NaN where
            unreachable. CMGs without momentum stay at 0.
        sigma_min: Least singular value of A over the mean momentum there, (len(y), len(x)).
        title: What is shown.
        method: How torque is shared out to the CMGs.
    """

    basis: np.ndarray
    origin: np.ndarray
    x: np.ndarray
    y: np.ndarray
    capability: np.ndarray
    delta: np.ndarray
    sigma_min: np.ndarray
    title: str
    method: str

    @property
    def momentum(self) -> np.ndarray:
        """The momenta, with the array's bias [N m s], (len(y), len(x), m)."""
        return Plane(self.basis, self.origin, self.x, self.y, False).momenta


def torque_map(
    array: CmgArray,
    normal: Any = None,
    offset: float = 0.0,
    resolution: int = RESOLUTION,
    method: str = "pseudo-inverse",
    progress: Callable[[float], None] | None = None,
) -> TorqueMap:
    """Return the best torque capability on the plane normal . h = offset, h with the array's bias.

    Args:
        array: The array; failed and unequal CMGs, and fewer than torque dimensions, too.
        normal: Vector across the plane, of any length, (3,); z by default. None for an array
            with two torque dimensions, which has one plane.
        offset: normal . h on the plane [N m s].
        resolution: Points along each side of the grid; it covers all that is within reach.
        method: ``pseudo-inverse`` or ``optimal``.
        progress: Called with the share that is done, 0 to 1. Ctrl-C ends it.

    Raises:
        InputError: For one torque dimension, a normal with two, or one without length; a
            plane beyond what the array reaches; a resolution out of range.
        UnknownNameError: For another method.
    """
    if method not in torque_climb.METHODS:
        raise UnknownNameError("method", method, tuple(torque_climb.METHODS))
    there = plane(array, normal, offset, resolution)
    report = progress or (lambda share: None)
    delta = _best(array, there, method, report)
    capability, sigma = (np.full(delta.shape[:-1], np.nan) for _ in range(2))
    reached = np.isfinite(delta[..., 0])
    unit = float(array.mean_momentum) * scaled_limits(array)[1]
    capability[reached] = unit * torque_capability(array, delta[reached], method)  # type: ignore[arg-type]
    sigma[reached] = Rotors(array).sigma_min(delta[reached])
    title = _title(array, there, method)
    report(1.0)
    return TorqueMap(
        there.basis, there.origin, there.x, there.y, capability, delta, sigma, title, method
    )


def _best(
    array: CmgArray, there: Plane, method: str, report: Callable[[float], None]
) -> np.ndarray:
    """Return the angles of the greatest torque capability on a plane's grid, NaN without any."""
    assert array.torque_axes is not None
    working = np.flatnonzero(np.asarray(array.h0) > 0)
    fewer = array if len(working) == array.n else _kept(array, working)
    unit, momenta = float(array.mean_momentum), there.momenta
    h = (momenta - array.torque_axes @ array.momentum_bias) / unit
    climber = torque_climb.climber(fewer, method)
    found, reached = Search(climber, h, _possible(array, h), there.mirrored).best(report)
    angles, good = _polished(fewer, found[reached], momenta.reshape(-1, array.m)[reached])
    delta = np.full((len(reached), array.n), np.nan)
    which = np.flatnonzero(reached)[good]
    delta[which] = 0.0
    delta[which[:, None], working] = wrapped(angles[good])
    return delta.reshape(*h.shape[:2], array.n)


def _kept(array: CmgArray, working: np.ndarray) -> CmgArray:
    return array.without(np.setdiff1d(np.arange(array.n), working).tolist())


def _possible(array: CmgArray, h: np.ndarray) -> np.ndarray:
    """Return which momenta over their unit are not shown to be beyond the convex hull."""
    found = rings(array)
    u = np.random.default_rng(0).normal(size=(_DIRECTIONS, array.m))
    return np.all(h @ u.T <= found.support(u) * (1 + 1e-12), axis=-1)


def _polished(
    array: CmgArray, delta: np.ndarray, momenta: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return angles moved onto their momenta by least steps, and whether they are there."""
    rotors = Rotors(array)

    def far() -> np.ndarray:
        miss: np.ndarray = np.abs(rotors.missing(delta, momenta)).max(axis=1)
        return miss > torque_climb.HELD

    delta = held(rotors, delta, momenta, _STEPS)
    if (slow := far()).any():
        delta[slow] = held(rotors, delta[slow], momenta[slow], _MORE)
    return delta, ~far()


def _title(array: CmgArray, there: Plane, method: str) -> str:
    what = f"{array.label}: torque capability ({method})"
    if array.m == 2:
        return what
    across = np.cross(*there.basis)
    normal = " ".join(f"{v:.4g}" for v in across + 0.0)
    return f"{what} where [{normal}] . h = {float(across @ there.origin) + 0.0:.4g} N m s"
