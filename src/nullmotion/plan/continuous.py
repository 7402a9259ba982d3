"""Knots of any value: gradient ascent on the smoothed value, then evolution on the true one.

The discrete optimum, resampled to more knots and turned over, courses near it and random
curves climb the smoothed value together (`ascent`). The best of them, the discrete optimum
and random curves are where populations of an evolution strategy begin (`evolution`), which
see the true value, counts and all. Nothing is proven.

With 20 knots the gradient alone finds 90 to 98 % of what both find together on the paper's
manoeuvres and evolution alone finds all of it; with 70 knots evolution alone comes to 58 to
100 %, the gradient to 95 to 98 %: design/plan_continuous.py.
"""

from __future__ import annotations

import time

import numpy as np

from nullmotion.plan.best import INTERRUPTED, Progress
from nullmotion.plan.hunt import Hunt
from nullmotion.plan.result import Found
from nullmotion.plan.rollout import Rollouts

LENGTH = 20
EVALUATIONS = 150_000  # runs for the evolution
_CLIMB = 0.4  # of the progress
_PRESSED = 0.6  # of the time: where the clock ends the climb


def search(
    rollouts: Rollouts,
    start: np.ndarray,
    length: int | None = None,
    *,
    seed: int = 0,
    seconds: float = 10.0,
    evaluations: int = EVALUATIONS,
    progress: Progress | None = None,
) -> Found:
    """Return the best course found whose knots lie anywhere between -1 and 1.

    It is never worse than ``start`` or no null motion. The same seed and number of
    evaluations give the same course, unless the clock ends the search, which is said.
    Ctrl-C ends it with the best so far.

    Args:
        rollouts: The manoeuvre and the cost, with any number of knots.
        start: A course to start from, of any number of knots: the discrete optimum.
        length: Number of knots; by default 20, more if the start has more, fewer if the run
            has fewer steps.
        seed: Of what is drawn at random.
        seconds: Time after which the search ends in any case.
        evaluations: Number of runs for the evolution.
        progress: Called with the finished share.
    """
    end = time.monotonic() + seconds
    given = np.asarray(start, float)
    knots = min(max(LENGTH, len(given)), rollouts.steps + 1) if length is None else length
    hunt = Hunt(rollouts, given, knots, seed)

    def report(share: float) -> None:
        if progress:
            progress(share)

    try:
        hunt.climb(end - (1.0 - _PRESSED) * seconds, lambda share: report(_CLIMB * share))
        hunt.evolve(evaluations, end, lambda share: report(_CLIMB + (1.0 - _CLIMB) * share))
    except KeyboardInterrupt:
        hunt.remarks.append(INTERRUPTED)
    return hunt.found()
