"""Design of a bias: several climbs, the best of them refined."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from nullmotion.errors import InputError
from nullmotion.guarantee.constraint import Constraint
from nullmotion.guarantee.design.climb import PENALTY, Climb
from nullmotion.guarantee.design.envelope import bias_bounds, greatest_envelope, nearest_bias
from nullmotion.guarantee.design.family import Family
from nullmotion.guarantee.design.goal import Goal
from nullmotion.guarantee.design.rays import part

_SPREAD = 0.4  # standard deviation of a start's coefficients
_REFINEMENTS = 2
_LARGE = 0.995  # of the greatest envelope, where it is the goal
_MISSED = 1e-7

Progress = Callable[[float], None]


@dataclass(frozen=True)
class Design:
    """What was found.

    Attributes:
        family: What was designed.
        degree: Degree of the polynomial.
        goal: What it is for.
        coefficients: One for each of the family's orbits.
        missed: Most that TC is below what the goal wants, at the samples.
        steps: Linear programs solved.
        scores: Of every start.
        interrupted: Whether it was stopped before it was done.
    """

    family: Family
    degree: int
    goal: Goal
    coefficients: np.ndarray
    missed: float
    steps: int
    scores: tuple[float, ...]
    interrupted: bool = False

    @property
    def constraint(self) -> Constraint:
        """The constraint with these coefficients."""
        return self.family.make(self.degree, self.coefficients)


def design(
    family: Family,
    goal: Goal,
    degree: int = 2,
    *,
    starts: int = 3,
    limit: int = 60,
    seed: int = 0,
    progress: Progress | None = None,
) -> Design:
    """Return the best bias found for a goal; when interrupted, the best so far.

    Args:
        family: The planes.
        goal: What is wanted.
        degree: Degree of Psi in X, Y and Z.
        starts: Starts, the first of them a product of parabolas.
        limit: Most steps from each.
        seed: Of the starts' random changes.
        progress: Told the finished share.

    Raises:
        InputError: For a degree, starts or steps out of range, or an envelope that no bias of
            the degree has.
    """
    for key, value, least in (("starts", starts, 1), ("limit", limit, 1), ("seed", seed, 0)):
        if value < least:
            raise InputError(key, value, f"a whole number from {least}")
    climb = Climb(family, degree, goal, _envelope(family, degree, goal))
    random, scores, interrupted = np.random.default_rng(seed), [], False
    tell = progress or (lambda share: None)
    try:
        for k in range(starts):
            noise = _SPREAD * random.normal(size=len(climb.best)) if k else 0.0
            scores.append(climb.climb(family.start(degree) + noise, limit))
            tell((k + 1) / (starts + _REFINEMENTS))
        for k in range(_REFINEMENTS):
            climb.refine(limit)
            tell((starts + k + 1) / (starts + _REFINEMENTS))
    except KeyboardInterrupt:
        if not np.isfinite(climb.score):
            raise
        interrupted = True
    missed = climb.samples.measure(climb.best, PENALTY).missed
    found = climb.best, missed, climb.steps, tuple(scores), interrupted
    return Design(family, degree, goal, *found)


def _envelope(family: Family, degree: int, goal: Goal) -> float:
    """Return the radius to be kept free of singularity, if a bias can do so."""
    directions, _ = part(family)
    if goal.envelope is None:
        return _LARGE * greatest_envelope(family, degree, directions)
    bounds = bias_bounds(family, degree, directions, goal.envelope)
    if nearest_bias(family.start(degree), bounds)[1] < -_MISSED:
        best = greatest_envelope(family, degree, directions)
        raise InputError("envelope", goal.envelope, f"at most {best:.4f} with degree {degree}")
    return goal.envelope
