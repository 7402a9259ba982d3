"""Singular points of a momentum without the bias, and which of them are clearly elliptic."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from nullmotion.array.model import CmgArray
from nullmotion.atlas.curvature import radii_terms
from nullmotion.atlas.kind import KINDS, codes
from nullmotion.atlas.surfaces_points import SingularPoints, singular_points
from nullmotion.singular_kind import TOLERANCE, Kind

ELLIPTIC = KINDS.index(Kind.ELLIPTIC)
_CLEAR = 2 * TOLERANCE  # |eigenvalue| of Q over the mean momentum, so that the type is clear


class Point(NamedTuple):
    """An elliptic singular point: with the array's bias left out, of the size |h|.

    Attributes:
        u: Its singular direction, (m,).
        signs: epsilon, (n,).
        size: |h| [N m s].
    """

    u: np.ndarray
    signs: np.ndarray
    size: float


def momenta(array: CmgArray, u: np.ndarray, signs: np.ndarray) -> SingularPoints:
    """Return singular points, their momenta without the array's bias."""
    assert array.torque_axes is not None
    points = singular_points(array, u, signs)
    bias = array.torque_axes @ array.momentum_bias
    return SingularPoints(**{**vars(points), "momentum": points.momentum - bias})


def sizes(array: CmgArray, points: SingularPoints, below: np.ndarray) -> np.ndarray:
    """Return |h| of points that are clearly elliptic and nearer than before, else inf, (B,)."""
    size = np.linalg.norm(points.momentum, axis=1)
    left = np.flatnonzero(size < below)
    terms = radii_terms(array, points.u[left], points.delta[left], points.across[left])
    C = np.einsum("bn,bnk->bk", points.signs[left], terms)
    rounding = np.abs(terms).sum(axis=(1, 2))
    code = codes(array, points.signs[left], C, rounding, points.free[left])
    left = left[code == ELLIPTIC]
    some = SingularPoints(*(value[left] for value in vars(points).values()))
    left = left[clear(array, some)]
    found = np.full(len(size), np.inf)
    found[left] = size[left]
    return found


def clear(array: CmgArray, points: SingularPoints) -> np.ndarray:
    """Return where the form Q on the null space is definite beyond doubt, (B,)."""
    count = array.n - array.m + 1
    _, sigma, right = np.linalg.svd(array.unit_jacobian(points.delta))
    along = np.einsum("bnm,bm->bn", array.rotor_momenta(points.delta), points.u)
    along = along / array.mean_momentum
    both = (along > TOLERANCE).any(axis=1) & (along < -TOLERANCE).any(axis=1)
    if count < 1:
        return both
    one = both if array.m == 1 else both & (sigma[:, array.m - 2] > TOLERANCE)
    N = right[:, array.m - 1 :]
    value = np.linalg.eigvalsh(np.einsum("bkn,bn,bln->bkl", N, along, N))
    definite: np.ndarray = one & ((value[:, 0] > _CLEAR) | (value[:, -1] < -_CLEAR))
    return definite
