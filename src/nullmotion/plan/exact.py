"""Branch and bound: the best course of all, with proof.

The tree is searched deepest first, in each depth by the best bound first. That is a beam at
first, so that a good course is there at once; from then on most nodes are cut off.
"""

from __future__ import annotations

import contextlib
import time

import numpy as np

from nullmotion.plan.best import INTERRUPTED, Progress
from nullmotion.plan.frontier import Frontier
from nullmotion.plan.result import Found, Knots
from nullmotion.plan.rollout import Rollouts

_LANES = 768  # children grown at once
_REPORT = 0.1  # seconds


def search(
    rollouts: Rollouts,
    levels: int = 3,
    *,
    most_ties: int = 1000,
    time_limit: float | None = None,
    progress: Progress | None = None,
    lanes: int = _LANES,
) -> Found:
    """Return the best course whose knots take ``levels`` values from -k_max to k_max.

    A node is cut off when its bound is below the best value found by more than one part in
    1e9. Every course is then either evaluated or below a node cut off: the counts in the
    certificate add up to levels^depth, and no bound of a node cut off exceeds the optimum.
    Ctrl-C and the time limit end the search early with the best so far, not proven.

    Args:
        rollouts: The manoeuvre.
        levels: Values of a knot, an odd number.
        most_ties: Number of courses of the same value to keep; beyond that, nodes that only
            promise more of them are cut off.
        time_limit: Seconds.
        progress: Called with the share of courses that are settled.
        lanes: Nodes that grow in one batch.
    """
    zero = np.zeros((1, rollouts.depth))
    baseline = float(rollouts.values(zero)[0])
    work = Frontier(rollouts, levels, most_ties, baseline, lanes)
    complete, remarks = False, [INTERRUPTED]
    with contextlib.suppress(KeyboardInterrupt):
        complete = _run(work, time_limit, progress)
        remarks = [] if complete else [f"ended after {time_limit:g} s: the best so far, not proven"]
    ranked = work.best.ranked()
    if not work.best.complete:
        best = calmer(rollouts, ranked[0], work.best.least)
        ranked = [best, *(knots for knots in ranked if knots != best)]
    found = Found(
        ranked[0],
        work.best.value,
        complete,
        work.tree.steps / rollouts.steps + 1.0,
        ranked[1:],
        complete and work.best.complete,
        work.certificate(),
        remarks,
    )
    found.certificate["segments_simulated"] = work.tree.segments + rollouts.segments
    return found


def calmer(rollouts: Rollouts, knots: Knots, least: float) -> Knots:
    """Return a course without the null motion that does not raise its value above ``least``."""
    course = np.array(knots)
    for i in reversed(range(len(course))):
        tried = course * (np.arange(len(course)) != i)
        if rollouts.values(tried)[0] >= least:
            course = tried
    return tuple(float(k) + 0.0 for k in course)


def _run(work: Frontier, time_limit: float | None, progress: Progress | None) -> bool:
    begin = told = time.monotonic()
    if work.tree.depth == 1:
        work.whole()
    while work.step():
        now = time.monotonic()
        if progress and now - told > _REPORT:
            told = now
            progress(work.settled / work.tree.size)
        if time_limit is not None and now - begin > time_limit:
            return False
    return True
