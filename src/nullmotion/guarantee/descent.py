"""Search over directions of momentum: from a spiral of them down to the local minima.

The least of smooth functions has no kink at its local minima. What is least over rows, planes
and faces can so be polished without derivatives: by a rosette of points around each
candidate, turned between steps and halved where none of its points is lower.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache

import numpy as np
from scipy.spatial import cKDTree

from nullmotion.guarantee.maps import spread_directions

_DIRECTIONS = {1: 2, 2: 2048, 3: 8192}
_RINGS = (1.0, 0.5)  # of the rosette's step
_ARMS = 8
_TURN = 2.399963  # golden angle: no two steps look the same way
_ROUNDS = 80

Values = Callable[[np.ndarray, np.ndarray], np.ndarray]  # directions (k, s, m), of which k


@lru_cache(maxsize=2)
def spiral(m: int) -> tuple[np.ndarray, np.ndarray, float]:
    """Return directions (N, m), the neighbours of each (N, k) and the angle between them."""
    directions = spread_directions(m, _DIRECTIONS[m])
    _, near = cKDTree(directions).query(directions, 2 * m + 3)
    spacing = np.sqrt(4 * np.pi / len(directions)) if m == 3 else 2 * np.pi / len(directions)
    return directions, near[:, 1:], float(spacing)


def valleys(values: np.ndarray, near: np.ndarray, count: int) -> np.ndarray:
    """Return where values (..., N) over the spiral have their least local minima, (..., count)."""
    lowest = (values[..., None] <= values[..., near]).all(axis=-1)
    order = np.argsort(np.where(lowest, values, np.inf), axis=-1, kind="stable")
    return order[..., :count]


def descend(
    values: Values, start: np.ndarray, known: np.ndarray, step: float, tolerance: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return directions (k, m) and values (k,) of the local minima below each start.

    Args:
        values: Function of directions (k, s, m) and of the least values known (k,).
        start: Directions, (k, m).
        known: Their values, (k,).
        step: First size of the rosette [rad].
        tolerance: Size at which it ends [rad].
    """
    best, least = start.copy(), known.copy()
    size, rows = np.full(len(best), step), np.arange(len(best))
    for turn in range(_ROUNDS):
        points = best[:, None] + size[:, None, None] * _rosette(best, turn)
        points /= np.linalg.norm(points, axis=-1, keepdims=True)
        found = values(points, least)
        i = found.argmin(axis=1)
        lower = found[rows, i] < least
        best = np.where(lower[:, None], points[rows, i], best)
        least = np.where(lower, found[rows, i], least)
        size = np.where(lower, size, 0.5 * size)
        if size.max() < tolerance:
            break
    return best, least


def _rosette(at: np.ndarray, turn: int) -> np.ndarray:
    """Return steps (k, s, m) across directions (k, m)."""
    if at.shape[1] == 2:
        across = np.stack([-at[:, 1], at[:, 0]], axis=1)
        return np.array([s * r for r in _RINGS for s in (1, -1)])[None, :, None] * across[:, None]
    least = np.eye(3)[np.abs(at).argmin(axis=1)]
    first = np.cross(at, least)
    first /= np.linalg.norm(first, axis=1, keepdims=True)
    second = np.cross(at, first)
    angles = _TURN * turn + 2 * np.pi * np.arange(_ARMS) / _ARMS
    ring = np.cos(angles)[:, None, None] * first + np.sin(angles)[:, None, None] * second
    return np.concatenate([r * ring for r in _RINGS]).swapaxes(0, 1)
