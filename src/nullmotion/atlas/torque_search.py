"""The greatest torque capability over all null motion, for all momenta of a grid together.

Every momentum climbs from several starts of its own, a few from many. What is best for a
momentum is then tried on its neighbours, far ones first: the set of the best angles is made of few
smooth pieces, so that one good start finds a whole piece.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
from scipy.spatial import cKDTree

from nullmotion.atlas.torque_climb import HELD, Climber, Stages
from nullmotion.atlas.torque_starts import Starts, drawn

_ROUGH: Stages = ((4.0, 5), (16.0, 4), (64.0, 4))
_SHORT: Stages = ((64.0, 3), (256.0, 3))
_FINE: Stages = ((256.0, 4), (1024.0, 6), (4096.0, 8))
_STAYING: Stages = ((1.0, 0),) * 16  # steps to the momentum alone
_OWN, _TOGETHER = 16, 4  # starts of each momentum, and how many of them at a time
_MANY, _STRIDE = 64, 3  # starts of every third momentum of every third row
_RESCUE = 12  # starts of either kind for a momentum that is not reached
_JUMPS = (8, 4, 2, 1)  # cells
_SWEEPS = 20
_ROUNDS, _TRIES = 3, 4
_SHAKES=(.15,.3,.6,1.2)
_ALIKE = 0.1
_MARGIN = 6.0
_LOW = 10.
_CLOSE = 1e-6  # miss over the mean momentum up to which a climb counts
_GAIN = 1e-3  # share of the torque capability that is worth telling the neighbours
_AROUND = ((0, 1), (0, -1), (1, 0), (-1, 0), (1, 1), (-1, -1), (1, -1), (-1, 1))

Report = Callable[[float], None]


class Search:
    """The best angles found so far on a grid.

    Attributes:
        best: Gimbal angles [rad], (N, n).
        value: Logarithm of their torque capability, -inf where no angles are found, (N,).
    """

    def __init__(
        self, climber: Climber, momenta: np.ndarray, inside: np.ndarray, mirrored: bool
    ) -> None:
        """Take a grid.

        Args:
            climber: Of the array.
            momenta: Over the mean momentum, without bias, (rows, columns, m).
            inside: Momenta that may be within reach, (rows, columns).
            mirrored: Whether the grid is its own mirror image: h to -h, delta to delta + pi.
        """
        self.climber, self.shape, self.mirrored = climber, momenta.shape[:2], mirrored
        self.h = momenta.reshape(-1, climber.m)
        self.size = len(self.h)
        self.best, self.value = np.zeros((self.size, climber.n)), np.full(self.size, -np.inf)
        half = (self.size + 1) // 2 if mirrored else self.size
        self.todo = np.flatnonzero(inside.ravel()[:half])
        self.fresh = np.zeros(self.size, bool)
        self.rng = np.random.default_rng(1)

    def run(self, report: Report) -> None:
        """Look for the best angles."""
        starts = drawn(self.climber)
        for share in self._own(starts):
            report(0.4 * share)
        self._spread()
        report(0.6)
        self._rescue(starts)
        self._few(starts)
        report(0.75)
        self._spread()
        self._settle()
        for _ in range(_ROUNDS):
            self._shake()
            self._settle()
        report(0.9)
        self._improve(_FINE)
        self.fresh[:] = self.value > -np.inf
        self._settle()
        self._improve(_FINE[1:])

    def _own(self, starts: Starts) -> Iterator[float]:
        """Climb from starts of each momentum's own."""
        angles = starts.near(self.h[self.todo], _OWN)
        for k in range(0, _OWN, _TOGETHER):
            self._climb(self.todo, angles[:, k : k + _TOGETHER], _ROUGH)
            yield (k + _TOGETHER) / _OWN

    def _few(self, starts: Starts) -> None:
        row, column = np.divmod(self.todo, self.shape[1])
        few = self.todo[(row % _STRIDE == 0) & (column % _STRIDE == 0)]
        angles = starts.near(self.h[few], _MANY)
        for k in range(0, _MANY, _OWN):
            self._climb(few, angles[:, k : k + _OWN], _ROUGH)

    def _shake(self) -> None:
        """Climb again from around the best angles: neighbouring maxima are many."""
        reached = self.todo[self.value[self.todo] > -np.inf]
        best = self.best[reached, None]
        sizes = np.resize(_SHAKES, _TRIES)[:, None]
        angles = best + sizes * self.rng.normal(size=(len(best), _TRIES, best.shape[2]))
        self._climb(reached, angles, _ROUGH)

    def _rescue(self, starts: Starts) -> None:
        """Look longer for momenta that are not reached: from samples and reached ones."""
        left, there = self.todo[self.value[self.todo] == -np.inf], np.flatnonzero(self.value > -np.inf)
        if len(left) == 0:
            return
        angles = starts.near(self.h[left], _RESCUE)
        if len(there) >= _RESCUE:
            near = cKDTree(self.h[there]).query(self.h[left], _RESCUE)[1]
            angles = np.concatenate([angles, self.best[there[near]]], axis=1)
        self._climb(left, angles, _STAYING)

    def _spread(self) -> None:
        """Try all best angles on neighbours, far ones first."""
        for jump in _JUMPS:
            self._sweep(jump, self.value > -np.inf)

    def _settle(self) -> None:
        """Tell neighbours what is new until nothing is."""
        for _ in range(_SWEEPS):
            if not self.fresh.any():
                break
            told = self.fresh.copy()
            self.fresh[:] = False
            self._sweep(1, told)

    def _sweep(self, jump: int, told: np.ndarray) -> None:
        """Try the best angles of marked momenta on those some cells away."""
        row, column = np.divmod(self.todo, self.shape[1])
        for down, right in _AROUND:
            r, c = row + jump * down, column + jump * right
            there = (r >= 0) & (r < self.shape[0]) & (c >= 0) & (c < self.shape[1])
            source = np.where(there, r * self.shape[1] + c, 0)
            there &= told[source]
            there &= self._unlike(source, self.todo)
            self._climb(self.todo[there], self.best[source[there], None], _SHORT)

    def _unlike(self, a: np.ndarray, b: np.ndarray) -> np.ndarray:
        """Return whether the best angles of momenta a and b are more than a step apart."""
        away = np.abs(np.sin(0.5 * (self.best[a] - self.best[b]))).max(axis=1)
        unlike: np.ndarray = (away > 0.5 * _ALIKE) | (self.value[b] == -np.inf)
        return unlike

    def _improve(self, stages: Stages) -> None:
        reached = self.todo[self.value[self.todo] > -np.inf]
        self._climb(reached, self.best[reached, None], stages)

    def _climb(self, which: np.ndarray, angles: np.ndarray, stages: Stages) -> None:
        """Climb from angles (B, S, n) of momenta (B,), and keep the best."""
        if len(which) == 0:
            return
        tries, n = angles.shape[1:]
        owner = np.repeat(np.arange(len(which)), tries)
        best, delta = self.value[which], angles.reshape(-1, n)
        for sharpness, steps in stages:
            if len(owner) == 0:
                return
            found = self.climber.climbed(delta, self.h[which[owner]], ((sharpness, steps),))
            kept = found.least > best[owner] - _MARGIN / sharpness
            owner, delta, value = owner[kept], found.delta[kept], found.least[kept]
            good = found.miss[kept] < _CLOSE
        order = np.argsort(-np.where(good, value, -np.inf), kind="stable")
        first, place = np.unique(owner[order], return_index=True)
        top = order[place]
        self._keep(which[first], delta[top], np.where(good[top], value[top], -np.inf))

    def _keep(self, which: np.ndarray, delta: np.ndarray, value: np.ndarray) -> None:
        gain = np.where(value > -np.inf, value, 0.0) - self.value[which]
        better = (value > -np.inf) & (gain > 0)
        which, delta, value = which[better], delta[better], value[better]
        pairs = [(which, delta)]
        if self.mirrored:
            pairs.append((self.size - 1 - which, delta + np.pi))
        for place, angles in pairs:
            self.best[place], self.value[place] = angles, value
            self.fresh[place] |= gain[better] > _GAIN
