"""Normals of a Jacobian's columns and its minors: what torque capability is made of; source.

For A (m x n, m <= 3) with columns a_k and every set S of m - 1 columns:

    c_S  = a_i x a_j (m = 3), a_i turned by a right angle (m = 2), 1 (m = 1)
    G_Sk = a_k . c_S

By Cauchy and Binet adj(A A^T) = sum_S c_S c_S^T and det(A A^T) = sum_Sk G_Sk^2 / m, so that

    row k of A^+ = q_k / det(A A^T),   q_k = adj(A A^T) a_k = sum_S G_Sk c_S

without a product that squares the condition number, or a decision by a value. Vectors have
their components first, (m, ...): the axes after them are batches, and symbols have none.
"""

from __future__ import annotations

from functools import reduce
from itertools import combinations
from typing import Any, NamedTuple

import numpy as np

from nullmotion import linalg, ops

ROUNDING = 1e-15  # share of the columns' summed length below which a torque is rounding
_PARALLEL = 1e-30  # squared sine of two columns' angle below which they have no normal


class Facet(NamedTuple):
    """Normal c_S of m - 1 columns, (m, ...), and its products G_S1 ... G_Sn with all columns."""

    normal: Any
    products: list[Any]


class LeastRates(NamedTuple):
    """The pseudo-inverse before its division: row k of A^+ is ``rows[k] / square``.

    Attributes:
        rows: q_k = adj(A A^T) a_k, (n, m, ...).
        square: det(A A^T), or 1 where A is singular to rounding.
        regular: Whether it is not.
    """

    rows: Any
    square: Any
    regular: Any


def columns(A: Any) -> Any:
    """Return the columns of A (..., m, n) with their components first, (n, m, ...)."""
    return np.moveaxis(np.asarray(A), (-1, -2), (0, 1))


def dot(x: Any, y: Any) -> Any:
    """Return the inner product of vectors, components first."""
    return (x * y).sum(axis=0)


def length(x: Any) -> Any:
    """Return the Euclidean norm of vectors, components first."""
    return ops.sqrt(dot(x, x))


def facet(a: Any, normal: Any, members: tuple[int, ...]) -> Facet:
    """Return a facet; the products with its members are zero, not rounding."""
    return Facet(normal, [0.0 if k in members else dot(x, normal) for k, x in enumerate(a)])


def facets(a: Any, sharp: bool = True) -> list[Facet]:
    """Return the normals of all sets of m - 1 columns and the minors of A.

    Args:
        a: Columns, (n, m, ...).
        sharp: Take the rounding out of vector products of nearly parallel columns, which
            costs all digits near rank 1, and give parallel columns the normal 0. Off for
            intervals, where it would widen what it cannot sharpen.
    """
    n, m = a.shape[:2]
    if m == 1:
        return [facet(a, np.ones(a.shape[1:]), ())]
    return [
        facet(a, _normal([a[i] for i in members], sharp), members)
        for members in combinations(range(n), m - 1)
    ]


def _normal(members: list[Any], sharp: bool) -> Any:
    if len(members) == 1:
        return np.stack([-members[0][1], members[0][0]])
    x, y = members
    c = linalg.cross(x, y)
    if not sharp:
        return c
    xx = dot(x, x)
    c = c - (dot(c, x) / ops.where(ops.less(0.0, xx), xx, 1.0)) * x
    return ops.where(ops.less(_PARALLEL * (xx * dot(y, y)), dot(c, c)), c, 0.0)


def least_rates(a: Any, sharp: bool = True) -> LeastRates:
    """Return the pseudo-inverse of the matrix with columns a (n, m, ...), n >= m."""
    minors = facets(a, sharp)
    rows = np.stack([sum(f.products[k] * f.normal for f in minors) for k in range(len(a))])
    square = sum(g * g for f in minors for g in f.products) * (1.0 / a.shape[1])
    longest = reduce(ops.maximum, [length(q) for q in rows])
    size = sum(length(x) for x in a)
    regular = ops.less(ROUNDING * size * longest, square)
    return LeastRates(rows, ops.where(regular, square, 1.0), regular)


def climb(found: LeastRates, a: Any, h: Any) -> Any:
    """Return the null motion along the slope of det(A A^T), (n, ...).

        (I - A^+ A) d,   d_k = d det(A A^T) / d delta_k = -2 h_k . q_k     (Elliott 2019, 7.1.3)

    Args:
        found: The pseudo-inverse.
        a: Columns of A, (n, m, ...).
        h: Momenta of the CMGs, d a_k / d delta_k = -h_k, (n, m, ...).
    """
    slope = [-2.0 * dot(x, q) for x, q in zip(h, found.rows, strict=True)]
    torque = sum(d * x for d, x in zip(slope, a, strict=True)) / found.square
    return np.stack([d - dot(q, torque) for d, q in zip(slope, found.rows, strict=True)])
