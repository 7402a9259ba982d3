"""A proof that all momenta of a convex hull are reachable by three circles in space.

Without null motion there are momenta all of whose angles are singular and that are reachable
from all sides none the less, along whole curves: cusps, where a momentum is like x^3. No
expansion shows that, a change of sign does. With circle i at the angle phi, y = h - h_i(phi) is
to be the sum of circles j and k. Let w = g_j x g_k / s, s = |g_j x g_k|: w lies in both planes, and

    x_j = y . g_k / s,    x_k = y . g_j / s       components of h_j and h_k across w (up to signs)
    y . w = z_j + z_k,    z = +-sqrt(r^2 - x^2)

so that for each pair of signs the defect  f(phi) = y . w - z_j - z_k  is continuous where both
roots exist; where one ends its two signs meet. If f changes sign between two angles on one
such branch for every y of the hull, every momentum of the hull is reachable.

Where f keeps a sign for every y, on every branch and all the way between the angles of the grid,
none is.

Everything is linear in h but the roots, which are monotonic in |x|: bounds over the hull's
corners are bounds over the hull. Between two angles of the grid x and y . w leave the line
between their ends by less than |g . h_i| step^2 / 8. Source without branches, compiled.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from nullmotion import ops
from nullmotion.atlas.envelope_lanes import Lanes
from nullmotion.atlas.envelope_rings import Rings

_STEPS = 96  # angles of circle i
_OBLIQUE = 0.05  # least sine between the gimbal axes of circles j and k
_TINY = 1e-11
_ORDERS = ((0, 1, 2), (1, 2, 0), (2, 0, 1))


class Verdict(NamedTuple):
    """What is known about hulls.

    Attributes:
        inside: All momenta are reachable for certain, (B,).
        outside: None is, (B,).
    """

    inside: np.ndarray
    outside: np.ndarray


def applies(rings: Rings) -> bool:
    """Return whether an array has three circles in three dimensions."""
    return rings.m == 3 and len(rings.ring_of) == 3


def judged(rings: Rings, hulls: np.ndarray) -> Verdict:
    """Return what is known about hulls (B, p, 3)."""
    normal = np.cross(rings.circles[:, 0], rings.circles[:, 1])
    radius = np.linalg.norm(rings.circles[:, 0], axis=1)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    inside, outside = np.zeros(len(hulls), bool), np.zeros(len(hulls), bool)
    for i, j, k in _ORDERS:
        across = np.cross(normal[j], normal[k])
        size = np.linalg.norm(across)
        if size < _OBLIQUE:
            continue
        axes = np.stack([across / size, normal[k] / size, normal[j] / size])
        turning = rings.circles[i] @ axes.T  # (2, 3)
        for way in (1.0, -1.0):
            left = np.flatnonzero(~(inside | outside))
            if len(left):
                verdict = _turned(turning, radius[[j, k]], hulls[left] @ axes.T, way)
                inside[left], outside[left] = verdict
    return Verdict(inside, outside)


def _turned(
    turning: np.ndarray, radius: np.ndarray, along: np.ndarray, way: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return where f changes sign on a branch while phi turns twice, and where it has no zero.

    Args:
        turning: Components of circle i along the axes of y . w, x_j, x_k, (2, 3).
        radius: r_j and r_k, (2,).
        along: The hulls' corners along these axes, (B, p, 3).
        way: 1 or -1, the sense in which phi turns.
    """
    count = len(along)
    step = way * 2 * np.pi / _STEPS
    sag = np.hypot(*turning) * step**2 / 8
    constants = turning, radius, sag, np.array([np.cos(step), np.sin(step)])
    low, high = along.min(axis=1), along.max(axis=1)
    phase = np.tile([1.0, 0.0], (count, 1))
    state = [phase, low - turning[0], high - turning[0], np.zeros((count, 2, 2))]
    state += [np.zeros(count), np.ones(count)]
    lanes = Lanes(_step, constants, ((2,), (3,), (3,), (2, 2), (), (), (3,), (3,)))
    found = lanes(*state, low, high, rounds=2 * _STEPS, back=6)
    return found[4] > 0, found[5] > 0


def _step(
    turning: Any, radius: Any, sag: Any, turn: Any,
    phase: Any, low: Any, high: Any, last: Any, changed: Any, none: Any, least: Any, greatest: Any,
) -> Any:  # fmt: skip
    """Return the state at the next angle of the grid; source.

    Args:
        turning: As above, with ``radius``.
        radius: r_j and r_k.
        sag: How far y . w, x_j, x_k leave the line between two angles, (3,).
        turn: Cosine and sine of a step.
        phase: Cosine and sine of phi.
        low: Least y . w, x_j, x_k over the hull at phi, (3,).
        high: Greatest ones.
        last: Sign that f had on the branch (sign of z_j, of z_k), 0 if unknown, (2, 2).
        changed: 1 if f has changed sign on a branch.
        none: 1 if f has had no zero.
        least: Least of these components over the hull, without circle i.
        greatest: Greatest of them.
    """
    cosine, sine = phase
    phase = np.stack([cosine * turn[0] - sine * turn[1], sine * turn[0] + cosine * turn[1]])
    own = phase[0] * turning[0] + phase[1] * turning[1]
    before, after = _extent(low, high, radius), _extent(least - own, greatest - own, radius)
    between = _extent(
        ops.minimum(low, least - own) - sag, ops.maximum(high, greatest - own) + sag, radius
    )
    none = ops.where(_zero_free(between, radius), none, 0.0)
    for one, other in ((0, 1), (1, 0)):  # circle `one` ends, the other goes on
        ends = ops.logical_and(before.valid, ops.less(radius[one] + _TINY, after.nearest[one]))
        ends = ops.logical_and(ends, ops.less(between.farthest[other], radius[other] - _TINY))
        pairs = last[0] * last[1] if one == 0 else last[:, 0] * last[:, 1]
        differ = ops.less(ops.minimum(pairs[0], pairs[1]), 0.0)
        changed = ops.where(ops.logical_and(ends, differ), 1.0, changed)
    last = ops.where(between.valid, last, 0.0)
    sign = _signs(after)
    changed = ops.where(ops.less(ops.amin((last * sign).reshape(4)), 0.0), 1.0, changed)
    last = ops.where(ops.equal(sign, 0.0), last, sign)
    return phase, least - own, greatest - own, last, changed, none


class _Extent(NamedTuple):
    """What y . w, x and z may be over a hull: y . w in [low, high], |x| and |z| for j and k."""

    low: Any
    high: Any
    nearest: Any
    farthest: Any
    smallest: Any
    largest: Any
    valid: Any


def _extent(low: Any, high: Any, radius: Any) -> _Extent:
    farthest = ops.maximum(-low[1:], high[1:])
    nearest = ops.maximum(ops.maximum(low[1:], -high[1:]), 0.0)
    smallest, largest = (
        ops.sqrt(ops.maximum(radius * radius - x * x, 0.0)) for x in (farthest, nearest)
    )
    inside = ops.less(farthest, radius - _TINY)
    valid = ops.logical_and(inside[0], inside[1])
    return _Extent(low[0], high[0], nearest, farthest, smallest, largest, valid)


def _signs(at: _Extent) -> Any:
    """Return the sign of f on each branch, 0 where it is not the same all over, (2, 2)."""
    rows = [[_sign(at, p, q) for q in (1, -1)] for p in (1, -1)]
    return ops.where(at.valid, np.array(rows), 0.0)


def _sign(at: _Extent, p: int, q: int) -> Any:
    least, greatest = zip(_root(at, 0, p), _root(at, 1, q), strict=True)
    above = ops.less(_TINY, at.low - greatest[0] - greatest[1])
    below = ops.less(at.high - least[0] - least[1], -_TINY)
    return ops.where(above, 1.0, ops.where(below, -1.0, 0.0))


def _root(at: _Extent, circle: int, sign: int) -> tuple[Any, Any]:
    small, large = at.smallest[circle], at.largest[circle]
    return (small, large) if sign > 0 else (-large, -small)


def _zero_free(at: _Extent, radius: Any) -> Any:
    """Return whether f has no zero on any branch, or no branch is there."""
    ended = ops.less(radius + _TINY, at.nearest)
    signs = [ops.equal(_sign(at, p, q), 0.0) for p in (1, -1) for q in (1, -1)]
    unknown = ops.logical_or(ops.logical_or(*signs[:2]), ops.logical_or(*signs[2:]))
    return ops.logical_or(ops.logical_or(ended[0], ended[1]), ops.logical_not(unknown))
