"""The paper's heuristic: leaves in order, of which more and more are skipped."""

from __future__ import annotations

import numpy as np

from nullmotion.errors import InputError
from nullmotion.plan.best import INTERRUPTED, TIE, Progress
from nullmotion.plan.enumerate import course
from nullmotion.plan.result import Found
from nullmotion.plan.rollout import Rollouts
from nullmotion.plan.tree import grid

STEP, MOST = 10, 250
_AHEAD = 64  # leaves evaluated at once, on the guess that none is better
_LARGEST = 2**62


def search(
    rollouts: Rollouts,
    levels: int = 3,
    *,
    step: int = STEP,
    most: int = MOST,
    progress: Progress | None = None,
) -> Found:
    """Return what the paper's variable search density finds.

    Leaves come in the order of their knots, -k_max first, the last knot changing fastest. A
    leaf that is no better than the best so far makes the number of leaves skipped after it
    grow by ``step``, up to ``most``; a better one resets it to 0. Nothing is proven, and what
    it finds may be worse than no null motion: then none is returned, and that is said.

    Args:
        rollouts: The manoeuvre.
        levels: Values of a knot, an odd number.
        step: Growth of the number of leaves skipped.
        most: Its limit (the paper's skip_th).
        progress: Called with the share of leaves passed.

    Raises:
        InputError: For a tree of more than 2^62 leaves.
    """
    grid(levels)  # refuses what is no number of levels
    if levels**rollouts.depth > _LARGEST:
        raise InputError("depth", rollouts.depth, "a tree of at most 2^62 leaves for this method")
    walk = _Walk(rollouts, levels, step, most)
    remarks = []
    try:
        while walk.place < walk.size:
            walk.go()
            if progress:
                progress(min(walk.place / walk.size, 1.0))
    except KeyboardInterrupt:
        remarks.append(INTERRUPTED)
    return _never_worse(rollouts, walk, remarks)


class _Walk:
    """Where the heuristic stands; only leaves that it looks at count as evaluated."""

    def __init__(self, rollouts: Rollouts, levels: int, step: int, most: int) -> None:
        self.rollouts, self.levels, self.step, self.most = rollouts, levels, step, most
        self.size = levels**rollouts.depth
        self.place, self.skip, self.count = 0, 0, 0
        self.value, self.knots = -np.inf, np.zeros(rollouts.depth)

    def go(self) -> None:
        """Pass leaves up to the next that is better, or a batch."""
        leaves = course(np.array(self._ahead()), self.rollouts.depth, self.levels)
        for leaf, found in zip(leaves, self.rollouts.values(leaves).tolist(), strict=True):
            better = found > self.value
            self.count += 1
            self.skip = 0 if better else min(self.skip + self.step, self.most)
            self.place += 1 + self.skip
            if better:
                self.value, self.knots = found, leaf
                return

    def _ahead(self) -> list[int]:
        """Return the leaves that come next as long as none is better."""
        found: list[int] = []
        place, skip = self.place, self.skip
        while place < self.size and len(found) < _AHEAD:
            found.append(place)
            skip = min(skip + self.step, self.most)
            place += 1 + skip
        return found


def _never_worse(rollouts: Rollouts, walk: _Walk, remarks: list[str]) -> Found:
    zero = (0.0,) * rollouts.depth
    baseline = float(rollouts.values(np.array([zero]))[0])
    own = tuple(float(k) for k in walk.knots)
    certificate = {
        "sequences": walk.size,
        "leaves_evaluated": walk.count,
        "heuristic_knots": list(own),
        "heuristic_value": walk.value,
    }
    if walk.value > baseline + TIE * abs(baseline):
        return Found(own, walk.value, False, float(walk.count), [], False, certificate, remarks)
    remarks.append("the heuristic's course is no better than no null motion, which is kept")
    return Found(zero, baseline, False, float(walk.count), [], False, certificate, remarks)
