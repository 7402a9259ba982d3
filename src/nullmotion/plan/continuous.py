"""Knots of any value: gradient ascent on the smoothed value, then evolution on the true one.

The discrete optimum, resampled to more knots, perturbed and turned over, and random curves
climb the smoothed value together (`ascent`). The best of them, the discrete optimum and
curves that are drawn anew are where populations of an evolution strategy begin
(`evolution`), which see the true value, counts and all. Nothing is proven.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from nullmotion.plan.ascent import STEPS, ascend
from nullmotion.plan.best import Progress
from nullmotion.plan.evolution import Evolution
from nullmotion.plan.result import Found
from nullmotion.plan.rollout import Rollouts
from nullmotion.plan.smooth import SmoothValue

EVALUATIONS = 250_000  # whole runs for the evolution
_STARTS = 32
_POPULATIONS, _SIZE = 4, 64
_CLIMB = 0.3  # of the progress


def search(
    rollouts: Rollouts,
    start: np.ndarray,
    length: int = 20,
    *,
    seed: int = 0,
    seconds: float = 10.0,
    evaluations: int = EVALUATIONS,
    progress: Progress | None = None,
) -> Found:
    """Return the best course of ``length`` knots within -1 and 1 that was found.

    It is never worse than ``start`` or no null motion: if it were, that is returned. The
    same seed and number of evaluations give the same course, unless the clock ends the
    search, which is said. Ctrl-C ends it with the best so far.

    Args:
        rollouts: The manoeuvre and the cost, with any number of knots.
        start: A course to start from, of any number of knots: the discrete optimum.
        length: Number of knots.
        seed: Of what is drawn at random.
        seconds: Time at which the search ends in any case.
        evaluations: Number of runs on the true value.
        progress: Called with the finished share.
    """
    hunt = _Hunt(rollouts, np.asarray(start, float), length, seed, time.monotonic() + seconds)
    try:
        hunt.climb(lambda share: progress(_CLIMB * share) if progress else None)
        hunt.evolve(
            evaluations, lambda x: progress(_CLIMB + (1 - _CLIMB) * x) if progress else None
        )
    except TimeoutError:
        hunt.remarks.append(f"ended by the clock after {seconds:g} s: it may not repeat exactly")
    except KeyboardInterrupt:
        hunt.remarks.append("interrupted: the best course so far")
    return hunt.found()


class _Hunt:
    """One search: the best course so far and what it cost."""

    def __init__(
        self, rollouts: Rollouts, start: np.ndarray, length: int, seed: int, end: float
    ) -> None:
        self.start, self.end, self.rng = start, end, np.random.default_rng(seed)
        self.given = of_depth(rollouts, len(start))
        self.rollouts = of_depth(rollouts, length)
        self.remarks: list[str] = []
        self.runs, self.lanes = 0, 0
        self.knots, self.value = np.zeros(length), -np.inf
        resampled = resample(start, length, rollouts.steps)
        self.sources = np.array([*resampled, *-resampled])
        values = self.values(np.array([np.zeros(length), *self.sources]))
        self.discrete = float(self.given.values(start[None])[0])
        self.source = self.sources[int(np.argmax(values[1:]))]
        self.certificate = {"start_value": self.discrete, "resampled_value": values[1:].max()}
        self.climbed = np.empty((0, length))

    def values(self, knots: np.ndarray) -> np.ndarray:
        """Return the true values of courses and keep the best."""
        if time.monotonic() > self.end:
            raise TimeoutError
        values = self.rollouts.values(knots)
        self.runs += len(knots)
        i = int(np.argmax(values))
        if values[i] > self.value:
            self.value, self.knots = float(values[i]), knots[i].copy()
        return values

    def climb(self, report: Callable[[float], None]) -> None:
        """Climb the smoothed value from all starts; keep the best course of each."""
        smooth = SmoothValue(self.rollouts)
        count = _STARTS - len(self.sources)
        knots = [*self.sources, *[self.drawn(0.3 if i % 2 else None) for i in range(count)]]
        best = np.array(knots)
        values = self.values(best)

        def visit(step: int, reached: np.ndarray) -> None:
            self.lanes += reached.size
            found = self.values(reached)
            better = found > values
            best[better], values[better] = reached[better], found[better]
            report(step / STEPS)

        try:
            ascend(smooth, best.copy(), visit)
        finally:
            self.climbed = best[np.argsort(-values, kind="stable")]
            self.certificate["gradient_value"] = float(values.max())

    def drawn(self, sigma: float | None) -> np.ndarray:
        """Return the resampled course changed at random, or a random curve of few knots."""
        length = len(self.knots)
        if sigma is not None:
            return np.clip(self.source + sigma * self.rng.standard_normal(length), -1.0, 1.0)
        few = self.rng.uniform(-1.0, 1.0, self.rng.integers(2, length + 1) if length > 1 else 1)
        return np.interp(np.linspace(0.0, 1.0, length), np.linspace(0.0, 1.0, len(few)), few)

    def evolve(self, evaluations: int, report: Callable[[float], None]) -> None:
        """Let populations evolve side by side; one that has settled begins anew elsewhere."""
        end, first, born = self.runs + evaluations, self.runs, 0
        populations: list[Evolution] = []
        while self.runs < end:
            populations = [p for p in populations if not p.settled]
            while len(populations) < _POPULATIONS:
                populations.append(self.population(born))
                born += 1
            values = self.values(np.concatenate([p.ask() for p in populations]))
            for i, each in enumerate(populations):
                each.tell(values[i * _SIZE : (i + 1) * _SIZE])
            report(min(1.0, (self.runs - first) / evaluations))
        self.certificate["populations"] = born

    def population(self, number: int) -> Evolution:
        """Return where a population begins."""
        turn = number % 4
        if turn == 0:
            mean, sigma = self.knots, (0.02, 0.1)[number // 4 % 2]
        elif turn == 1:
            mean, sigma = self.source, 0.3
        elif turn == 2:
            mean, sigma = self.climbed[min(number // 4, len(self.climbed) - 1)], 0.1
        else:
            mean, sigma = self.drawn(None), 0.5
        seed = self.rng.integers(2**63)
        return Evolution(mean.copy(), sigma, np.random.default_rng(seed), _SIZE)

    def found(self) -> Found:
        """Return the best course, or the one to start from if that is no worse."""
        knots, value = self.knots, self.value
        if self.discrete >= value:
            knots, value = self.start, self.discrete
            self.remarks.append("nothing better than the course to start from was found")
        certificate = self.certificate | {"evaluations": self.runs, "gradient_lanes": self.lanes}
        course = tuple(float(k) + 0.0 for k in knots)
        runs = float(self.runs + self.lanes)
        return Found(course, value, False, runs, certificate=certificate, remarks=self.remarks)


def of_depth(rollouts: Rollouts, depth: int) -> Rollouts:
    """Return the same manoeuvre with another number of knots."""
    if depth == rollouts.depth:
        return rollouts
    setup = replace(rollouts.setup, law=rollouts.base)
    return Rollouts(setup, rollouts.cost, depth, rollouts.k_max, rollouts.lag, rollouts.threads)


def resample(knots: np.ndarray, length: int, steps: int) -> np.ndarray:
    """Return courses of another length that come near to one, (2, length).

    One takes the curve's values at the new knots, the other is the nearest in the mean
    square over the samples.
    """
    place = np.arange(steps) / steps
    old, new = np.linspace(0.0, 1.0, len(knots)), np.linspace(0.0, 1.0, length)
    hats = np.array([np.interp(place, new, unit) for unit in np.eye(length)]).T
    curve = np.interp(place, old, knots)
    nearest = np.linalg.lstsq(hats, curve, rcond=None)[0]
    return np.array([np.interp(new, old, knots), np.clip(nearest, -1.0, 1.0)])
