"""Maps of torque capability as a page's script reads them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from nullmotion.plot.atlas_maps import axis_name, most_capability, plane_of
from nullmotion.plot.atlas_view import Scene
from nullmotion.report.atlas_coded import Coded, angles

if TYPE_CHECKING:
    from nullmotion.atlas.torque import TorqueMap

_NONE = 65535  # of a cell that no gimbal angles reach


def map_data(scene: Scene, coded: Coded) -> list[dict[str, Any]]:
    """Return a scene's maps: capability in 16 bits, angles in 16 bits where there are any.

    Vectors are three numbers, as momenta are drawn: in body axes for three torque dimensions.
    """
    most = most_capability(scene)
    if most <= 0:
        return []
    return [_map(scene, place, shown, most, coded) for place, shown in enumerate(scene.maps)]


def _map(scene: Scene, place: int, shown: TorqueMap, most: float, coded: Coded) -> dict[str, Any]:
    where = plane_of(shown)
    reached = np.isfinite(where.capability)
    share = np.where(reached, where.capability, 0.0) / most
    value = np.where(reached, np.rint((_NONE - 1) * np.clip(share, 0, 1)), _NONE)
    return {
        "key": f"map-{place}",
        "names": [axis_name(scene, row) for row in where.basis],
        "basis": [_drawn(scene, row) for row in where.basis],
        "origin": _drawn(scene, where.foot),
        "x": [float(where.x[0]), float(where.x[-1]), len(where.x)],
        "y": [float(where.y[0]), float(where.y[-1]), len(where.y)],
        "most": most,
        "value": coded.add(value.astype(np.uint16)),
        "delta": coded.add(angles(where.delta[reached])),
    }


def _drawn(scene: Scene, vector: np.ndarray) -> list[float]:
    axes = scene.array.torque_axes
    assert axes is not None
    made = vector @ axes if scene.array.m == 3 else np.append(vector, 0.0)
    return [float(value) for value in made]
