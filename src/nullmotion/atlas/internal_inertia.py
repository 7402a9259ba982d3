"""Which patches of singular directions have hyperbolic points only.

In a frame that goes along, the column t_k of the axis with the least |p_k| and s = u x t_k,

    C = sum_i W_i / |p_i| [cos^2 b_i, cos b_i sin b_i; cos b_i sin b_i, sin^2 b_i]

with t_i . t_k = cos b_i and t_i . s = sin b_i, W_i the sum of epsilon h0 over the CMGs of axis i.
Over a patch b_i is known up to roll_i + roll_k, and C as an interval matrix. If it has at least p
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
    plus, minus = _eigenvalues(*_form(view, cases.weights))
    found: np.ndarray = (cases.above + minus > 2) & (cases.below + plus > 2)
    return found


def _form(view: View, weights: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return intervals (2, B) of C along t_k, along s, and between them."""
    k = np.argmin(view.across, axis=1)[:, None]
    t = np.take_along_axis(view.column, k[..., None], axis=1)[:, 0]
    cosine = np.einsum("bnk,bk->bn", view.column, t)
    sine = np.einsum("bnk,bk->bn", view.column, np.cross(view.u, t))
    off = np.minimum(view.roll + np.take_along_axis(view.roll, k, axis=1), 1.0)
    off = np.where(np.arange(weights.shape[1]) == k, 0.0, off)  # the frame goes along with it
    cosine, sine = np.where(off > 0, cosine, 1.0), np.where(off > 0, sine, 0.0)
    size = np.abs(weights)
    with np.errstate(divide="ignore", invalid="ignore"):
        scale = np.nan_to_num(np.stack([size / view.most, size / view.least]), posinf=np.inf)
    return (
        _sum(weights, scale, cosine**2, off, 0.0),
        _sum(weights, scale, sine**2, off, 0.0),
        _sum(weights, scale, cosine * sine, off, -1.0),
    )


def _sum(
    weights: np.ndarray, scale: np.ndarray, middle: np.ndarray, off: np.ndarray, least: float
) -> np.ndarray:
    """Return the interval (2, B) of sum_i sign(W_i) scale_i x_i, x_i within off of the middle."""
    x = np.clip(np.stack([middle - off, middle + off]), least, 1.0)
    with np.errstate(invalid="ignore"):  # nothing of what has no bound is nothing
        low = np.where(x[0] == 0, 0.0, np.where(x[0] < 0, scale[1], scale[0]) * x[0])
        high = np.where(x[1] == 0, 0.0, np.where(x[1] > 0, scale[1], scale[0]) * x[1])
    positive = weights > 0
    return np.stack([
        np.where(positive, low, -high).sum(axis=1), np.where(positive, high, -low).sum(axis=1)
    ])  # fmt: skip


def _eigenvalues(
    first: np.ndarray, second: np.ndarray, between: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return how many eigenvalues are positive, and negative, at least: 2 x 2 intervals."""
    with np.errstate(invalid="ignore"):
        product = np.stack([a * b for a in first for b in second])
        square = between**2
        least = np.where((between[0] < 0) & (between[1] > 0), 0.0, square.min(axis=0))
        lowest, highest = product.min(axis=0) - square.max(axis=0), product.max(axis=0) - least
        up, down = (first[0] > 0) | (second[0] > 0), (first[1] < 0) | (second[1] < 0)
        definite, saddle = lowest > 0, highest < 0
    plus = np.where(definite & up, 2, np.where(up | saddle, 1, 0))
    return plus, np.where(definite & down, 2, np.where(down | saddle, 1, 0))
