"""Curves of self-motion and the singular points where they end, for n = m + 1."""

from __future__ import annotations

import numpy as np

from nullmotion.atlas.manifold_rotors import Rotors
from nullmotion.atlas.manifold_seeds import wrapped
from nullmotion.atlas.manifold_trace import Curve, lie_on, trace
from nullmotion.singular_vicinity import neighbours

SINGULAR = 1e-5  # sigma_min of unit A below which a solution is treated as singular
SAME = 1e-3  # rad; singular points closer than this are one
_BESIDE = 0.02  # rad from a crossing, where its curves are apart
_ALMOST = 1e-3  # sigma_min of unit A below which an end is a crossing, not where steps ran out
_NEWTON = 8
_CLOSE = 1e-10  # what a crossing may lack


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
        left = left[~lie_on(rotors, left, curve.angles, momentum)]
    while len(left):
        found.append(trace(rotors, left[0], momentum))
        left = left[1:][~lie_on(rotors, left[1:], found[-1].angles, momentum)]


def _meet(rotors: Rotors, ends: np.ndarray, momentum: np.ndarray, points: list[np.ndarray]) -> None:
    """Add the singular points beside the ends of curves, those that are new."""
    for end in ends:
        point = crossing(rotors, end, momentum)
        if not any(np.linalg.norm(wrapped(point - other)) < SAME for other in points):
            points.append(point)


def crossing(rotors: Rotors, delta: np.ndarray, momentum: np.ndarray) -> np.ndarray:
    """Return the singular angles of a momentum beside angles (n,); these where there are none.

    Gauss and Newton's method for h(delta) = h, A^T u = 0, |u| = 1 in delta and u together.
    """
    here, u = delta, np.linalg.svd(rotors.unit_jacobian(delta))[0][:, -1]
    n, m = rotors.n, rotors.m
    for _ in range(_NEWTON):
        A, along = rotors.unit_jacobian(here), rotors.unit_momenta(here) @ u
        slope = np.zeros((m + n + 1, n + m))
        slope[:m, :n], slope[m : m + n, :n] = A, -np.diag(along)
        slope[m : m + n, n:], slope[-1, n:] = A.T, 2 * u
        lack = np.concatenate([rotors.missing(here, momentum), -(A.T @ u), [1.0 - u @ u]])
        move = np.linalg.lstsq(slope, lack, rcond=1e-9)[0]
        here, u = here + move[:n], u + move[n:]
    good = np.abs(lack).max() < _CLOSE and np.linalg.norm(here - delta) < SAME
    return wrapped(here if good else delta)
