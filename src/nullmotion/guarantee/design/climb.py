"""A sequence of linear programs in a trust region, and the best that any of them found."""

from __future__ import annotations

import numpy as np

from nullmotion.guarantee.design.envelope import bias_bounds, nearest_bias
from nullmotion.guarantee.design.family import Family
from nullmotion.guarantee.design.goal import Goal
from nullmotion.guarantee.design.linear import improved
from nullmotion.guarantee.design.samples import Measured, Samples
from nullmotion.guarantee.radius import guaranteed_radius

PENALTY = 100.0  # cost of a unit of TC that is missed: more than any reward for it
_FIRST, _LARGEST, _SMALLEST = 0.3, 2.0, 1e-4  # change of a coefficient
_GROWTH, _SHRINKAGE = 2.0, 0.35
_GAIN = 1e-7
_CLOSE = 1e-2  # first change where the start is nearly the best


class Climb:
    """Best coefficients so far.

    Each step is the best one to first order. It is taken if it is better in truth, and the
    region it may reach grows, else it shrinks. Where as many inequalities are active as
    there are coefficients, this converges as fast as Newton's method.

    Attributes:
        best: Coefficients, (n,).
        score: Their score; -inf before the first.
        steps: Linear programs solved.
    """

    def __init__(self, family: Family, degree: int, goal: Goal, radius: float) -> None:
        """Lay out samples and the bounds of an envelope."""
        self.family, self.degree, self.goal = family, degree, goal
        self.samples = Samples(family, degree, goal, radius)
        self.radius, self.steps, self.score = radius, 0, -np.inf
        self.best = family.start(degree)
        self._bound()

    def _bound(self) -> None:
        self.bounds = bias_bounds(self.family, self.degree, self.samples.directions, self.radius)

    def climb(self, start: np.ndarray, limit: int, size: float = _FIRST) -> float:
        """Improve a start and return its score."""
        c, _ = nearest_bias(start, self.bounds)
        now = self.measure(c)
        for _ in range(limit):
            found = improved(self.samples, self.bounds, c, now, size, PENALTY)
            self.steps += 1
            after = None if found is None else self.measure(found)
            if found is not None and after is not None and after.score > now.score + _GAIN:
                c, now, size = found, after, min(size * _GROWTH, _LARGEST)
            else:
                size *= _SHRINKAGE
            if size < _SMALLEST:
                break
        return now.score

    def measure(self, c: np.ndarray) -> Measured:
        """Return what coefficients reach; remember them if they are the best."""
        now = self.samples.measure(c, PENALTY)
        if now.score > self.score:
            self.score, self.best = now.score, c
        return now

    def refine(self, limit: int) -> None:
        """Add rays through the worst momenta that polished search finds; improve the best."""
        made = self.family.make(self.degree, self.best)
        levels = [0.0, *(t for t, _ in self.goal.radii)]
        self.samples.add(np.array([guaranteed_radius(made, t).momentum for t in levels]))
        self._bound()
        self.score = -np.inf  # the new rays tell more
        self.climb(self.best, limit, _CLOSE)
