"""Directions for singular surfaces: a closed mesh of the sphere with a hole at each gimbal axis.

Near a gimbal axis the surface is a funnel that ends in a circle. In polar coordinates about
the axis it is smooth, so rings lead from each axis to where the even mesh of the rest begins;
the innermost ring is the axis itself, taken from all sides.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.spatial import ConvexHull

from nullmotion.array.model import CmgArray
from nullmotion.errors import InputError

LEAST, MOST = 50, 1_000_000
_ROUND = 48  # least directions around an axis
_FUNNEL = 0.25  # rad; radius of a fine mesh's funnels
_APART = 0.4  # largest radius of a funnel over the distance of two axes
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
    return _circle(axes, resolution) if array.m == 2 else _sphere(axes, resolution)


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


def _sphere(axes: np.ndarray, count: int) -> Grid:
    spacing = float(np.sqrt(4 * np.pi / count))
    radius, around, rings = _funnel(axes, spacing)
    caps = [_cap(axis, radius, around, rings) for axis in axes]
    outside = _even(count)
    if len(axes):
        outside = outside[(outside @ axes.T).max(axis=1) < np.cos(radius + 0.6 * spacing)]
    edges = [cap[0][-around:] for cap in caps]
    hull = _hull(np.concatenate([*edges, outside]), around, len(axes))
    size = around * (rings + 1)
    # the outermost ring of each cap, then the even part: where they are in the whole list
    place = np.concatenate(
        [
            *[k * size + np.arange(size - around, size) for k in range(len(axes))],
            len(axes) * size + np.arange(len(outside)),
        ]
    )
    strips = [_strips(around, rings) + k * size for k in range(len(axes))]
    u = np.concatenate([*[cap[0] for cap in caps], outside])
    towards = np.concatenate([*[cap[1] for cap in caps], outside])
    rim = np.zeros(len(u), bool)
    for k in range(len(axes)):
        rim[k * size : k * size + around] = True
    return Grid(u, towards, np.concatenate([*strips, place[hull]]).astype(np.int32), rim)


def _funnel(axes: np.ndarray, spacing: float) -> tuple[float, int, int]:
    """Return the radius of the caps [rad], the directions around each, and the rings of each."""
    radius = max(_FUNNEL, _ROUND * spacing / (2 * np.pi))
    if len(axes) > 1:
        cosine = axes @ axes.T - 2 * np.eye(len(axes))
        radius = min(radius, _APART * float(np.arccos(np.clip(cosine.max(), -1, 1))))
    around = max(_ROUND, round(2 * np.pi * radius / spacing))
    return radius, around, max(3, round(radius / spacing))


def _cap(axis: np.ndarray, radius: float, around: int, rings: int) -> tuple[Any, Any]:
    """Return directions on rings about an axis, the axis itself first, and their sides."""
    e1 = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
    e1 = e1 / np.linalg.norm(e1)
    angle = 2 * np.pi * np.arange(around) / around
    side = np.outer(np.cos(angle), e1) + np.outer(np.sin(angle), np.cross(axis, e1))
    away = radius * np.arange(rings + 1)[:, None, None] / rings
    u = np.cos(away) * axis + np.sin(away) * side
    return u.reshape(-1, 3), np.broadcast_to(side, u.shape).reshape(-1, 3)


def _strips(around: int, rings: int) -> np.ndarray:
    """Return the triangles between the rings of a cap."""
    ring, k = np.meshgrid(np.arange(rings), np.arange(around), indexing="ij")
    inner, outer = ring * around, (ring + 1) * around
    following = (k + 1) % around
    a, b, c, d = inner + k, outer + k, outer + following, inner + following
    return np.stack([[a, b, c], [a, c, d]]).reshape(2, 3, -1).transpose(0, 2, 1).reshape(-1, 3)


def _even(count: int) -> np.ndarray:
    """Return directions spread evenly (Fibonacci's spiral)."""
    k = np.arange(count)
    z = 1 - (2 * k + 1) / count
    azimuth = np.pi * (3 - np.sqrt(5.0)) * k
    radius = np.sqrt(1 - z * z)
    return np.stack([radius * np.cos(azimuth), radius * np.sin(azimuth), z], axis=1)


def _hull(points: np.ndarray, around: int, caps: int) -> np.ndarray:
    """Return the triangles of a sphere's points, without those inside the caps."""
    triangles = np.asarray(ConvexHull(points).simplices)
    corner = points[triangles]
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    inward = np.einsum("tk,tk->t", normal, corner[:, 0]) < 0
    triangles[inward] = triangles[inward][:, [0, 2, 1]]
    owner = np.where(triangles < around * caps, triangles // around, -1)
    inside = (owner[:, 0] >= 0) & (owner == owner[:, :1]).all(axis=1)
    return triangles[~inside]
