"""Which cells of momentum space are proven to be reachable, and how to cut the others."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Generic, TypeVar

import numpy as np
from scipy.spatial import cKDTree

from nullmotion.atlas import envelope_three
from nullmotion.atlas.envelope_attempt import Attempt, Region
from nullmotion.atlas.envelope_rings import Rings
from nullmotion.atlas.envelope_search import Samples, sampled, solved

_STARTS = 12  # of each kind for a momentum by itself
_AMONG = 150  # samples for these
_PATIENT = 30  # steps of Newton for a momentum by itself
_HELD = 1e-7  # distance at which angles hold it, in units of the mean momentum
_FRESH = 4  # starts from random samples
_NEIGHBOURS = (0, 2, 5)  # proven cells near by whose angles are tried, by rank


C = TypeVar("C", bound=Region)


@dataclass(eq=False)
class Findings(Generic[C]):
    """What became of cells.

    Attributes:
        inside: Proven to be reachable, (B,).
        outside: Proven to be unreachable, (B,).
        reached: Whether angles were found that hold the cell's centre, (B,).
        cells: The cells.
        seeds: The best angles found, (B, SEEDS, c).
        axis: Where to cut each, (B,).
    """

    inside: np.ndarray
    outside: np.ndarray
    reached: np.ndarray
    cells: C
    seeds: np.ndarray
    axis: np.ndarray


class Explorer:
    """Proves cells reachable; learns from proven cells where to look next to them."""

    def __init__(self, rings: Rings) -> None:
        """Sample the array's momenta."""
        self.rings = rings
        self.samples: Samples = sampled(rings)
        self.known_h = np.zeros((0, rings.m))
        self.known_delta = np.zeros((0, len(rings.ring_of)))

    def explore(self, cells: C) -> Findings[C]:
        """Return what is found about cells (B > 0)."""
        attempt = Attempt(self.rings, cells)
        spare = len(self.rings.ring_of) > self.rings.m
        if envelope_three.applies(self.rings):
            attempt.inside, attempt.outside = envelope_three.judged(self.rings, attempt.hulls)
        for k in range(cells.seeds.shape[1]):
            attempt.follow(cells.seeds[:, k], 4, 2 * spare)
        if len(self.known_h) > max(_NEIGHBOURS):
            self._ask(attempt, self._neighbours, len(_NEIGHBOURS), 5, 2 * spare)
        self._ask(attempt, self._fresh, _FRESH, 6, 4 * spare)
        self._learn(attempt)
        shown = attempt.inside, attempt.outside, attempt.reached
        return Findings(*shown, cells, attempt.seeds(), attempt.axis(cells))

    def starts(self, h: np.ndarray) -> np.ndarray:
        """Return angles (B, S, c) from which to look for momenta (B, m)."""
        found = self.samples.near(h, _STARTS, _AMONG)
        if len(self.known_h) < _STARTS:
            return found
        near = cKDTree(self.known_h).query(h, _STARTS)[1]
        return np.concatenate([found, self.known_delta[near]], axis=1)

    def held(self, points: np.ndarray, seeds: np.ndarray) -> np.ndarray:
        """Return where angles are found for all of the momenta (B, p, m), (B,).

        Args:
            points: Momenta that are close together.
            seeds: Angles (B, S, c) to begin with.
        """
        count, p, m = points.shape
        goal = points.reshape(-1, m)
        start = np.concatenate([np.repeat(seeds, p, axis=0), self.starts(goal)], axis=1)
        each = np.repeat(goal, start.shape[1], axis=0)
        delta = solved(self.rings, start.reshape(len(each), -1), each, _PATIENT)
        miss = np.abs(self.rings.momentum(delta).reshape(*start.shape[:2], m) - goal[:, None])
        found = miss.max(axis=2).min(axis=1) < _HELD
        if envelope_three.applies(self.rings):
            found |= envelope_three.judged(self.rings, goal[:, None]).inside
        every: np.ndarray = found.reshape(count, p).all(axis=1)
        return every

    def _ask(
        self,
        attempt: Attempt,
        source: Callable[[np.ndarray], np.ndarray],
        count: int,
        steps: int,
        climbing: int,
    ) -> None:
        """Follow the angles (B, count, c) that a source has for the momenta that are left."""
        left = attempt.left
        starts = np.zeros((len(attempt.inside), count, len(self.rings.ring_of)))
        if len(left):
            starts[left] = source(attempt.centres[left])
        for k in range(count):
            attempt.follow(starts[:, k], steps, climbing)

    def _neighbours(self, h: np.ndarray) -> np.ndarray:
        near = cKDTree(self.known_h).query(h, [rank + 1 for rank in _NEIGHBOURS])[1]
        return self.known_delta[near]

    def _fresh(self, h: np.ndarray) -> np.ndarray:
        return self.samples.near(h, _FRESH)

    def _learn(self, attempt: Attempt) -> None:
        good = attempt.inside & (attempt.score.max(axis=1) > 0)
        best = attempt.angles[np.arange(len(good)), attempt.score.argmax(axis=1)]
        self.known_h = np.concatenate([self.known_h, attempt.centres[good]])
        self.known_delta = np.concatenate([self.known_delta, best[good]])
