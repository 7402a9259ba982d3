"""The convex hull of R: what is beyond it, and cells that follow its surface."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.spatial import cKDTree

from nullmotion.atlas.envelope_cells import SEEDS, ball
from nullmotion.atlas.envelope_frusta import Frusta
from nullmotion.atlas.envelope_rings import Rings

_PIECES = 8  # along each edge of a cube's face
_DIRECTIONS = 24  # pieces of those u for which S(u) is kept
_NEAR = 4  # of which are looked at for a cell


class Outside:
    """What is known to be outside of R's convex hull.

    Directions are spread evenly over the ellipsoid whose half axes are those of
    sum_k outer_k^2 (s_k s_k^T + t_k t_k^T), which has about the shape of R.
    """

    def __init__(self, rings: Rings) -> None:
        """Work S(u) out in many directions."""
        self.rings = rings
        scaled = (rings.outer[:, None, None] * rings.frames).reshape(-1, rings.m)
        self.shape = np.linalg.cholesky(scaled.T @ scaled)  # L; w = L x
        x = ball(rings.m, 1.0, 0, _DIRECTIONS, 1).centres()
        u = np.linalg.solve(self.shape.T, x.T).T
        self.u = np.concatenate([u, -u])
        self.support = rings.support(self.u)
        self.tree = cKDTree(self._even(rings.top(self.u)))

    def cut(self, cells: Frusta) -> Frusta:
        """Return what of the cells is not beyond the hull."""
        last = np.minimum(cells.ends[:, 1], self.last(cells.base))
        ends = np.stack([cells.ends[:, 0], last], axis=1)
        return replace(cells, ends=ends).take(last > cells.ends[:, 0])

    def last(self, base: np.ndarray) -> np.ndarray:
        """Return a bound of t in the hull for each base (B, k, m), (B,)."""
        even = self._even(base.mean(axis=1))
        own = np.linalg.solve(self.shape.T, even.T).T  # normal of the ellipsoid
        near = self.tree.query(even, _NEAR)[1]
        u = np.concatenate([own[:, None], self.u[near]], axis=1)
        size = np.concatenate([self.rings.support(own)[:, None], self.support[near]], axis=1)
        ahead = np.einsum("bnm,bkm->bnk", u, base).min(axis=2)
        bound = np.where(ahead > 0, size / np.maximum(ahead, 1e-300), np.inf)
        least: np.ndarray = bound.min(axis=1)
        return least

    def _even(self, h: np.ndarray) -> np.ndarray:
        """Return the directions of momenta as seen where the ellipsoid is a ball, (B, m)."""
        x = np.linalg.solve(self.shape, h.T).T
        even: np.ndarray = x / np.linalg.norm(x, axis=1, keepdims=True)
        return even


def cover(rings: Rings, outside: Outside) -> Frusta:
    """Return cells that cover half of R, for m = 2 and 3."""
    faces = ball(rings.m, 1.0, 0, _PIECES, 1)
    corner = faces.hulls()[:, 2 ** (rings.m - 1) :]
    order = [[0, 1]] if rings.m == 2 else [[0, 1, 3], [0, 3, 2]]
    base = corner[:, order].reshape(-1, 1, rings.m) @ outside.shape.T
    base = (base * outside.last(base)[:, None, None]).reshape(-1, rings.m, rings.m)
    ends = np.stack([np.zeros(len(base)), outside.last(base)], axis=1)
    return Frusta(base, ends, np.zeros((len(base), SEEDS, len(rings.ring_of))))
