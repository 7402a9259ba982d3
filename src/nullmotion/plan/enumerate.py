"""All courses of the tree, one by one: what branch and bound is checked against."""

from __future__ import annotations

import numpy as np

from nullmotion.errors import InputError
from nullmotion.plan.best import INTERRUPTED, Best, Progress
from nullmotion.plan.result import Found
from nullmotion.plan.rollout import Rollouts
from nullmotion.plan.tree import Tree, grid

MOST = 20_000_000  # courses
_LANES = 2187  # nodes of one depth kept at once


def search(
    rollouts: Rollouts,
    levels: int = 3,
    *,
    shared: bool = True,
    most_ties: int = 1000,
    progress: Progress | None = None,
) -> Found:
    """Return the best of all levels^depth courses.

    Args:
        rollouts: The manoeuvre.
        levels: Values of a knot, an odd number.
        shared: Simulate what courses have in common once.
        most_ties: Number of courses of the same value to keep.
        progress: Called with the finished share.

    Raises:
        InputError: For more than 20 million courses.
    """
    work = _Enumeration(rollouts, levels, shared, progress)
    complete = False
    try:
        work.run()
        complete = True
    except KeyboardInterrupt:
        pass
    baseline = float(rollouts.values(np.zeros((1, rollouts.depth)))[0])
    best = Best(baseline, rollouts.depth, most_ties)
    best.offer(work.values, lambda i: course(i, rollouts.depth, levels))
    ranked = best.ranked()
    evaluated = int(np.count_nonzero(~np.isnan(work.values)))
    return Found(
        ranked[0],
        best.value,
        complete,
        work.steps / rollouts.steps + 1.0,
        ranked[1:],
        complete and best.complete,
        {
            "sequences": len(work.values),
            "leaves_evaluated": evaluated,
            "pruned_sequences": 0,
            "optimum": best.value,
        },
        [] if complete else [INTERRUPTED],
    )


def all_values(rollouts: Rollouts, levels: int = 3, *, shared: bool = True) -> np.ndarray:
    """Return the value of every course, (levels^depth,), in the order of `course`."""
    work = _Enumeration(rollouts, levels, shared, None)
    work.run()
    return work.values


def course(index: np.ndarray, depth: int, levels: int) -> np.ndarray:
    """Return the knots of courses by their place in the order of all, (courses, depth).

    The order is that of the knots, from -1 up, the last knot changing fastest.
    """
    found: np.ndarray = grid(levels)[
        (np.asarray(index)[:, None] // _weights(depth, levels)) % levels
    ]
    return found


def _weights(depth: int, levels: int) -> np.ndarray:
    return np.array([levels**i for i in range(depth - 1, -1, -1)], np.int64)


class _Enumeration:
    """Values of all courses; NaN where not evaluated yet."""

    def __init__(
        self, rollouts: Rollouts, levels: int, shared: bool, progress: Progress | None
    ) -> None:
        grid(levels)  # refuses what is no number of levels
        size = levels**rollouts.depth
        if size > MOST:
            allowed = f"at most {MOST} courses (here {levels}^{rollouts.depth})"
            raise InputError("depth", rollouts.depth, allowed)
        self.rollouts, self.levels, self.progress = rollouts, levels, progress
        self.shared = shared and rollouts.depth > 1
        self.values, self.steps = np.full(size, np.nan), 0

    def run(self) -> None:
        """Evaluate all."""
        if self.shared:
            self._grow()
            return
        knots = course(np.arange(len(self.values)), self.rollouts.depth, self.levels)
        self.values[:] = self.rollouts.values(knots)
        self.steps = len(knots) * self.rollouts.steps

    def _grow(self) -> None:
        rollouts, levels = self.rollouts, self.levels
        tree = Tree(rollouts, levels, max(1, _LANES // levels))
        place = _weights(tree.depth, levels)
        waiting = [np.empty(0, int) for _ in range(tree.depth)]
        waiting[0] = np.arange(levels)
        while depth := next((d for d in range(tree.depth, 0, -1) if len(waiting[d - 1])), 0):
            chosen, rest = np.split(waiting[depth - 1], [tree.batch])
            waiting[depth - 1] = rest
            nodes = tree.grow(depth, chosen)
            self.steps = tree.steps
            if depth + 1 < tree.depth:
                waiting[depth] = np.arange(nodes.count)
                continue
            at = nodes.choices[: nodes.count] @ place
            self.values[at] = rollouts.judged(nodes.totals[:, : nodes.count])
            if self.progress:
                self.progress(float(at[-1] + 1) / len(self.values))
