"""A* over the steps of a ground.

Nodes are taken in the order of f = g + h: g the least cost known from the start, h a lower bound
of the cost to go. With h = (least cost of any step) x (least number of steps), which never falls
by more than the cost of a step, the first path to reach a goal is the best one.
"""

from __future__ import annotations

import heapq
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

Progress = Callable[[float], None]
_EVERY = 256  # nodes between two calls of `progress`


class Found(NamedTuple):
    """What a search leaves.

    Attributes:
        nodes: Nodes of the best path, start and goal included; empty if there is none.
        cost: Its cost; inf if there is none.
        costs: Least cost to each node as far as known, (n,); inf if never reached.
        expanded: Number of nodes that were taken.
    """

    nodes: list[int]
    cost: float
    costs: np.ndarray
    expanded: int


def shortest(
    following: np.ndarray,
    weights: np.ndarray,
    start: int,
    goals: np.ndarray,
    least_steps: np.ndarray,
    progress: Progress | None = None,
) -> Found:
    """Return the best path from a node to the nearest of some goals.

    Args:
        following: Successors of each node, (n, k); -1 for none.
        weights: Cost of each step, 0 or more, (n, k); inf where refused.
        start: Where to begin.
        goals: Whether a node is a goal, (n,).
        least_steps: Least number of steps to a goal, (n,).
        progress: Called with the share of the way that has been searched.
    """
    made = np.isfinite(weights) & (following >= 0)
    bound = (weights[made].min() if made.any() else 0.0) * least_steps
    ahead = [
        [(int(j), float(w)) for j, w, ok in zip(*row, strict=True) if ok]
        for row in zip(following, weights, made, strict=True)
    ]
    costs = np.full(len(following), np.inf)
    costs[start] = 0.0
    before = {start: -1}
    done: set[int] = set()
    queue = [(float(bound[start]), start)]
    nearest, whole = float(bound[start]), float(bound[start]) or 1.0
    while queue:
        node = heapq.heappop(queue)[1]
        if node in done:
            continue
        done.add(node)
        if goals[node]:
            return Found(_way(before, node), float(costs[node]), costs, len(done))
        for after, weight in ahead[node]:
            cost = costs[node] + weight
            if cost < costs[after]:
                costs[after], before[after] = cost, node
                heapq.heappush(queue, (float(cost + bound[after]), after))
        nearest = min(nearest, float(bound[node]))
        if progress and len(done) % _EVERY == 0:
            progress(1.0 - nearest / whole)
    return Found([], np.inf, costs, len(done))


def _way(before: dict[int, int], node: int) -> list[int]:
    nodes = [node]
    while before[nodes[-1]] >= 0:
        nodes.append(before[nodes[-1]])
    return nodes[::-1]
