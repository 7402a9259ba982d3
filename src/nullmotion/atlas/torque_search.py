"""The greatest torque capability over all null motion, for all momenta of a grid together.

Every momentum climbs from starts of its own. What it finds is then tried on the momenta around
it, far ones first: maxima come in branches that are smooth over momentum space, and one good start
finds a whole branch.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.spatial import cKDTree

from nullmotion.atlas.torque_climb import Climber, Stages
from nullmotion.atlas.torque_pool import Pool
from nullmotion.atlas.torque_starts import Starts, drawn

_ROUGH: Stages = ((4.0, 5), (16.0, 4), (64.0, 4), (256.0, 4), (256.0, 0))
_SHORT: Stages = ((16.0, 3), (64.0, 3), (256.0, 4), (256.0, 0))
_FINE: Stages = ((256.0, 4), (1024.0, 6), (4096.0, 8), (4096.0, 0))
_BACK: Stages = ((1.0, 0),) * 16  # a step to the momentum each, and none of null motion
_STARTS = 100_000  # of all momenta together
_LEAST, _MOST = 16, 256  # of one momentum
_TOGETHER = 10_000  # starts at a time, but for four of each momentum at least
_AGAIN = 0.5  # starts around the best, over the others
_AWAY = (0.2, 0.4, 0.8, 1.6)  # rad; how far around
_LOST = 12  # starts of either kind for a momentum that is not reached
_JUMPS = (4, 2, 1)  # cells
_SWEEPS = 6
_CLOSE = 1e-6  # miss over the mean momentum up to which a climb counts
_MARGIN = 2.0  # at sharpness p a climb may be this over p (in the logarithm) behind, and win
_BEHIND = 0.1  # and this much, to be second or third
_HOPELESS = 0.3  # far behind already where it comes from
_SAME = 0.15  # rad; angles this close to known ones lead to the same maximum
_FINAL = 0.02  # behind the best: may win by the last steps
_AROUND = ((0, 1), (0, -1), (1, 0), (-1, 0))

Report = Callable[[float], None]


class Search:
    """A grid of momenta with the best angles found so far.

    Attributes:
        pool: What is found; see `best`.
    """

    def __init__(
        self, climber: Climber, momenta: np.ndarray, possible: np.ndarray, mirrored: bool
    ) -> None:
        """Take a grid.

        Args:
            climber: Of the array.
            momenta: Over the mean momentum, without bias, (rows, columns, m).
            possible: Momenta that may be within reach, (rows, columns).
            mirrored: Whether the grid is its own mirror image: h to -h, delta to delta + pi.
        """
        self.climber, self.shape = climber, momenta.shape[:2]
        self.h = momenta.reshape(-1, climber.m)
        self.pool = Pool(len(self.h), climber.n, mirrored)
        half = (len(self.h) + 1) // 2 if mirrored else len(self.h)
        self.todo = np.flatnonzero(possible.ravel()[:half])
        self._rng = np.random.default_rng(20240608)

    def best(self, report: Report) -> tuple[np.ndarray, np.ndarray]:
        """Return the best angles (N, n) [rad], and whether there are any, (N,)."""
        starts = drawn(self.climber)
        own = int(np.clip(_STARTS / max(len(self.todo), 1), _LEAST, _MOST))
        together = int(np.clip(_TOGETHER / max(len(self.todo), 1), len(_AWAY), own))
        self._climb_first(starts.near(self.h[self.todo], own), together, report)
        self._look_for_lost(starts)
        for k, jump in enumerate(_JUMPS):
            self._sweep(jump, self.pool.value > -np.inf)
            report(0.3 + 0.1 * (k + 1))
        self._settle()
        report(0.7)
        for _ in range(0, int(_AGAIN * own), together):
            self._climb_again(together)
        report(0.8)
        self._settle()
        report(0.9)
        self._finish()
        return self.pool.delta[0], self.pool.reached

    def _reached(self) -> np.ndarray:
        there: np.ndarray = self.todo[self.pool.reached[self.todo]]
        return there

    def _climb_first(self, angles: np.ndarray, together: int, report: Report) -> None:
        """Climb from angles (B, S, n), some of each momentum's at a time."""
        for k in range(0, angles.shape[1], together):
            self._climb(self.todo, angles[:, k : k + together], _ROUGH)
            report(0.3 * min(1.0, (k + together) / angles.shape[1]))

    def _look_for_lost(self, starts: Starts) -> None:
        """Look longer for momenta that are not reached, from samples and from reached ones."""
        lost = self.todo[~self.pool.reached[self.todo]]
        there = np.flatnonzero(self.pool.reached)
        if len(lost) == 0:
            return
        angles = starts.near(self.h[lost], _LOST)
        if len(there) >= _LOST:
            near = cKDTree(self.h[there]).query(self.h[lost], _LOST)[1]
            angles = np.concatenate([angles, self.pool.delta[0, there[near]]], axis=1)
        self._climb(lost, angles, _BACK)

    def _climb_again(self, count: int) -> None:
        """Climb from around the best angles."""
        there = self._reached()
        best = self.pool.delta[0, there, None]
        away = np.resize(_AWAY, count)[:, None]
        noise = self._rng.normal(size=(len(there), count, self.climber.n))
        self._climb(there, best + away * noise, _ROUGH)

    def _settle(self) -> None:
        """Tell neighbours what is new until nothing is."""
        for _ in range(_SWEEPS):
            told = self.pool.fresh.copy()
            if not told.any():
                break
            self.pool.fresh[:] = False
            self._sweep(1, told)

    def _sweep(self, jump: int, told: np.ndarray) -> None:
        """Try angles that are marked (places, N) on the momenta some cells away."""
        row, column = np.divmod(self.todo, self.shape[1])
        for down, right in _AROUND:
            r, c = row + jump * down, column + jump * right
            there = (r >= 0) & (r < self.shape[0]) & (c >= 0) & (c < self.shape[1])
            target = self.todo[there]
            source = (r * self.shape[1] + c)[there]
            for place in range(len(told)):
                self._try(target, source, place, told[place, source])

    def _try(self, target: np.ndarray, source: np.ndarray, place: int, told: np.ndarray) -> None:
        """Climb at momenta (B,) from what others (B,) have in a place, if it is not known."""
        value = self.pool.value[place, source]
        use = told & (value > -np.inf) & (value > self.pool.value[0, target] - _HOPELESS)
        target, delta = target[use], self.pool.delta[place, source[use]]
        new = self.pool.distance(target, delta).min(axis=0) > _SAME
        self._climb(target[new], delta[new, None], _SHORT)

    def _climb(self, which: np.ndarray, angles: np.ndarray, stages: Stages) -> None:
        """Climb from angles (B, S, n) at momenta (B,), and keep what is worth it."""
        tries, n = angles.shape[1:]
        owner, turn = np.repeat(which, tries), np.tile(np.arange(tries), len(which))
        delta, value = angles.reshape(-1, n), np.zeros(len(owner))
        for sharpness, steps in stages:
            if len(owner) == 0:
                return
            found = self.climber.climbed(delta, self.h[owner], sharpness, steps)
            least = self.pool.value[0, owner] - _MARGIN / sharpness - _BEHIND
            kept = found.least > least
            owner, turn, delta = owner[kept], turn[kept], found.delta[kept]
            value = np.where(found.miss < _CLOSE, found.least, -np.inf)[kept]
        for k in range(tries):
            mine = turn == k
            self.pool.keep(owner[mine], delta[mine], value[mine])

    def _finish(self) -> None:
        """Climb to the top from all that may win."""
        there = self._reached()
        for delta, value in zip(self.pool.delta.copy(), self.pool.value.copy(), strict=True):
            close = there[value[there] > self.pool.value[0, there] - _FINAL]
            self._climb(close, delta[close, None], _FINE)
