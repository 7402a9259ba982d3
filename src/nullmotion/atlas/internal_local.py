"""Local searches for the least |h| among elliptic singular points.

Within the elliptic region |h| is stationary where h is along u (dh = C du with C regular). On its
edge, where C is singular, it may be least as well: there it is approached from within. So the
search uses no derivatives: it tries points around and keeps the best that are elliptic, |p_i| at
a time beside gimbal axes, about which the momentum turns fast. Newton's method comes last.
"""

from __future__ import annotations

import numpy as np

from nullmotion.array.model import CmgArray
from nullmotion.atlas.internal_points import Point, clear, momenta, sizes
from nullmotion.singularity import tangents

_TRIES, _ROUNDS = 24, 400
_ALL, _BEST = 40, 8  # rounds with all of them, and how many go on
_FIRST, _LAST = 0.05, 1e-10  # rad; length of a try
_LONGER, _SHORTER = 1.5, 0.75  # after a try that was better, and after none
_DOUBT = 0.05  # of the mean momentum that the first clear point may be beyond a doubtful start
_NEWTON = 12
_LEAST = 1e-6  # |p_i| that Newton's method counts with
_EQUAL, _EXACT = 1e-9, 1e-12  # over the mean momentum


def searched(array: CmgArray, starts: list[Point]) -> list[Point]:
    """Return where local searches end: all for some rounds, then the best to the end."""
    rng = np.random.default_rng(0)
    u, signs = np.array([p.u for p in starts]), np.array([p.signs for p in starts])
    points = momenta(array, u, signs)
    doubt = np.where(clear(array, points), 0.0, _DOUBT * array.mean_momentum)
    size = np.linalg.norm(points.momentum, axis=1) + doubt
    near, length = points.across.min(axis=1), np.full(len(u), _FIRST)
    for turn in range(_ROUNDS):
        if turn == _ALL:
            few = np.argsort(size)[:_BEST]
            u, signs, size, near, length = (v[few] for v in (u, signs, size, near, length))
        found, across, value = _tried(array, u, signs, size, near, length, rng)
        better = value < size
        u, near = np.where(better[:, None], found, u), np.where(better, across, near)
        size = np.where(better, value, size)
        length = np.minimum(length * np.where(better, _LONGER, _SHORTER), _FIRST)
        if length.max() < _LAST:
            break
    good = np.flatnonzero(clear(array, momenta(array, u, signs)))
    return [Point(u[i], signs[i], float(size[i])) for i in good]


def _tried(
    array: CmgArray,
    u: np.ndarray,
    signs: np.ndarray,
    size: np.ndarray,
    near: np.ndarray,
    length: np.ndarray,
    rng: np.random.Generator,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the best of some tries around directions, its least |p_i|, and its |h|."""
    step = rng.normal(size=(len(u), _TRIES, array.m)) * length[:, None, None]
    step[:, ::2] *= np.minimum(1.0, near)[:, None, None]
    tries = u[:, None] + step
    tries /= np.linalg.norm(tries, axis=2, keepdims=True)
    found = momenta(array, tries.reshape(-1, array.m), np.repeat(signs, _TRIES, axis=0))
    value = sizes(array, found, np.repeat(size, _TRIES)).reshape(len(u), _TRIES)
    rows, pick = np.arange(len(u)), np.argmin(value, axis=1)
    across = found.across.min(axis=1).reshape(len(u), _TRIES)
    return tries[rows, pick], across[rows, pick], value[rows, pick]


def settled(array: CmgArray, point: Point) -> Point:
    """Return where |h| is stationary beside a point by Newton's method; the point if nowhere.

    (C - h . u) du = -h in the plane normal to u.
    """
    u, axis = point.u, tangents(point.u)
    for _ in range(_NEWTON):
        axis = tangents(u)
        here = momenta(array, u, point.signs)
        t = np.swapaxes(array.transverse_directions(here.delta), -1, -2) @ axis
        weight = point.signs * np.asarray(array.h0) / np.maximum(here.across, _LEAST)
        slope = t.T @ (weight[:, None] * t) - (here.momentum @ u) * np.eye(array.m - 1)
        if np.linalg.cond(slope) > 1 / _EQUAL:
            return point
        u = u - axis @ np.linalg.solve(slope, axis.T @ here.momentum)
        u = u / np.linalg.norm(u)
    here = momenta(array, u[None], point.signs[None])
    size = float(np.linalg.norm(here.momentum[0]))
    off = np.linalg.norm(here.momentum[0] - (here.momentum[0] @ u) * u)
    scale = float(array.mean_momentum)
    good = off < _EXACT * scale and size < point.size + _EQUAL * scale and clear(array, here)[0]
    return Point(u, point.signs, size) if good else point
