"""Cells of momentum space that follow the outer surface: cones cut off by parallel planes.

    h = t sum_k l_k P_k,    l_k >= 0, sum l_k = 1,    t in an interval

for m momenta P_k: at t = 1 the flat piece between them. With P_k on the boundary of R's convex
hull nothing is reachable from some t on that is hardly more than 1: for any u,

    t min_k u . P_k <= h . u <= S(u).

A cell is the convex hull of its 2 m corners. R is the same seen from both sides, so half of all
directions are enough.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import combinations
from math import factorial

import numpy as np


@dataclass(frozen=True, eq=False)
class Frusta:
    """Cells, and gimbal angles from which to look for their momenta.

    Attributes:
        base: The momenta P_k, (B, m, m).
        ends: Ends of t, (B, 2).
        seeds: Angles of the circles that hold momenta near by, (B, SEEDS, c).
    """

    base: np.ndarray
    ends: np.ndarray
    seeds: np.ndarray

    def __len__(self) -> int:
        """Return the number of cells."""
        return len(self.base)

    @property
    def share(self) -> np.ndarray:
        """Volume of each cell (m = 2: area), (B,)."""
        m = self.base.shape[1]
        cone = np.abs(np.linalg.det(self.base)) / factorial(m)
        share: np.ndarray = cone * (self.ends[:, 1] ** m - self.ends[:, 0] ** m)
        return share

    def take(self, chosen: np.ndarray) -> Frusta:
        """Return some of the cells."""
        return Frusta(self.base[chosen], self.ends[chosen], self.seeds[chosen])

    def joined(self, other: Frusta) -> Frusta:
        """Return these cells and others."""
        pairs = {k: (getattr(self, k), getattr(other, k)) for k in ("base", "ends", "seeds")}
        return Frusta(**{k: np.concatenate(v) for k, v in pairs.items()})

    def seeded(self, seeds: np.ndarray) -> Frusta:
        """Return the cells with other seeds."""
        return replace(self, seeds=seeds)

    def centres(self) -> np.ndarray:
        """Return a momentum in each cell, (B, m)."""
        middle: np.ndarray = self.base.mean(axis=1) * self.ends.mean(axis=1)[:, None]
        return middle

    def hulls(self) -> np.ndarray:
        """Return the corners, (B, 2 m, m)."""
        near, far = (self.ends[:, k, None, None] * self.base for k in (0, 1))
        return np.concatenate([near, far], axis=1)

    def edges(self, _: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the edges along each pair of P_k, then along t, (B, a, m); there is no sag."""
        rows = [self.base[:, i] - self.base[:, j] for i, j in self._pairs()]
        across = [self.ends[:, 1, None] * row for row in rows]
        along = self.base.mean(axis=1) * (self.ends[:, 1] - self.ends[:, 0])[:, None]
        return np.stack([*across, along], axis=1), np.zeros_like(along)

    def halves(self, axis: np.ndarray) -> Frusta:
        """Return both halves of each cell, cut along one edge each, (B,)."""
        parts = []
        for k, (i, j) in enumerate(self._pairs()):
            some = self.take(axis == k)
            for end in (i, j):
                base = some.base.copy()
                base[:, end] = some.base[:, (i, j)].mean(axis=1)
                parts.append(replace(some, base=base))
        some = self.take(axis == len(self._pairs()))
        for end in (0, 1):
            ends = some.ends.copy()
            ends[:, end] = some.ends.mean(axis=1)
            parts.append(replace(some, ends=ends))
        whole = parts[0]
        for part in parts[1:]:
            whole = whole.joined(part)
        return whole

    def points(self, rng: np.random.Generator) -> np.ndarray:
        """Return a random momentum in each cell, evenly spread over its volume, (B, m)."""
        count, m = self.base.shape[:2]
        low, high = self.ends.T**m
        t = (low + (high - low) * rng.random(count)) ** (1 / m)
        flat: np.ndarray = np.einsum("bk,bkm->bm", rng.dirichlet(np.ones(m), count), self.base)
        return t[:, None] * flat

    def _pairs(self) -> list[tuple[int, int]]:
        return list(combinations(range(self.base.shape[1]), 2))
