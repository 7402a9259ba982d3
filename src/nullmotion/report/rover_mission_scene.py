"""What the animation of a mission draws: ground, footprints, the way of the rover."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from nullmotion.report.rover_stage import numbers

MOST = 97  # heights along a side of the picture


def scene(travel: Any, field: Any, rover: Any) -> dict[str, Any]:
    """Return the scene of a mission; its clock counts steps."""
    way = distances(travel)
    made: dict[str, Any] = {
        "from": 0,
        "to": max(travel.steps, 1e-9),
        "clock": "Step",
        "steps": travel.steps,
        "ground": _ground(field),
        "corners": numbers(travel.corners),
        "feet": travel.feet.tolist(),
        "left": travel.left.tolist(),
        "turn": travel.turn.tolist(),
        "way": way.tolist(),
        "energy": _summed(travel.energy).tolist(),
        "planned": numbers(travel.path.corners.mean(axis=1)),
        "goal": _above(field, travel.goal),
        "gimbal": None,
    }
    if rover is not None:
        made["gimbal"] = _weights(rover.chassis.vertices, rover.cmg.gimbal_axis).tolist()
    return made


def distances(travel: Any) -> np.ndarray:
    """Return how far the rover has come at each footprint [m], (n + 1,)."""
    return _summed(np.linalg.norm(np.diff(travel.middles, axis=0), axis=1))


def _summed(values: np.ndarray) -> np.ndarray:
    return np.concatenate([[0.0], np.cumsum(values)])


def _ground(field: Any) -> dict[str, Any]:
    """Return heights on a grid that can be drawn at once."""
    left, right, low, high = field.bounds
    spacing = max(field.spacing, max(right - left, high - low) / (MOST - 1))
    columns, rows = (max(2, math.floor(s / spacing + 1e-9) + 1) for s in field.size)
    x = np.linspace(left, right, columns)
    y = np.linspace(low, high, rows)
    heights = field.height(x[None, :], y[:, None])
    return {
        "rows": rows,
        "columns": columns,
        "bounds": [left, right, low, high],
        "heights": numbers(heights),
        "contour": contour(heights),
    }


def contour(heights: np.ndarray) -> float:
    """Return a round distance between contours, about a tenth of the range [m]."""
    wanted = max(float(np.nanmax(heights) - np.nanmin(heights)), 1e-3) / 10
    power = 10.0 ** math.floor(math.log10(wanted))
    return next(power * step for step in (1.0, 2.0, 2.5, 5.0, 10.0) if power * step >= wanted)


def _above(field: Any, place: Any) -> list[float]:
    x, y = (float(v) for v in place)
    z = float(field.height(x, y))
    return [x, y, z if math.isfinite(z) else 0.0]


def _weights(vertices: np.ndarray, axis: np.ndarray) -> np.ndarray:
    """Return weights of the spikes' positions whose sum is an axis fixed in the body, (V,)."""
    table = np.vstack([vertices.T, np.ones(len(vertices))])
    return np.linalg.lstsq(table, np.append(axis, 0.0), rcond=None)[0]
