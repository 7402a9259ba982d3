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

import numpy as np

from nullmotion.atlas.envelope_rings import Rings

_ROUNDS = 40  # of Frank and Wolfe
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
    separated, u = np.zeros(len(hulls), bool), sets.u.copy()
    point, z = _extreme(rings, sets, hulls, u)
    active = np.arange(len(hulls))
    for _ in range(_ROUNDS):
        gap = point[active] - _sum(rings, z[active])
        size = np.linalg.norm(gap, axis=1)
        u[active] = gap / np.maximum(size, 1e-300)[:, None]
        ahead, extreme = _extreme(rings, sets.take(active), hulls[active], u[active])
        farthest = ahead - _sum(rings, extreme)
        separated[active] = np.sum(u[active] * farthest, axis=1) > _MARGIN
        change = farthest - gap
        length = np.maximum(np.sum(change * change, axis=1), 1e-300)
        share = np.clip(-np.sum(gap * change, axis=1) / length, 0.0, 1.0)[:, None]
        point[active] += share * (ahead - point[active])
        z[active] += share[..., None] * (extreme - z[active])
        active = active[~separated[active] & (size > _REACHED)]
        if len(active) == 0:
            break
    hole = rings.inner - np.linalg.norm(z, axis=2)
    gap = np.linalg.norm(point - _sum(rings, z), axis=1)
    reached = ~separated & (hole.max(axis=1) < _REACHED) & (gap < 1e-6)
    return separated, reached, hole, u


def _extreme(
    rings: Rings, sets: _Sectors, hulls: np.ndarray, u: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return the hulls' points with least y . u (I, m), the sectors' with greatest (I, k, 2)."""
    rows = np.arange(len(u))
    ahead = hulls[rows, (hulls @ u[..., None])[..., 0].argmin(axis=1)]
    along = np.einsum("krm,im->ikr", rings.frames, u)
    star = np.arctan2(along[..., 1], along[..., 0])
    aside = (star - sets.centre + np.pi) % (2 * np.pi) - np.pi
    angle = sets.centre + np.clip(aside, -sets.width, sets.width)
    radius = np.where(np.cos(star - angle) >= 0, rings.outer, rings.inner)
    return ahead, radius[..., None] * np.stack([np.cos(angle), np.sin(angle)], axis=-1)


def _sum(rings: Rings, z: np.ndarray) -> np.ndarray:
    total: np.ndarray = np.einsum("ikr,krm->im", z, rings.frames)
    return total
