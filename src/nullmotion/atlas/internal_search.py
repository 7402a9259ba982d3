"""Where |h| is least among the impassable singular points: a mesh of all sheets, then locally."""

from __future__ import annotations

import numpy as np

from nullmotion.array.model import CmgArray
from nullmotion.atlas.internal_local import searched, settled
from nullmotion.atlas.internal_points import ELLIPTIC, Point, momenta
from nullmotion.atlas.surfaces import Surface, surfaces

_PER_SHEET, _MOST = 4, 64  # local minima on the mesh that are looked at
_APART = 0.15  # of the mean momentum; closer ones of a sheet are looked at once
_NEAR = 0.02  # the same for starts by themselves
_RIM = 1e-4  # rad off a gimbal axis from where the search around it starts
_EQUAL = 1e-9  # of the mean momentum


def least(array: CmgArray, signs: np.ndarray, resolution: int) -> list[Point]:
    """Return the lowest local minima of |h| over the elliptic points of sign patterns (k, n).

    The lowest comes first; of equal ones that of the greatest first component of h.
    """
    starts = [p for sheet in surfaces(array, resolution, signs) for p in _lowest(array, sheet)]
    return lowest_from(array, sorted(starts, key=lambda p: p.size)[:_MOST])


def least_near(array: CmgArray, u: np.ndarray, signs: np.ndarray) -> list[Point]:
    """Return the local minima of |h| that are come to from directions (p, m), signs (p, n)."""
    points = momenta(array, u, signs)
    size, starts = np.linalg.norm(points.momentum, axis=1), list[int]()
    for i in np.argsort(size):
        away = np.linalg.norm(points.momentum[starts] - points.momentum[i], axis=1)
        if len(starts) < _MOST and (away > _NEAR * array.mean_momentum).all():
            starts.append(int(i))
    return lowest_from(array, [Point(u[i], signs[i], float(size[i])) for i in starts])


def lowest_from(array: CmgArray, starts: list[Point]) -> list[Point]:
    """Return local minima from starting points in the order of `least`."""
    if not starts:
        return []
    found = [settled(array, p) for p in searched(array, starts)]
    best = min((p.size for p in found), default=0.0)
    scale = float(array.mean_momentum)

    def place(p: Point) -> tuple[float, ...]:
        h = momenta(array, p.u, p.signs).momentum
        tied = p.size < best + _EQUAL * scale
        return (best if tied else p.size, *(-np.round(h / scale, 6)))

    return sorted(found, key=place)


def _lowest(array: CmgArray, sheet: Surface) -> list[Point]:
    """Return the lowest local minima on the mesh of a sheet."""
    there = sheet.kind == ELLIPTIC
    if not there.any():
        return []
    assert array.torque_axes is not None
    h = sheet.momentum - array.torque_axes @ array.momentum_bias
    size = np.where(there, np.linalg.norm(h, axis=1), np.inf)
    around = size.copy()
    for a in range(sheet.cells.shape[1]):
        np.minimum.at(around, sheet.cells[:, a], size[sheet.cells[:, a - 1]])
        np.minimum.at(around, sheet.cells[:, a - 1], size[sheet.cells[:, a]])
    local = np.flatnonzero(there & (size <= around))
    found: list[int] = []
    for i in local[np.argsort(size[local])]:
        if len(found) < _PER_SHEET and all(
            np.linalg.norm(h[i] - h[j]) > _APART * array.mean_momentum for j in found
        ):
            found.append(int(i))
    return [Point(_off_axis(array, sheet, i), sheet.signs, float(size[i])) for i in found]


def _off_axis(array: CmgArray, sheet: Surface, i: int) -> np.ndarray:
    """Return the direction of a point, a little off the gimbal axis if it is on it."""
    if not sheet.rim[i]:
        return np.asarray(sheet.u[i])
    assert array.torque_axes is not None
    axes = array.gimbal_axes @ array.torque_axes.T
    own = int(np.argmax(np.abs(axes @ sheet.u[i])))
    side = sheet.signs[own] * array.rotor_momenta(sheet.delta[i])[own] / array.h0[own]
    u = sheet.u[i] + _RIM * side
    return np.asarray(u / np.linalg.norm(u))
