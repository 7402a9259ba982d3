"""A hunt for the best course: what it begins with, the climb, the evolution, the best so far."""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np

from nullmotion.errors import TraceError
from nullmotion.plan.ascent import STEPS, ascend
from nullmotion.plan.curves import random_curve, resample, shaken
from nullmotion.plan.evolution import Evolution
from nullmotion.plan.result import Found
from nullmotion.plan.rollout import Rollouts
from nullmotion.plan.smooth import SmoothValue

_STARTS = 12
_POPULATIONS, _SIZE = 4, 64


class Hunt:
    """One search: the best course so far, and what it took."""

    def __init__(self, rollouts: Rollouts, start: np.ndarray, length: int, seed: int) -> None:
        self.start, self.length, self.rng = start, length, np.random.default_rng(seed)
        self.rollouts = rollouts if length == rollouts.depth else rollouts.of_depth(length)
        self.remarks: list[str] = []
        self.runs, self.lanes = 0, 0
        self.knots, self.value = np.zeros(length), -np.inf
        alike = resample(start, length, rollouts.steps)
        self.sources = np.array([*alike, *-alike])
        values = self.values(np.array([np.zeros(length), *self.sources]))[1:]
        self.source = self.sources[int(np.argmax(values))]
        self.climbed = self.sources[np.argsort(-values, kind="stable")]
        own = rollouts if len(start) == rollouts.depth else rollouts.of_depth(len(start))
        self.before = float(own.values(start)[0])
        self.certificate = {"start_value": self.before, "resampled_value": float(values.max())}

    def values(self, knots: np.ndarray) -> np.ndarray:
        """Return the true values of courses and keep the best."""
        values = self.rollouts.values(knots)
        self.runs += len(knots)
        i = int(np.argmax(values))
        if values[i] > self.value:
            self.value, self.knots = float(values[i]), knots[i].copy()
        return values

    def late(self, end: float) -> bool:
        """Return whether the clock ends a part of the search, and say so."""
        late = time.monotonic() > end
        if late:
            self.remarks.append("the clock ended the search: it may not repeat exactly")
        return late

    def climb(self, end: float, report: Callable[[float], None]) -> None:
        """Climb the smoothed value from all starts; keep the best course of each."""
        try:
            smooth = SmoothValue(self.rollouts)
        except TraceError as error:
            self.remarks.append(f"no gradient: {error}")
            return
        others = range(_STARTS - len(self.sources))
        best = np.array([*self.sources, *[self._drawn(i % 2 == 0) for i in others]])
        values = self.values(best)

        def visit(step: int, reached: np.ndarray) -> bool:
            self.lanes += reached.size
            found = self.values(reached)
            better = found > values
            best[better], values[better] = reached[better], found[better]
            self.climbed = best[np.argsort(-values, kind="stable")]
            self.certificate["gradient_value"] = float(values.max())
            report(step / STEPS)
            return not self.late(end)

        ascend(smooth, best.copy(), visit)

    def _drawn(self, near: bool) -> np.ndarray:
        if near:
            return shaken(self.source, 0.3, self.rng)
        return random_curve(self.length, self.rng)

    def evolve(self, evaluations: int, end: float, report: Callable[[float], None]) -> None:
        """Let populations evolve side by side; where one has settled, another begins."""
        first, born = self.runs, 0
        populations: list[Evolution] = []
        while self.runs < first + evaluations and not self.late(end):
            populations = [p for p in populations if not p.settled]
            while len(populations) < _POPULATIONS:
                populations.append(self._population(born))
                born += 1
            values = self.values(np.concatenate([p.ask() for p in populations]))
            for each, mine in zip(populations, np.split(values, _POPULATIONS), strict=True):
                each.tell(mine)
            report(min(1.0, (self.runs - first) / evaluations))

    def _population(self, number: int) -> Evolution:
        """Return where a population begins: at the best, the source, a climber or anywhere."""
        turn, kind = divmod(number, 4)
        mean, sigma = (
            (self.knots, (0.02, 0.1)[turn % 2]),
            (self.source, 0.3),
            (self.climbed[min(turn, len(self.climbed) - 1)], 0.1),
            (random_curve(self.length, self.rng), 0.5),
        )[kind]
        rng = np.random.default_rng(self.rng.integers(2**63))
        return Evolution(mean.copy(), sigma, rng, _SIZE)

    def found(self) -> Found:
        """Return the best course, or the one to start from if that is as good."""
        knots, value = self.knots, self.value
        if self.before >= value:
            knots, value = self.start, self.before
            self.remarks.append("nothing better than the course to start from was found")
        counts = {"evaluations": self.runs, "gradient_lanes": self.lanes}
        return Found(
            tuple(float(k) + 0.0 for k in knots),
            value,
            False,
            float(self.runs + self.lanes),
            ties_complete=False,
            certificate=self.certificate | counts,
            remarks=list(dict.fromkeys(self.remarks)),
        )
