"""Which patches of singular directions have hyperbolic points only.

The columns t_i lie in the plane normal to u, at angles b_i from each other. With W_i the sum of
epsilon h0 over the CMGs of gimbal axis i, and k the axis with the least |p_k|,

    C = sum_i K_i t_i t_i^T,    K_i = W_i / |p_i|
    tr C = sum_i K_i,    det C = K_k S + sum_(i < j, not k) K_i K_j sin^2(b_i - b_j)
    s^T C s = S = sum_i K_i sin^2(b_i - b_k),    s normal to t_k

Over a patch |p_i| has bounds and b_i - b_j is known up to roll_i + roll_j. If C has at least p
positive and q negative eigenvalues, Q on the null space has at least a + q - 2 positive and
b + p - 2 negative ones (`kind`), a and b the numbers of signs + and -. With one of each it is
not definite: no point is elliptic.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from nullmotion.atlas.internal_patches import View
from nullmotion.atlas.internal_sphere import Sphere


class Cases(NamedTuple):
    """Sign patterns, one a row.

    Attributes:
        weights: Sum of epsilon h0 of the CMGs of each gimbal axis over the mean, (B, k).
        above: Number of signs +, (B,).
        below: Number of signs -, (B,).
        signs: The signs, (B, n).
    """

    weights: np.ndarray
    above: np.ndarray
    below: np.ndarray
    signs: np.ndarray

    def take(self, which: np.ndarray) -> Cases:
        """Return some of them."""
        return Cases(*(value[which] for value in self))


def cases_of(sphere: Sphere, h0: np.ndarray, signs: np.ndarray) -> Cases:
    """Return the cases of sign patterns (P, n), each once."""
    weights = (signs * h0) @ (sphere.of[:, None] == np.arange(len(sphere.gimbal)))
    above = np.sum(signs > 0, axis=1)
    rows = np.round(np.column_stack([weights, above]), 12)
    once = np.unique(rows, axis=0, return_index=True)[1]
    return Cases(weights[once], above[once], signs.shape[1] - above[once], signs[once])


def hyperbolic(view: View, cases: Cases) -> np.ndarray:
    """Return where no point of the patches can be elliptic, (B,)."""
    plus, minus = _eigenvalues(view, cases.weights)
    found: np.ndarray = (cases.above + minus > 2) & (cases.below + plus > 2)
    return found


def _eigenvalues(view: View, weights: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return how many eigenvalues of C are positive, and negative, at least, (B,)."""
    nearest = np.argmin(view.across, axis=1)[:, None]
    last = np.arange(weights.shape[1]) == nearest
    order = np.argsort(last, axis=1, kind="stable")  # the axis k comes last
    K, angle, roll = _terms(view, weights, nearest)
    K = np.take_along_axis(K, order[None], axis=2)
    angle, roll = (np.take_along_axis(v, order, axis=1) for v in (angle, roll))
    along = K.sum(axis=-1)
    sine = _squared_sine(angle[:, -1:] - angle, roll[:, -1:] + roll)
    across = _product(K, sine)[..., :-1].sum(axis=-1)
    along_k = _product(K, 1.0 - sine[::-1])[..., :-1].sum(axis=-1) + K[..., -1]
    det = _product(K[..., -1], across)
    for i in range(weights.shape[1] - 1):
        sine = _squared_sine(angle[:, i, None] - angle[:, :i], roll[:, i, None] + roll[:, :i])
        det = det + _product(K[..., i, None], _product(K[..., :i], sine)).sum(axis=-1)
    up = (along[0] > 0) | (across[0] > 0) | (along_k[0] > 0)
    down = (along[1] < 0) | (across[1] < 0) | (along_k[1] < 0)
    definite, saddle = det[0] > 0, det[1] < 0
    plus = np.where(definite & up, 2, np.where(up | saddle, 1, 0))
    return plus, np.where(definite & down, 2, np.where(down | saddle, 1, 0))


def _terms(
    view: View, weights: np.ndarray, nearest: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the intervals of K (2, B, k), the angles from t_k, and the rolls, (B, k)."""
    t = np.take_along_axis(view.column, nearest[..., None], axis=1)[:, 0]
    cosine = np.einsum("bnk,bk->bn", view.column, t)
    sine = np.einsum("bnk,bk->bn", view.column, np.cross(view.u, t))
    with np.errstate(divide="ignore", invalid="ignore"):
        ends = np.stack([weights / view.most, weights / view.least])
    ends = np.where(weights == 0, 0.0, ends)
    return np.sort(ends, axis=0), np.arctan2(sine, cosine), view.roll


def _squared_sine(angle: np.ndarray, off: np.ndarray) -> np.ndarray:
    """Return the interval of sin^2 of angles known up to ``off``, (2, ...)."""
    least = np.abs((angle + 0.5 * np.pi) % np.pi - 0.5 * np.pi)
    ends = np.stack([np.maximum(least - off, 0.0), np.minimum(least + off, 0.5 * np.pi)])
    found: np.ndarray = np.sin(ends) ** 2
    return found


def _product(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return the interval of the product of intervals (2, ...); no times infinity is no."""
    with np.errstate(invalid="ignore"):
        every = np.stack(np.broadcast_arrays(a[0] * b[0], a[0] * b[1], a[1] * b[0], a[1] * b[1]))
    every = np.where(np.isnan(every), 0.0, every)
    return np.stack([every.min(axis=0), every.max(axis=0)])
