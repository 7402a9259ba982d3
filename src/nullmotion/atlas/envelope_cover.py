"""Which cells of momentum space are proven to be reachable, and how to cut the others."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from nullmotion.atlas import envelope_inside, envelope_three
from nullmotion.atlas.envelope_cells import SEEDS, Cells
from nullmotion.atlas.envelope_rings import Rings
from nullmotion.atlas.envelope_search import Samples, sampled, solved, unlike

_STARTS = 12  # of each kind for a momentum by itself
_FRESH = 4  # starts from random samples
_NEIGHBOURS = (0, 2, 5)  # proven cells near by whose angles are tried, by rank
_HELD = 1e-9  # distance at which angles hold a momentum, in units of the mean momentum
_MORE = 12  # of Newton's steps where they converge slowly
_CLOSE = 0.01  # distance up to which angles are worth keeping
_SLENDER = 16.0  # greatest ratio of a cell's edges


@dataclass(eq=False)
class Findings:
    """What became of cells.

    Attributes:
        inside: Proven to be reachable, (B,).
        reached: Whether angles were found that hold the cell's centre, (B,).
        cells: The cells with the best angles found.
        axis: Where to cut each, (B,).
    """

    inside: np.ndarray
    reached: np.ndarray
    cells: Cells
    axis: np.ndarray


class Explorer:
    """Proves cells reachable; learns from proven cells where to look next to them."""

    def __init__(self, rings: Rings) -> None:
        """Sample the array's momenta."""
        self.rings = rings
        self.samples: Samples = sampled(rings)
        self.known = np.zeros((0, rings.m)), np.zeros((0, len(rings.ring_of)))

    def explore(self, cells: Cells) -> Findings:
        """Return what is found about cells (B > 0)."""
        attempt = _Attempt(self.rings, cells)
        spare = len(self.rings.ring_of) > self.rings.m
        for k in range(cells.seeds.shape[1]):
            attempt.follow(lambda i, k=k: cells.seeds[i, k], 4, 2 * spare)
        if len(self.known[0]) > 6:
            self._ask_neighbours(attempt, 2 * spare)
        left = np.flatnonzero(~attempt.inside)
        starts = self.samples.near(attempt.centres[left], _FRESH)
        for k in range(_FRESH):
            attempt.follow(lambda i, k=k: starts[np.searchsorted(left, i), k], 6, 4 * spare)
        if envelope_three.applies(self.rings):
            left = np.flatnonzero(~attempt.inside)
            attempt.inside[left] = envelope_three.proven(self.rings, attempt.hulls[left])
        self._learn(attempt)
        return attempt.findings()

    def starts(self, h: np.ndarray) -> np.ndarray:
        """Return angles (B, S, c) from which to look for momenta (B, m)."""
        found = self.samples.near(h, _STARTS)
        if len(self.known[0]) < _STARTS:
            return found
        near = cKDTree(self.known[0]).query(h, _STARTS)[1]
        return np.concatenate([found, self.known[1][near]], axis=1)

    def _ask_neighbours(self, attempt: _Attempt, climbing: int) -> None:
        left = np.flatnonzero(~attempt.inside)
        ranks = [r + 1 for r in _NEIGHBOURS]
        near = cKDTree(self.known[0]).query(attempt.centres[left], ranks)[1]
        for k in range(len(ranks)):
            attempt.follow(
                lambda i, k=k: self.known[1][near[np.searchsorted(left, i), k]], 5, climbing
            )

    def _learn(self, attempt: _Attempt) -> None:
        good = attempt.inside & (attempt.score.max(axis=1) > 0)
        best = attempt.angles[np.arange(len(good)), attempt.score.argmax(axis=1)]
        fresh = attempt.centres[good], best[good]
        self.known = tuple(np.concatenate(p) for p in zip(self.known, fresh, strict=True))  # type: ignore[assignment]


class _Attempt:
    """Cells with the angles tried for them so far."""

    def __init__(self, rings: Rings, cells: Cells) -> None:
        self.rings, self.cells = rings, cells
        self.centres, self.hulls = cells.centres(), cells.hulls()
        count = len(cells)
        self.inside, self.reached = np.zeros(count, bool), np.zeros(count, bool)
        self.score = np.zeros((count, 0))
        self.angles = np.zeros((count, 0, len(rings.ring_of)))
        self.best = np.full(count, -1.0)
        self.bottleneck = np.zeros((count, rings.m, rings.m))

    def follow(self, start: object, steps: int, climbing: int) -> None:
        """Solve for the centres of the cells that are left, and try to prove these cells."""
        left = np.flatnonzero(~self.inside)
        if len(left) == 0:
            return
        delta = solved(self.rings, start(left), self.centres[left], steps, climbing)  # type: ignore[operator]
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

    def findings(self) -> Findings:
        """Return the cells with their best angles, and where to cut them."""
        seeds = unlike(self.angles, self.score, SEEDS)
        edges, sag = self.cells.edges(self.hulls)
        length = np.linalg.norm(edges, axis=2)
        need = np.abs(edges @ self.bottleneck.mT).max(axis=2)
        need[:, :-1] += np.abs(sag[:, None] @ self.bottleneck.mT).max(axis=2)
        slender = length < length.max(axis=1, keepdims=True) / _SLENDER
        axis = np.where(slender | (length == 0), -1.0, need).argmax(axis=1)
        cells = self.cells.seeded(seeds)
        return Findings(self.inside, self.reached, cells, axis)
