"""Where a branch and bound search stands."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from nullmotion.plan.best import TIE, Best
from nullmotion.plan.rollout import Rollouts
from nullmotion.plan.tree import Nodes, Tree

_FIRST = 96  # children grown at once before the first leaf


@dataclass
class _Open:
    """Nodes of one depth that are still to grow, the best bound first."""

    order: np.ndarray = field(default_factory=lambda: np.empty(0, int))
    bounds: np.ndarray = field(default_factory=lambda: np.empty(0))


class Frontier:
    """The nodes that are still to grow, the best courses so far, and what was cut off."""

    def __init__(
        self, rollouts: Rollouts, levels: int, most_ties: int, baseline: float, lanes: int
    ) -> None:
        self.rollouts, self.lanes = rollouts, lanes
        self.tree = Tree(rollouts, levels, max(1, lanes // levels))
        self.best = Best(baseline, rollouts.depth, most_ties)
        self.open = [_Open() for _ in range(rollouts.depth)]
        self.open[0] = _Open(np.arange(levels), np.full(levels, np.inf))
        self.pruned = [0] * rollouts.depth  # nodes cut off, by depth
        self.greatest = -np.inf  # of the bounds of nodes cut off
        self.leaves = 0

    @property
    def settled(self) -> int:
        """Number of courses that are evaluated or cut off."""
        tree = self.tree
        return self.leaves + sum(c * tree.leaves(d + 1) for d, c in enumerate(self.pruned))

    def step(self) -> bool:
        """Grow a batch of nodes; return whether any were left."""
        depth = next((d for d in range(len(self.open), 0, -1) if len(self.open[d - 1].order)), 0)
        if not depth:
            return False
        chosen = self._taken(depth)
        if len(chosen):
            children = self.tree.grow(depth, chosen)
            if depth + 1 == self.tree.depth:
                self._judge(children)
            else:
                self._queue(depth + 1, children)
        return True

    def _taken(self, depth: int) -> np.ndarray:
        """Take the best nodes off a depth, having cut off those that are hopeless by now."""
        nodes = self.open[depth - 1]
        keep = self._cut(depth, nodes.bounds)
        order, bounds = nodes.order[keep], nodes.bounds[keep]
        count = (self.lanes if self.leaves else min(_FIRST, self.lanes)) // self.tree.levels
        count = max(count, 1)
        self.open[depth - 1] = _Open(order[count:], bounds[count:])
        return order[:count]

    def _cut(self, depth: int, bounds: np.ndarray) -> np.ndarray:
        """Count the nodes that are hopeless; return which are not."""
        hopeless = self.best.hopeless(bounds)
        count = int(np.count_nonzero(hopeless))
        if count:
            self.pruned[depth - 1] += count
            self.greatest = max(self.greatest, float(bounds[hopeless].max()))
        return ~hopeless

    def _queue(self, depth: int, nodes: Nodes) -> None:
        tree, rollouts = self.tree, self.rollouts
        totals = nodes.totals[:, : nodes.count]
        bounds = rollouts.bounds(totals, tree.done(depth))
        left = np.flatnonzero(self._cut(depth, bounds))
        order = left[np.argsort(-bounds[left], kind="stable")]
        self.open[depth - 1] = _Open(order, bounds[order])

    def _judge(self, nodes: Nodes) -> None:
        totals = nodes.totals[:, : nodes.count]
        self.leaves += nodes.count
        values = self.rollouts.judged(totals)
        self.best.offer(values, lambda i: self.tree.grid[nodes.choices[i]])

    def whole(self) -> None:
        """Evaluate the courses of one knot, in which there is nothing to share."""
        knots = self.tree.grid[:, None]
        self.open[0] = _Open()
        self.leaves = self.tree.levels
        self.tree.steps = self.leaves * self.rollouts.steps
        self.best.offer(self.rollouts.values(knots), lambda i: knots[i])

    def certificate(self) -> dict[str, Any]:
        """Return the proof in numbers."""
        value, tree = self.best.value, self.tree
        return {
            "sequences": tree.size,
            "leaves_evaluated": self.leaves,
            "pruned_subtrees": sum(self.pruned),
            "pruned_subtrees_by_depth": list(self.pruned),
            "pruned_sequences": self.settled - self.leaves,
            "largest_pruned_bound": self.greatest,
            "optimum": value,
            "tolerance": TIE * abs(value),
        }
