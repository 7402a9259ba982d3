"""Types of the singular points of a sheet, all at once.

A null motion x (A x = 0) is held back in second order by u: u . dh = -1/2 sum (h_i . u) x_i^2.
So the type of a point is the inertia of Q = N^T diag(h_i . u) N on the null space of A
(Papakonstantinou et al. 2021, Eq 26). With E = diag(h_i . u) = diag(epsilon_i h0_i |p_i|) and
B the columns of A in the plane normal to u, the inertia of [[E, B^T], [B, 0]], taken apart
both ways (Haynsworth 1968), is

    In Q + (m - 1, m - 1, 0) = In E + In(-C),    C = B E^-1 B^T

and C is what `curvature` makes of the sheet: a 2 x 2 matrix in place of a null space. (For
four CMGs: definite where K times the product of the signs is positive.)
"""

from __future__ import annotations

import numpy as np

from nullmotion.array.model import CmgArray
from nullmotion.singular_kind import KINDS, Kind

EDGE = 1e-9  # least |radius of curvature| over the mean momentum that is not an edge


def codes(
    array: CmgArray, signs: np.ndarray, radii: np.ndarray, rounding: np.ndarray, free: np.ndarray
) -> np.ndarray:
    """Return the types of singular points as places in `KINDS`, (P,).

    Where Q is semidefinite the null motion is settled by higher orders: on the lines between
    elliptic and hyperbolic, and all over sheets that shrink to a curve or a point because
    CMGs with parallel axes cancel. These have the type ``degenerate-hyperbolic`` here;
    `nullmotion.singularity.classify` looks at a point more closely.

    Args:
        array: The array.
        signs: epsilon of a whole sheet, (n,), or of each point, (P, n).
        radii: Upper triangles of C, (P, m (m - 1) / 2).
        rounding: Sum of |C_i| of which C is the difference, (P,).
        free: CMGs with u along the gimbal axis or without momentum, (P, n): on no side of u.
    """
    working = np.asarray(array.h0) > 0
    above = np.sum(signs[..., working] > 0, axis=-1)
    below = np.sum(signs[..., working] < 0, axis=-1)
    least = EDGE * float(array.mean_momentum) + 1e-14 * rounding
    plus, minus = _inertia(radii, array.m, least)
    flat = array.m - 1 - plus - minus
    positive = above + minus - (array.m - 1)
    negative = below + plus - (array.m - 1)
    code = np.full(radii.shape[:-1], KINDS.index(Kind.ELLIPTIC), np.int8)
    code[flat > 0] = KINDS.index(Kind.DEGENERATE)
    code[(positive > 0) & (negative > 0)] = KINDS.index(Kind.HYPERBOLIC)
    code[np.broadcast_to((above == 0) | (below == 0), code.shape)] = KINDS.index(Kind.SATURATION)
    rim = np.flatnonzero((free & working).any(axis=1))
    side = np.where(free[rim], 0.0, np.broadcast_to(signs, free.shape)[rim])
    code[rim[(side >= 0).all(axis=1) | (side <= 0).all(axis=1)]] = KINDS.index(Kind.SATURATION)
    return code


def _inertia(radii: np.ndarray, m: int, least: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return how many eigenvalues of C are above ``least``, and below -``least``."""
    if m == 1:
        none = np.zeros(radii.shape[:-1], int)
        return none, none
    if m == 2:
        values = radii
    else:
        middle, half = (radii[..., 0] + radii[..., 2]) / 2, (radii[..., 0] - radii[..., 2]) / 2
        spread = np.hypot(half, radii[..., 1])
        values = np.stack([middle - spread, middle + spread], axis=-1)
    return np.sum(values > least[..., None], axis=-1), np.sum(values < -least[..., None], axis=-1)
