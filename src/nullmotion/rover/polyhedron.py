"""Convex polyhedra from their corners: faces, edges, mass centre, inertia; the platonic solids."""

from __future__ import annotations

from itertools import product
from typing import Any, NamedTuple

import numpy as np

from nullmotion.errors import InputError, UnknownNameError

_FLAT = 1e-9  # distance from a face's plane, over the body's size, that counts as in it
_GOLDEN = (1 + 5**0.5) / 2
_CYCLES = ((0, 1, 2), (1, 2, 0), (2, 0, 1))


class Solid(NamedTuple):
    """Volume integrals of a convex body of uniform density.

    Attributes:
        volume: Volume [m^3].
        centre: Centre of mass [m], (3,).
        inertia: Inertia about the centre over the mass [m^2], (3, 3).
    """

    volume: float
    centre: np.ndarray
    inertia: np.ndarray


def checked_points(value: Any) -> np.ndarray:
    """Return finite points (V, 3), V >= 4, or refuse them."""
    points = np.asarray(value, float)
    if points.ndim != 2 or points.shape[1] != 3 or len(points) < 4:
        raise InputError("vertices", points.tolist(), "4 or more points of 3 numbers (m)")
    if not np.isfinite(points).all():
        raise InputError("vertices", points.tolist(), "finite numbers (m)")
    return points


def faces_of(points: np.ndarray) -> list[tuple[int, ...]]:
    """Return the faces of a convex hull, each counter-clockwise seen from inside.

    Seen from inside is seen from above when the face lies on the ground.

    Raises:
        InputError: For points without volume, or one that is no corner of their hull.
    """
    from scipy.spatial import ConvexHull, QhullError

    try:
        hull = ConvexHull(points)
    except (QhullError, ValueError):
        raise InputError("vertices", points.tolist(), "points that span a volume") from None
    inner = sorted(set(range(len(points))) - set(hull.vertices))
    if inner:
        allowed = f"corners of a convex body only (not {points[inner].tolist()})"
        raise InputError("vertices", points.tolist(), allowed)
    near = _FLAT * float(np.ptp(points, axis=0).max())
    found = {}
    for plane in hull.equations:
        members = np.flatnonzero(np.abs(points @ plane[:3] + plane[3]) < near)
        found[tuple(members)] = _around(points, members, -plane[:3])
    return list(found.values())


def _around(points: np.ndarray, members: np.ndarray, up: np.ndarray) -> tuple[int, ...]:
    """Return a face's corners counter-clockwise about `up`, the lowest number first."""
    arms = points[members] - points[members].mean(axis=0)
    x, y = arms[0], np.cross(up, arms[0])
    angles = np.mod(np.arctan2(arms @ y, arms @ x) + 1e-6, 2 * np.pi)
    return tuple(int(members[i]) for i in np.argsort(angles))


def solid(points: np.ndarray, faces: list[tuple[int, ...]]) -> Solid:
    """Integrate over a convex body, cut into tetrahedra from one point inside.

    For a tetrahedron with corners v_0 = 0, v_1, v_2, v_3 and volume V,
    integral x x^T dV = V/20 (sum_i v_i v_i^T + s s^T),  s = sum_i v_i.
    """
    base = points.mean(axis=0)
    volume, first, second = 0.0, np.zeros(3), np.zeros((3, 3))
    for face in faces:
        for i in range(1, len(face) - 1):
            corners = points[[face[0], face[i], face[i + 1]]] - base
            part = abs(float(np.linalg.det(corners))) / 6
            total = corners.sum(axis=0)
            volume += part
            first += part * total / 4
            second += part / 20 * (corners.T @ corners + np.outer(total, total))
    centre = first / volume
    spread = second / volume - np.outer(centre, centre)
    return Solid(volume, base + centre, np.trace(spread) * np.eye(3) - spread)


def platonic(name: str) -> np.ndarray:
    """Return the corners of a platonic solid with edges of length 1 about its centre, (V, 3).

    One face is down (normal -b3), the first edge of it runs along +b1.

    Raises:
        UnknownNameError: For another name.
    """
    if name not in _CORNERS:
        raise UnknownNameError("chassis", name, _CORNERS)
    points = np.array(_CORNERS[name], float)
    gaps = np.linalg.norm(points[:, None] - points, axis=2)
    return laid_down(points / gaps[gaps > 1e-9].min())


def laid_down(points: np.ndarray) -> np.ndarray:
    """Return points turned so that the first face is down and its first edge along +b1."""
    face = faces_of(points)[0]
    along = points[face[1]] - points[face[0]]
    x = along / np.linalg.norm(along)
    inward = np.cross(along, points[face[2]] - points[face[1]])
    z = inward / np.linalg.norm(inward)
    turned: np.ndarray = points @ np.array([x, np.cross(z, x), z]).T
    order = [*face, *(i for i in range(len(points)) if i not in face)]
    return turned[order]


def _signs(*sizes: float) -> list[tuple[float, ...]]:
    """Return all corners (+-a, +-b, +-c), zeros once."""
    choices = [(size, -size) if size else (0.0,) for size in sizes]
    return list(product(*choices))


def _cycled(*sizes: float) -> list[tuple[float, ...]]:
    """Return the corners (+-a, +-b, +-c) with coordinates in the three cyclic orders."""
    return [tuple(v[i] for i in cycle) for cycle in _CYCLES for v in _signs(*sizes)]


_CORNERS: dict[str, list[tuple[float, ...]]] = {
    "tetrahedron": [(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)],
    "cube": _signs(1, 1, 1),
    "octahedron": _cycled(1, 0, 0),
    "dodecahedron": _signs(1, 1, 1) + _cycled(0, 1 / _GOLDEN, _GOLDEN),
    "icosahedron": _cycled(0, 1, _GOLDEN),
}
NAMES = tuple(_CORNERS)
