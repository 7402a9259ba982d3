"""A proof that no momentum of a convex hull is reachable: branch and bound over arcs.

Let each ring be cut down to a sector, its angle within w of c. The sectors' convex hulls have
the support function

    S_k(u) = outer |p_k| cos(e)   where cos(e) >= 0, else inner |p_k| cos(e),

p_k = (s_k . u, t_k . u) and e the angle from its direction to the sector. A vector u with

    min over the hull's corners of y . u  >  sum_k S_k(u)

separates the hull from everything that these sectors can hold. u is looked for by the
Frank-Wolfe method on the distance between hull and sum; whatever it finds, a positive
difference is proof. Sectors that are not separated are halved, the one whose nearest point is
deepest in the hole that its convex hull covers. A disc covers no hole: it is never cut. The
depth of that hole falls with the square of the sector's width, so that few sectors are cut small.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from nullmotion import linalg, ops
from nullmotion.atlas.envelope_lanes import Lanes
from nullmotion.atlas.envelope_rings import Rings

_ROUNDS = (8, 32)  # of Frank and Wolfe; the second for those not yet separated
_MARGIN = 1e-10  # of a separation, in units of the mean momentum
_REACHED = 1e-12  # distance at which a hull is reachable


@dataclass(eq=False)
class _Sectors:
    """Sets of sectors, one for each ring, and what they are to be separated from.

    Attributes:
        owner: Index of the hull, (I,).
        centre: Middle angles c, (I, k).
        width: Half widths w, (I, k).
        u: Vectors to begin with, (I, m).
    """

    owner: np.ndarray
    centre: np.ndarray
    width: np.ndarray
    u: np.ndarray

    def halves(self, chosen: np.ndarray, ring: np.ndarray, u: np.ndarray) -> _Sectors:
        """Return both halves of some sets, cut at one ring each."""
        rows = np.arange(len(ring))
        width, low = self.width[chosen].copy(), self.centre[chosen].copy()
        width[rows, ring] *= 0.5
        high = low.copy()
        low[rows, ring] -= width[rows, ring]
        high[rows, ring] += width[rows, ring]
        return _Sectors(
            np.tile(self.owner[chosen], 2),
            np.concatenate([low, high]),
            np.tile(width, (2, 1)),
            np.tile(u, (2, 1)),
        )

    def take(self, chosen: np.ndarray) -> _Sectors:
        """Return some of the sets."""
        return _Sectors(self.owner[chosen], self.centre[chosen], self.width[chosen], self.u[chosen])


def proven(rings: Rings, hulls: np.ndarray, most: int = 4000) -> np.ndarray:
    """Return which hulls (B, p, m) have no reachable momentum for certain, (B,).

    Args:
        rings: The array's rings.
        hulls: Corners; p = 1 for single momenta.
        most: Sets of sectors after which a hull is given up.
    """
    count, k = len(hulls), len(rings.inner)
    given_up, used = np.zeros(count, bool), np.zeros(count, int)
    u = hulls.mean(axis=1)
    todo = _Sectors(np.arange(count), np.zeros((count, k)), np.full((count, k), np.pi), u)
    while len(todo.owner):
        used += np.bincount(todo.owner, minlength=count)
        separated, reached, hole, u = _separate(rings, todo, hulls[todo.owner])
        given_up[todo.owner[reached]] = True
        given_up |= used > most
        left = np.flatnonzero(~separated & ~given_up[todo.owner])
        todo = todo.halves(left, hole[left].argmax(axis=1), u[left])
    return ~given_up


def _separate(
    rings: Rings, sets: _Sectors, hulls: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return which are separated, which reached, how deep in holes (I, k), and the last u."""
    count, k, m = len(hulls), len(rings.inner), rings.m
    shapes = ((m,), (m,), (k, 2), (), (), hulls.shape[1:], (k, 2), (k, 2))
    lanes = Lanes(_round, (rings.frames, rings.outer, rings.inner), shapes)
    centre, width = (np.stack([np.cos(x), np.sin(x)], axis=2) for x in (sets.centre, sets.width))
    fixed = hulls, centre, width
    state = [sets.u, np.zeros((count, m)), np.zeros((count, k, 2)), np.full(count, -np.inf)]
    state = list(lanes(*state, np.ones(count), *fixed)[:4])
    left = np.arange(count)
    for rounds in _ROUNDS:
        start = [x[left] for x in (*state, np.zeros(count), *fixed)]
        for whole, part in zip(state, lanes(*start, rounds=rounds, back=4), strict=True):
            whole[left] = part
        left = left[state[3][left] <= _MARGIN]
        if len(left) == 0:
            break
    u, point, z, best = state
    gap = np.linalg.norm(point - np.einsum("ikr,krm->im", z, rings.frames), axis=1)
    hole, separated = rings.inner - np.linalg.norm(z, axis=2), best > _MARGIN
    reached = ~separated & (hole.max(axis=1) < _REACHED) & (gap < 1e-6)
    return separated, reached, hole, u


def _round(
    frames: Any, outer: Any, inner: Any,
    u: Any, point: Any, z: Any, best: Any, first: Any, hull: Any, centre: Any, width: Any,
) -> Any:  # fmt: skip
    """Return u, point, z and the best separation after a round; source.

    Args:
        frames: Of the rings, (k, 2, m).
        outer: Their radii, (k,).
        inner: Those of their holes, (k,).
        u: Direction that is tried, (m,).
        point: Point of the hull, (m,).
        z: Points of the sectors' convex hulls, (k, 2).
        best: Greatest separation so far.
        first: 1 to begin with what is farthest along u.
        hull: Corners, (p, m).
        centre: Cosine and sine of c, (k, 2).
        width: Cosine and sine of w, (k, 2).
    """
    ahead, value = hull[0], hull[0] @ u
    for corner in hull[1:]:
        size = corner @ u
        ahead = ops.where(ops.less(size, value), corner, ahead)
        value = ops.minimum(size, value)
    rings = zip(frames, outer, inner, centre, width, strict=True)
    extreme = np.stack([_farthest(f @ u, *ring) for f, *ring in rings])
    total = sum(x @ f for x, f in zip(extreme, frames, strict=True))
    best = ops.maximum(u @ (ahead - total), best)
    gap = point - sum(x @ f for x, f in zip(z, frames, strict=True))
    change = ahead - total - gap
    share = -(gap @ change) / ops.maximum(change @ change, 1e-300)
    share = ops.where(ops.less(0.0, first), 1.0, ops.clip(share, 0.0, 1.0))
    point, z, gap = point + share * (ahead - point), z + share * (extreme - z), gap + share * change
    return gap / ops.maximum(linalg.norm(gap), 1e-300), point, z, best


def _farthest(along: Any, outer: Any, inner: Any, centre: Any, width: Any) -> Any:
    """Return the point of a sector with the greatest product with a vector, (2,); source."""
    size = ops.maximum(linalg.norm(along), 1e-300)
    cosine, sine = width
    side = ops.copysign(sine, centre[0] * along[1] - centre[1] * along[0])
    edge = cosine * centre + side * np.stack([-centre[1], centre[0]])
    way = ops.where(ops.less(along @ centre, size * cosine), edge, along / size)
    return way * ops.where(ops.less(way @ along, 0.0), inner, outer)
