"""A proof that all momenta of a convex hull are reachable, from one set of angles.

Let delta be angles of the circles, A their Jacobian and A = U diag(sigma) V^T. With x = V rho,

    h(delta + x) = h(delta) + A x + q(x),    q = sum_i h_i (cos x_i - 1) + a_i (sin x_i - x_i)

exactly, so that h(delta + x) = y where rho solves rho = diag(1/sigma) U^T (y - h(delta) - q(V rho)).
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

R is found by repetition from below and confirmed with room for rounding.
"""

from __future__ import annotations

import numpy as np

from nullmotion.atlas.envelope_rings import Rings

_ROUNDS = 12
_ROOM = 1.02  # by which a box is wider than the last round asked for
_SAFE = 1.0 + 1e-9  # more than the rounding of the bounds, relative
_TINY = 1e-11  # more than that of the momenta, in units of the mean momentum
_WIDEST = 3.0  # [rad]
_REGULAR = 1e-10  # least sigma^2 that rounding leaves accurate


def proven(
    rings: Rings, delta: np.ndarray, hulls: np.ndarray, discs: bool = False
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return which hulls (B, p, m) are reachable around angles (B, c), with sigma and U.

    Args:
        rings: The array's rings.
        delta: Angles of the circles that hold a momentum in or near each hull.
        hulls: Corners.
        discs: Whether rings with width are looked at as discs.

    Returns:
        Whether it is proven (B,), the singular values of the columns in rising order (B, m),
        and their left vectors as columns (B, m, m).
    """
    part, column = rings.parts(delta)
    momentum = part.sum(axis=1)
    if discs:
        part, column = _as_discs(rings, delta, part, column)
    square, U = np.linalg.eigh(column.mT @ column)
    sigma = np.sqrt(np.maximum(square, 1e-14))
    along, bend = column @ U, part @ U  # (B, c, m)
    V = along / sigma[:, None]
    Y = np.abs((hulls - momentum[:, None]) @ U).max(axis=1) * _SAFE + _TINY
    bent = (V[:, None] * bend.mT[..., None]).mT @ V[:, None]  # (B, k, j, l)
    terms = np.abs(V), np.abs(bent), np.abs(along), np.abs(bend)
    wide = rings.inner < rings.outer
    pairs = np.flatnonzero(wide[rings.ring_of]).reshape(-1, 2) if discs else np.zeros((0, 2), int)
    good = _settles(Y, sigma, terms, pairs) & (square[:, 0] > _REGULAR)
    return good, sigma, U


def _settles(
    Y: np.ndarray, sigma: np.ndarray, terms: tuple[np.ndarray, ...], pairs: np.ndarray
) -> np.ndarray:
    """Return where a box is mapped into itself, (B,)."""
    V, bent, along, bend = terms
    R, good = Y / sigma, np.zeros(len(Y), bool)
    for k in range(_ROUNDS):
        box = R * _ROOM
        X = (V @ box[..., None])[..., 0]
        second = 0.5 * np.einsum("bkjl,bj,bl->bk", bent, box, box)
        third = ((X**3)[:, None] @ along)[:, 0] / 6 + ((X**4)[:, None] @ bend)[:, 0] / 24
        R = (Y + (second + third) * _SAFE) / sigma
        fits = (box >= R).all(axis=1)
        for i, j in pairs:
            fits &= np.hypot(X[:, i], X[:, j]) <= 1.0
        good |= fits
        R = np.minimum(R, _WIDEST)
        if k > 2 and (good | (R >= _WIDEST).any(axis=1)).all():
            break
    return good


def _as_discs(
    rings: Rings, delta: np.ndarray, part: np.ndarray, column: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return parts and columns with each pair of circles replaced by s and t, times the slack.

    The slack is how far (x, y) may move before it meets an edge of its ring: a displacement of
    1 of the two scaled columns together.
    """
    part, column = part.copy(), column.copy()
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
    return part, column
