"""Directions for singular surfaces: a closed mesh of the sphere or the circle."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nullmotion.array.model import CmgArray
from nullmotion.atlas.grid_sphere import sphere
from nullmotion.errors import InputError

LEAST, MOST = 50, 1_000_000
_ALONG = 1 - 1e-12  # cosine above which two axes are one


@dataclass(frozen=True, eq=False)
class Grid:
    """Directions and how they hang together.

    Attributes:
        u: Unit directions in the torque space, (P, m).
        towards: Side from which u was come to, for u along a gimbal axis, (P, m).
        cells: Indices of neighbours: triangles (T, 3) for m = 3, turning anticlockwise seen
            from outside; edges (T, 2) for m = 2; the points themselves (2, 1) for m = 1.
        rim: Which directions are along a gimbal axis, (P,).
    """

    u: np.ndarray
    towards: np.ndarray
    cells: np.ndarray
    rim: np.ndarray


def grid(array: CmgArray, resolution: int) -> Grid:
    """Return a closed mesh of about ``resolution`` directions.

    Raises:
        InputError: For a resolution that is not a whole number of 50 to 1e6.
    """
    if not isinstance(resolution, (int, np.integer)) or not LEAST <= resolution <= MOST:
        raise InputError(
            "resolution", resolution, f"a whole number of directions, {LEAST} to {MOST}"
        )
    if array.m == 1:
        u = np.array([[1.0], [-1.0]])
        return Grid(u, u, np.array([[0], [1]]), np.zeros(2, bool))
    axes = hole_axes(array)
    return _circle(axes, resolution) if array.m == 2 else Grid(*sphere(axes, resolution))


def hole_axes(array: CmgArray) -> np.ndarray:
    """Return the gimbal axes that lie in the torque space, each way, without repeats, (k, m)."""
    assert array.torque_axes is not None
    inside = array.gimbal_axes @ array.torque_axes.T
    inside = inside[(np.linalg.norm(inside, axis=1) > _ALONG) & (np.asarray(array.h0) > 0)]
    found: list[np.ndarray] = []
    for axis in inside / np.linalg.norm(inside, axis=1, keepdims=True):
        if all(abs(axis @ other) < _ALONG for other in found):
            found += [axis, -axis]
    return np.reshape(found, (-1, array.m))


def _circle(axes: np.ndarray, count: int) -> Grid:
    """Return a closed polyline; at a gimbal axis in the plane it has two points, one a side."""
    angle = 2 * np.pi * np.arange(count) / count
    at = np.arctan2(axes[:, 1], axes[:, 0]) % (2 * np.pi)
    far = np.abs((angle[:, None] - at + np.pi) % (2 * np.pi) - np.pi) > 1e-9
    angle = angle[far.all(axis=1)] if len(at) else angle
    every = np.concatenate([angle, at, at])
    turn = np.concatenate([np.zeros(len(angle)), -np.ones(len(at)), np.ones(len(at))])
    order = np.lexsort((turn, every))
    u = np.stack([np.cos(every), np.sin(every)], axis=1)[order]
    side = np.stack([-np.sin(every), np.cos(every)], axis=1)[order] * turn[order, None]
    rim = turn[order] != 0
    here = np.arange(len(u))
    cells = np.stack([here, np.roll(here, -1)], axis=1)
    return Grid(u, np.where(rim[:, None], side, u), cells, rim)
