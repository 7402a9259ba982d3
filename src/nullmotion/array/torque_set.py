"""The set of torques that limited rates give, {A w : |w_k| <= l_k}: how far it reaches; source.

It is a zonotope with facets normal to c_S at distance sum_k l_k |G_Sk| / |c_S|
(`nullmotion.array.minors` has the symbols). A (..., m, n) may have leading axes.
"""

from __future__ import annotations

from functools import reduce
from typing import Any

import numpy as np

from nullmotion import ops
from nullmotion.array.minors import ROUNDING, Facet, LeastRates, columns, dot, facet, facets, length

_ALONG = 1e-14  # cosine below which a direction lies in a facet


def rows_capability(W: Any, limits: Any = 1.0) -> Any:
    """Return the largest torque that rates W tau give in every direction within limits.

        TC = min_i limit_i / |row_i(W)|

    (Elliott 2019, Eqs 15 and 49; with limits less the null motion's rates, Eq 143). A row of
    zeros sets no bound, unless its limit is negative; a row that is not finite gives 0.

    Args:
        W: Rates per torque, any right inverse of A, (..., n, m).
        limits: Limits of the rates, one number or (..., n).
    """
    return _least_bound(columns(np.swapaxes(np.asarray(W), -1, -2)), limits)


def least_rates_capability(found: LeastRates, limits: Any = 1.0) -> Any:
    """Return `rows_capability` of the pseudo-inverse; exactly 0 where A is singular."""
    return ops.where(found.regular, _least_bound(found.rows, limits) * found.square, 0.0)


def _least_bound(rows: Any, limits: Any) -> Any:
    each = zip(_per_cmg(limits, len(rows)), rows, strict=True)
    return reduce(ops.minimum, [_bound(limit, length(row)) for limit, row in each])


def _bound(limit: Any, size: Any) -> Any:
    """Return limit/size: no bound by a size of 0, and 0 for one that is not finite."""
    none = ops.where(ops.less(limit, 0.0), -np.inf, np.inf)
    none = ops.where(ops.equal(size, 0.0), none, 0.0)
    some = ops.logical_and(ops.less(0.0, size), ops.less(size, np.inf))
    return ops.where(some, limit / ops.where(some, size, 1.0), none)


def _per_cmg(limits: Any, n: int) -> list[Any]:
    """Return each CMG's limit from one number or (..., n)."""
    values = np.asarray(limits)
    return list(np.moveaxis(values, -1, 0)) if values.ndim else [limits] * n


def inradius(A: Any, limits: Any = 1.0, sharp: bool = True) -> Any:
    """Return the largest torque within reach in every direction, whatever the rates' law.

        TC = min_S  sum_k limit_k |G_Sk| / |c_S|

    At most n/2 (m = 3), cot(pi/2n) < 2n/pi (m = 2) or n (m = 1) for unit columns and limits;
    a linear law has at most n/m. Exactly 0 where A is singular.

    Args:
        A: Jacobian, (..., m, n).
        limits: Limits of the rates, one number or (n,); infinite if none.
        sharp: See `nullmotion.array.minors.facets`.
    """
    a = columns(A)
    bounds = _per_cmg(limits, len(a))
    least, greatest, nothing = np.inf, 0.0, ROUNDING * _summed(a, bounds)
    for f in facets(a, sharp):
        square = dot(f.normal, f.normal)
        used = ops.less(0.0, square)
        distance = _support(a, f, bounds) / ops.sqrt(ops.where(used, square, 1.0))
        least = ops.minimum(ops.where(used, distance, np.inf), least)
        greatest = ops.maximum(square, greatest)
    some = ops.logical_and(ops.less(0.0, greatest), ops.less(nothing, least))
    return ops.where(some, least, 0.0)


def reach(A: Any, u: Any, limits: Any = 1.0) -> Any:
    """Return the largest torque along the unit vectors u within limits, at singular A too.

    By duality the least of h(n) / |n.u|, h(n) = sum_k limit_k |a_k . n|, over all n. It is
    attained at a normal c_S, or where A has lost rank at a vector of the plane of u and a
    column, normal to that column, or at u itself.

    Args:
        A: Jacobian, (..., m, n).
        u: Unit vectors, (..., m).
        limits: Limits of the rates, one number or (n,); infinite if none.
    """
    a, along = columns(A), np.moveaxis(np.asarray(u), -1, 0)
    bounds = _per_cmg(limits, len(a))
    normals = [*facets(a), facet(a, along + 0.0 * a[0], ())]
    for k, x in enumerate(a if len(along) == 3 else ()):
        normals.append(facet(a, _steepest(x, along), (k,)))
    least, nothing = np.inf, ROUNDING * _summed(a, bounds)
    for f in normals:
        size = length(f.normal)
        share = ops.absolute(dot(f.normal, along))
        used = ops.less(_ALONG * size, share)
        support = _support(a, f, bounds)
        support = ops.where(ops.less(nothing * size, support), support, 0.0)
        bound = ops.where(used, support / ops.where(used, share, 1.0), np.inf)
        least = ops.minimum(bound, least)
    return least


def _steepest(x: Any, u: Any) -> Any:
    """Return the vector of the plane of x and u that is normal to x; 0 if they are parallel."""
    beside = x - dot(x, u) * u
    square = dot(beside, beside)
    apart = ops.less(_ALONG * _ALONG * dot(x, x), square)
    return ops.where(apart, square * u - dot(x, u) * beside, 0.0)


def _support(a: Any, f: Facet, limits: list[Any]) -> Any:
    """Return sum_k limit_k |a_k . n|; a CMG without limit sets no bound outside its plane."""
    total = 0.0
    for limit, x, product in zip(limits, a, f.products, strict=True):
        if _unlimited(limit):
            size = _ALONG * length(x) * length(f.normal)
            total = total + ops.where(ops.less(size, ops.absolute(product)), np.inf, 0.0)
        else:
            total = total + limit * ops.absolute(product)
    return total


def _summed(a: Any, limits: list[Any]) -> Any:
    """Return the summed length of the columns times their limits, where there are limits."""
    return sum(
        limit * length(x) for limit, x in zip(limits, a, strict=True) if not _unlimited(limit)
    )


def _unlimited(limit: Any) -> bool:
    return isinstance(limit, float) and limit == np.inf
