"""Cells of momentum space, and what is tried to prove them reachable."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from nullmotion.atlas import envelope_inside
from nullmotion.atlas.envelope_cells import SEEDS
from nullmotion.atlas.envelope_rings import Rings
from nullmotion.atlas.envelope_search import solved, unlike

_HELD = 1e-9  # distance at which angles hold a momentum, in units of the mean momentum
_MORE = 12  # of Newton's steps where they converge slowly
_CLOSE = 0.01  # distance up to which angles are worth keeping
_SLENDER = 16.0  # greatest ratio of a cell's edges


class Region(Protocol):
    """Cells of momentum space with angles to begin with, ``seeds`` (B, SEEDS, c)."""

    @property
    def seeds(self) -> np.ndarray: ...  # noqa: D102
    def __len__(self) -> int: ...
    def centres(self) -> np.ndarray: ...  # noqa: D102
    def hulls(self) -> np.ndarray: ...  # noqa: D102
    def edges(self, hulls: np.ndarray) -> tuple[np.ndarray, np.ndarray]: ...  # noqa: D102


class Attempt:
    """Cells with the angles tried for them so far."""

    def __init__(self, rings: Rings, cells: Region) -> None:
        self.rings = rings
        self.centres, self.hulls = cells.centres(), cells.hulls()
        count = len(cells)
        self.inside, self.reached, self.outside = np.zeros((3, count), bool)
        self.score = np.full((count, 1), -1.0)
        self.angles = np.zeros((count, 1, len(rings.ring_of)))
        self.best = np.full(count, -1.0)
        self.bottleneck = np.zeros((count, rings.m, rings.m))

    @property
    def left(self) -> np.ndarray:
        """Indices of the cells that are undecided."""
        return np.flatnonzero(~(self.inside | self.outside))

    def follow(self, start: np.ndarray, steps: int, climbing: int) -> None:
        """Solve for the centres of the cells that are left, and try to prove these cells.

        Args:
            start: Angles to start from for all cells, (B, c).
            steps: Of Newton.
            climbing: Those of them with null motion towards regular angles.
        """
        left = self.left
        if len(left) == 0:
            return
        delta = solved(self.rings, start[left], self.centres[left], steps, climbing)
        miss = self._miss(delta, left)
        slow = np.flatnonzero((miss > _HELD) & (miss < _CLOSE))  # next to a fold
        if len(slow):
            delta[slow] = solved(self.rings, delta[slow], self.centres[left[slow]], _MORE)
            miss[slow] = self._miss(delta[slow], left[slow])
        self.reached[left[miss < _HELD]] = True
        good, score = self._try(left, delta, False)
        if (self.rings.inner < self.rings.outer).any():
            also, other = self._try(left, delta, True)
            good, score = good | also, np.maximum(score, other)
        self.inside[left[good]] = True
        self.reached[left[good]] = True
        self._keep(left, delta, np.where(miss < _CLOSE, score, 0.0))

    def _miss(self, delta: np.ndarray, which: np.ndarray) -> np.ndarray:
        miss: np.ndarray = np.abs(self.rings.momentum(delta) - self.centres[which]).max(axis=1)
        return miss

    def _try(
        self, left: np.ndarray, delta: np.ndarray, discs: bool
    ) -> tuple[np.ndarray, np.ndarray]:
        proofs = envelope_inside.proven(self.rings, delta, self.hulls[left], discs)
        better = proofs.sigma > self.best[left]
        chosen = left[better]
        self.best[chosen] = proofs.sigma[better]
        self.bottleneck[chosen] = proofs.bottleneck[better]
        return proofs.good, proofs.sigma

    def _keep(self, left: np.ndarray, delta: np.ndarray, score: np.ndarray) -> None:
        column = np.full((len(self.inside), 1), -1.0)
        angles = np.zeros((len(self.inside), 1, delta.shape[1]))
        column[left, 0], angles[left, 0] = score, delta
        self.score = np.concatenate([self.score, column], axis=1)
        self.angles = np.concatenate([self.angles, angles], axis=1)

    def seeds(self) -> np.ndarray:
        """Return the best angles of each cell, (B, SEEDS, c)."""
        return unlike(self.angles, self.score, SEEDS)

    def axis(self, cells: Region) -> np.ndarray:
        """Return the edge of each cell that takes most of the room of its proof, (B,)."""
        edges, sag = cells.edges(self.hulls)
        length = np.linalg.norm(edges, axis=2)
        need = np.abs(edges @ self.bottleneck.mT).max(axis=2)
        need[:, :-1] += np.abs(sag[:, None] @ self.bottleneck.mT).max(axis=2)
        slender = length < length.max(axis=1, keepdims=True) / _SLENDER
        axis: np.ndarray = np.where(slender | (length == 0), -1.0, need).argmax(axis=1)
        return axis
