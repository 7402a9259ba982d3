"""A proof that all momenta of a convex hull are reachable, from one set of angles.

Let delta be angles of the circles, A their Jacobian and A = U diag(sigma) V^T. With x = V rho,

    h(delta + x) = h(delta) + A x + q(x),    q = sum_i h_i (cos x_i - 1) + a_i (sin x_i - x_i)

exactly, so that h(delta + x) = y where rho solves

    rho = diag(1/sigma) U^T (y - h(delta) - q(V rho)).

The right-hand side is continuous. It maps the box |rho_k| <= R_k into itself if for every k

    Y_k + Q_k(R) <= sigma_k R_k,    Y_k >= |u_k . (y - h(delta))|,    Q_k >= |u_k . q|

and has a fixed point there (Brouwer). All y of a hull are reachable if that holds with Y_k the
greatest over the hull's corners. As |cos x - 1 + x^2/2| <= x^4/24 and |sin x - x| <= |x|^3/6,

    Q_k = 1/2 sum_jl |v_j^T diag(h_i . u_k) v_l| R_j R_l
          + sum_i |a_i . u_k| X_i^3 / 6 + |h_i . u_k| X_i^4 / 24,    X = |V| R.

(With one radius for all it is the ball of radius sigma_min^2 / (2 max h0) around h(delta): for
Q <= max h0 R^2 / 2, and R = sigma_min / max h0.)

A ring with width may be looked at as a disc instead of two circles: v = x s + y t is linear, two
columns s and t without curvature, good as long as (x, y) stays between the ring's edges.

R is found by repetition from below and confirmed with room for rounding. Source without
branches, compiled for many hulls at once.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from nullmotion import linalg, ops
from nullmotion.atlas.envelope_lanes import Lanes
from nullmotion.atlas.envelope_rings import Rings

_ROUNDS = 8
_ROOM = 1.02  # by which a box is wider than the last round asked for
_SAFE = 1.0 + 1e-9  # more than the rounding of the bounds, relative
_TINY = 1e-10  # more than that of the momenta, in units of the mean momentum
_WIDEST = 3.0  # [rad]
_LEAST = 1e-4  # least sigma: rounding of A V is below _TINY from there on


class Proofs(NamedTuple):
    """What is shown about hulls from one set of angles each.

    Attributes:
        good: Whether all of the hull is reachable for certain, (B,).
        sigma: Least singular value of the columns, (B,).
        bottleneck: U diag(1/sigma^2), transposed: how much of the box's room an edge of the
            hull takes, (B, m, m).
    """

    good: np.ndarray
    sigma: np.ndarray
    bottleneck: np.ndarray


def proven(rings: Rings, delta: np.ndarray, hulls: np.ndarray, discs: bool = False) -> Proofs:
    """Return which hulls (B, p, m) are reachable around angles (B, c).

    Args:
        rings: The array's rings.
        delta: Angles of the circles that hold a momentum in or near each hull.
        hulls: Corners.
        discs: Whether rings with width are looked at as discs.
    """
    p, m, c = hulls.shape[1], rings.m, delta.shape[1]
    if not discs:
        lanes = Lanes(_from_angles, (rings.circles,), ((c,), (p, m)))
        good, sigma, bottleneck = lanes(delta, hulls)
    else:
        part, column, joined = _as_discs(rings, delta)
        around = hulls - rings.momentum(delta)[:, None]
        lanes = Lanes(_from_columns, (joined,), ((c, m), (c, m), (p, m)))
        good, sigma, bottleneck = lanes(part, column, around)
    return Proofs(good > 0, sigma, bottleneck)


def _from_angles(circles: Any, delta: Any, hull: Any) -> Any:
    cosine, sine = ops.cos(delta)[:, None], ops.sin(delta)[:, None]
    part = cosine * circles[:, 0] + sine * circles[:, 1]
    column = cosine * circles[:, 1] - sine * circles[:, 0]
    return _from_columns(np.zeros(len(delta)), part, column, hull - part.sum(axis=0))


def _from_columns(joined: Any, part: Any, column: Any, hull: Any) -> Any:
    """Return whether a hull (p, m) around h(delta) is reachable, sigma_m, and the bottleneck.

    Args:
        joined: Above 0 for the first of two columns that are one disc, (c,).
        part: h_i, (c, m).
        column: a_i, (c, m).
        hull: y - h(delta) at the corners.
    """
    found = linalg.svd(column.T)
    sigma, U = ops.maximum(found.s, _LEAST), found.u
    axes = range(len(sigma))
    Y = np.array([ops.amax(ops.absolute(hull @ U[:, k])) for k in axes]) * _SAFE + _TINY
    along, bend = column @ U, part @ U  # (c, m)
    V = along / sigma
    bent = np.array([(V.T * bend[:, k]) @ V for k in axes])
    terms = [ops.absolute(x) for x in (V, bent, along, bend)]
    good = ops.where(ops.less(_LEAST, found.s[-1]), _settles(Y, sigma, terms, joined), 0.0)
    return good, found.s[-1], (U / (sigma * sigma)).T


def _settles(Y: Any, sigma: Any, terms: list[Any], joined: Any) -> Any:
    """Return 1 where a box is mapped into itself, else 0."""
    V, bent, along, bend = terms
    R, good = Y / sigma, 0.0
    for _ in range(_ROUNDS):
        box = R * _ROOM
        X = V @ box
        second = 0.5 * ((bent @ box) @ box)
        third = (X**3) @ along / 6 + (X**4) @ bend / 24
        R = (Y + (second + third) * _SAFE) / sigma
        fits = 1.0
        for k in range(len(box)):
            fits = ops.where(ops.less_equal(R[k], box[k]), fits, 0.0)
        for i in range(len(X) - 1):
            room = joined[i] * (X[i] * X[i] + X[i + 1] * X[i + 1])
            fits = ops.where(ops.less_equal(room, 1.0), fits, 0.0)
        good = ops.maximum(good, fits)
        R = ops.minimum(R, _WIDEST)
    return good


def _as_discs(rings: Rings, delta: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return parts and columns with each pair of circles replaced by s and t, times the slack.

    The slack is how far (x, y) may move before it meets an edge of its ring: a displacement of
    1 of the two scaled columns together. The third is 1 for the first circle of each pair.
    """
    part, column = rings.parts(delta)
    joined = np.zeros(delta.shape[1])
    for k in np.flatnonzero(rings.inner < rings.outer):
        i, j = np.flatnonzero(rings.ring_of == k)
        outer, inner = rings.outer[k], rings.inner[k]
        large, small = 0.5 * (outer + inner), 0.5 * (outer - inner)
        size = np.abs(large * np.exp(1j * delta[:, i]) + small * np.exp(1j * delta[:, j]))
        slack = np.maximum(outer - size, 0.0)
        if inner > 0:
            slack = np.minimum(slack, np.maximum(size - inner, 0.0))
        column[:, (i, j)] = (slack - _TINY).clip(0.0)[:, None, None] * rings.frames[k]
        part[:, (i, j)] = 0.0
        joined[i] = 1.0
    return part, column, joined
