"""A mesh of the sphere with a hole at each gimbal axis.

Near a gimbal axis the surface is a funnel that ends in a circle. In polar coordinates about
the axis it is smooth, so rings lead from each axis to where the even mesh of the rest begins;
the innermost ring is the axis itself, taken from all sides.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.spatial import ConvexHull

_ROUND = 48  # least directions around an axis
_FUNNEL = 0.25  # rad; radius of a fine mesh's funnels
_APART = 0.4  # largest radius of a funnel over the distance of two axes


def sphere(axes: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return directions, the sides they are come to from, triangles, and which are on an axis.

    Args:
        axes: Unit gimbal axes, each way, (k, 3).
        count: About how many directions.
    """
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
    return u, towards, np.concatenate([*strips, place[hull]]).astype(np.int32), rim


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
