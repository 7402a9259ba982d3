"""Curves of self-motion and the singular points where they end, for n = m + 1."""

from __future__ import annotations

import numpy as np

from nullmotion.atlas.curvature import radii_terms
from nullmotion.atlas.manifold_rotors import Rotors
from nullmotion.atlas.manifold_seeds import wrapped
from nullmotion.atlas.manifold_trace import Curve, lie_on, trace
from nullmotion.atlas.surfaces_points import singular_points
from nullmotion.singular_vicinity import neighbours
from nullmotion.singularity import tangents

SINGULAR = 1e-5  # sigma_min of unit A below which a solution is treated as singular
SAME = 1e-3  # rad; singular points closer than this are one
_BESIDE = 0.02  # rad from a crossing, where its curves are apart
_ALMOST = 1e-3  # sigma_min of unit A below which an end is a crossing, not where steps ran out
_NEWTON = 8


def curves(
    rotors: Rotors, starts: np.ndarray, crossings: np.ndarray, momentum: np.ndarray
) -> tuple[list[Curve], np.ndarray]:
    """Return all curves through regular angles (k, n), and the singular points of their ends.

    Every crossing that a curve ends at, or that is given, is a place to start from as well.
    """
    found: list[Curve] = []
    points = list(crossings)
    looked = 0
    _add(rotors, starts, momentum, found)
    while True:
        for curve in found:
            ends = curve.angles[:0] if curve.closed else curve.angles[[0, -1]]
            ends = ends[rotors.sigma_min(ends) < _ALMOST]
            _meet(rotors, ends, momentum, points)
        if looked == len(points):
            return found, np.reshape(points, (-1, rotors.n))
        for point in points[looked:]:
            _add(rotors, neighbours(rotors.array, point, _BESIDE, SINGULAR), momentum, found)
            looked += 1


def _add(rotors: Rotors, starts: np.ndarray, momentum: np.ndarray, found: list[Curve]) -> None:
    left = starts
    for curve in found:
        left = left[~lie_on(rotors, left, curve, momentum)]
    while len(left):
        found.append(trace(rotors, left[0], momentum))
        left = left[1:][~lie_on(rotors, left[1:], found[-1], momentum)]


def _meet(
    rotors: Rotors, ends: np.ndarray, momentum: np.ndarray, points: list[np.ndarray]
) -> None:
    """Add the singular points beside the ends of curves, those that are new."""
    for end in ends:
        point = crossing(rotors, end, momentum)
        if not any(np.linalg.norm(wrapped(point - other)) < SAME for other in points):
            points.append(point)


def crossing(rotors: Rotors, delta: np.ndarray, momentum: np.ndarray) -> np.ndarray:
    """Return the singular angles of a momentum beside angles (n,); these where there are none.

    Newton's method over u: dh = C du on the sheet through the angles.
    """
    array = rotors.array
    left = np.linalg.svd(rotors.unit_jacobian(delta))[0]
    u = left[:, -1]
    signs = np.where(array.rotor_momenta(delta) @ u < 0, -1.0, 1.0)
    point = singular_points(array, u, signs)
    for _ in range(_NEWTON):
        terms = radii_terms(array, point.u, point.delta, point.across)
        radii, basis = _matrix(signs @ terms, rotors.m), tangents(point.u)
        lack = basis.T @ (momentum - point.momentum)
        u = point.u + basis @ np.linalg.lstsq(radii, lack, rcond=1e-9)[0]
        point = singular_points(array, u, signs)
    error = np.linalg.norm(momentum - point.momentum) / array.mean_momentum
    away = wrapped(point.delta - delta)
    near = not point.free.any() and error < 1e-10 and np.linalg.norm(away) < SAME
    return wrapped(delta + away) if near else wrapped(delta)


def _matrix(triangle: np.ndarray, m: int) -> np.ndarray:
    """Return the symmetric matrix of an upper triangle."""
    full = np.zeros((m - 1, m - 1))
    full[np.triu_indices(m - 1)] = triangle
    return full + np.triu(full, 1).T
