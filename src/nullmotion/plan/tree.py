"""The tree of all courses whose knots take given levels, grown a batch of nodes at a time.

A node of depth d is a choice of the first d knots; d - 1 segments are then known. A leaf has
all knots.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nullmotion.errors import InputError
from nullmotion.plan.block import Block
from nullmotion.plan.rollout import Rollouts


def grid(levels: int) -> np.ndarray:
    """Return the values of a knot in units of k_max: ``levels`` from -1 to 1, 0 among them."""
    whole = isinstance(levels, (int, np.integer)) and not isinstance(levels, bool)
    if not whole or not (levels >= 3 and levels % 2 == 1 and levels < 1000):
        raise InputError("levels", levels, "an odd number from 3 to 999, so that 0 is one of them")
    found: np.ndarray = np.arange(1 - levels, levels, 2) / (levels - 1)
    return found


@dataclass
class Nodes:
    """Nodes of one depth.

    Attributes:
        block: Their states, where segments are known.
        choices: Index of the level of each knot, (nodes, depth of the tree).
        totals: Totals of the cost's terms so far, (terms, nodes).
        count: Number of nodes.
    """

    block: Block
    choices: np.ndarray
    totals: np.ndarray
    count: int = 0


class Tree:
    """Grows nodes.

    Args:
        rollouts: The manoeuvre.
        levels: Values of a knot.
        batch: Parents that grow at once.

    Attributes:
        size: Number of leaves.
        steps: Run-steps simulated.
        segments: Segments simulated.
    """

    def __init__(self, rollouts: Rollouts, levels: int, batch: int) -> None:
        """Reserve memory: one batch of children for each depth."""
        self.rollouts, self.levels, self.depth = rollouts, levels, rollouts.depth
        self.grid, self.batch = grid(levels), batch
        self.size = levels**self.depth
        self.steps, self.segments = 0, 0
        children = batch * levels
        self._digit = np.tile(np.arange(levels, dtype=np.int16), batch)
        self._end = self.grid[self._digit]
        self.nodes = [
            Nodes(
                rollouts.block(children),
                np.zeros((children, self.depth), np.int16),
                np.zeros((rollouts.terms, children)),
            )
            for _ in range(self.depth)
        ]
        root = self.nodes[0]
        root.count = levels
        root.choices[:levels, 0] = np.arange(levels)

    def leaves(self, depth: int) -> int:
        """Return the number of leaves under a node."""
        return int(self.levels ** (self.depth - depth))

    def done(self, depth: int) -> int:
        """Return the number of samples that are known at a node."""
        return self.rollouts.edges[depth - 1] if depth < self.depth else self.rollouts.steps

    def at(self, depth: int) -> Nodes:
        """Return the nodes of a depth, from 1."""
        return self.nodes[depth - 1]

    def grow(self, depth: int, chosen: np.ndarray) -> Nodes:
        """Replace the nodes of depth + 1 by the children of chosen nodes and return them."""
        parents, children = self.at(depth), self.at(depth + 1)
        count, segment = len(chosen) * self.levels, depth - 1
        source = np.repeat(chosen, self.levels)
        if segment:
            children.block.state[:, :count] = parents.block.state.take(source, axis=1)
        children.choices[:count, :depth] = parents.choices[source, :depth]
        children.choices[:count, depth] = self._digit[:count]
        a = self.grid[parents.choices[source, depth - 1]]
        totals = self.rollouts.advance(children.block, segment, count, a, self._end[:count])
        children.totals[:, :count] = totals
        children.count = count
        edges = self.rollouts.edges
        self.steps += count * (edges[segment + 1] - edges[segment])
        self.segments += count
        return children
