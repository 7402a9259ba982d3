"""Curvature of singular surfaces.

A sheet is the gradient of its support function over the unit sphere,

    H(u) = h . u = sum_i epsilon_i h0_i |p_i|,    h = grad H

so the Hessian of H in the plane normal to u holds the radii of curvature: with t_i the
direction of CMG i's column, which is normal to u,

    C = sum_i epsilon_i h0_i t_i t_i^T / |p_i|,    dh = C du,    K = 1 / det C

(Gaussian curvature for m = 3, curvature of a line for m = 2). |p_i| = 0 gives K = 0: the rim of
a funnel. det C = 0 is an edge of the sheet, K infinite.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from nullmotion.array.model import CmgArray
from nullmotion.atlas.surfaces_points import singular_points
from nullmotion.singularity import tangents

NEAR = 1e-6  # |p_i| that stands for less: types at a rim are the limits from beside it


def gaussian_curvature(array: CmgArray, u: Any, signs: Any) -> Any:
    """Return the Gaussian curvature of the sheet at u [1/(N m s)^(m - 1)], (...).

    Positive where the surface is cap-shaped, negative where it is a saddle; infinite on an edge
    and all over a sheet that shrinks to a curve or a point.

    Args:
        array: The array, with m = 2 or 3.
        u: Directions along the torque axes, (..., m).
        signs: epsilon, (..., n).

    Raises:
        InputError: As `singular_points`.
    """
    points = singular_points(array, u, signs)
    terms = radii_terms(array, points.u, points.delta, points.across)
    product = determinant(np.einsum("...n,...nk->...k", points.signs, terms), array.m)
    rim = (points.free & (np.asarray(array.h0) > 0)).any(axis=-1)
    with np.errstate(divide="ignore"):
        return np.where(rim, 0.0, 1.0 / product)[()]


def radii_terms(array: CmgArray, u: Any, delta: Any, across: Any) -> np.ndarray:
    """Return h0_i t_i t_i^T / |p_i| in the plane normal to u, (..., n, m (m - 1) / 2).

    Args:
        array: The array.
        u: Unit singular directions, (..., m).
        delta: Their gimbal angles [rad], (..., n), for any signs.
        across: |p_i|, (..., n).

    Returns:
        Upper triangles, row by row: (c11,) for m = 2, (c11, c12, c22) for m = 3.
    """
    t = np.swapaxes(array.transverse_directions(delta), -1, -2) @ tangents(u)
    t = t * np.sqrt(np.asarray(array.h0) / np.maximum(across, NEAR))[..., None]
    first, second = np.triu_indices(array.m - 1)
    return t[..., first] * t[..., second]


def determinant(radii: np.ndarray, m: int) -> np.ndarray:
    """Return det C of upper triangles (..., m (m - 1) / 2)."""
    if m == 3:
        return radii[..., 0] * radii[..., 2] - radii[..., 1] ** 2
    return radii[..., 0] if m == 2 else np.ones(radii.shape[:-1])
