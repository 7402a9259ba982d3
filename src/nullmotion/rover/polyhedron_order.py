"""The order in which the faces and edges of a chassis are counted (see `chassis`)."""

from __future__ import annotations

import numpy as np

from nullmotion.rover.polyhedron import faces_of

_FLAT = 1e-9


def sorted_faces(points: np.ndarray) -> tuple[tuple[int, ...], ...]:
    """Return the faces, the lowest first; at one height counter-clockwise from +b1."""
    faces = faces_of(points)
    return tuple(sorted(faces, key=lambda f: _place(points, f, 0.0)))


def sorted_edges(points: np.ndarray, faces: tuple[tuple[int, ...], ...]) -> np.ndarray:
    """Return the edges (from, to) of sorted faces in the order that `chassis` tells, (E, 2)."""
    directed = [(f[i - 1], f[i]) for f in faces for i in range(len(f))]
    once = [e for k, e in enumerate(directed) if e[::-1] not in directed[:k]]
    size = len(faces[0])
    base = directed[1:size] + directed[:1]
    first = max(range(size), key=lambda i: _along(points, base[i]))
    others = sorted(once[size:], key=lambda e: _place(points, e, np.pi / 2))
    return np.array(base[first:] + base[:first] + others)


def _along(points: np.ndarray, edge: tuple[int, int]) -> float:
    along = points[edge[1]] - points[edge[0]]
    return float(along[0] / np.linalg.norm(along))


def _place(points: np.ndarray, corners: tuple[int, ...], zero: float) -> tuple[float, float]:
    """Return height and azimuth of the middle of corners, rounded so that equal is equal."""
    x, y, z = points[list(corners)].mean(axis=0)
    flat = np.hypot(x, y) < _FLAT * float(np.abs(points).max())
    azimuth = 0.0 if flat else np.mod(np.arctan2(y, x) - zero + 1e-6, 2 * np.pi)
    return round(float(z / np.abs(points).max()), 6), round(float(azimuth), 5)
