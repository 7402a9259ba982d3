"""One sample's plan: the plan of the sample before improved, or a better new one."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from nullmotion import qp
from nullmotion.lookahead.planner import Planner, Task

_OTHER = 0.15  # momentum by which a plan misses its path when the command has turned
_BETTER = 0.95  # share of a plan's cost below which another one takes its place


class Plan(NamedTuple):
    """Configurations along a path.

    Attributes:
        place: Distance of the knots along the path in momentum, (N,).
        points: Gimbal angles at the knots [rad], (N, n).
        solution: The last program's, to start the next one from; None if it was not solved.
        lowest: Least sigma_min along it, before the last improvement.
        age: Samples since new plans were looked for.
        unsolved: Programs of this sample without a solution.
    """

    place: np.ndarray
    points: np.ndarray
    solution: qp.Solution | None
    lowest: float = 0.0
    age: int = 0
    unsolved: int = 0


class Search(NamedTuple):
    """How to look for a plan: see the parameters of the law `receding-horizon`."""

    solver: qp.Solver
    iterations: int
    renew_below: float
    renew_every: int


def shifted(plan: Plan, place: np.ndarray) -> np.ndarray:
    """Return the plan (N, n) at the places of a sample that begins where its first step ended."""
    at = place + plan.place[0]
    last = np.minimum(at, plan.place[-1])
    k = np.clip(np.searchsorted(plan.place, last) - 1, 0, len(place) - 2)
    share = (last - plan.place[k]) / (plan.place[k + 1] - plan.place[k])
    low, high = plan.points[k], plan.points[k + 1]
    found: np.ndarray = low + share[:, None] * (high - low)
    return found


def planned(planner: Planner, task: Task, before: Plan | None, how: Search) -> Plan:
    """Return the plan of this sample.

    Args:
        planner: Planner of the array.
        task: Where from and along which path.
        before: The plan of the sample before.
        how: How to look for it.
    """
    kept = None if before is None else _continued(planner, task, before, how)
    if kept is not None and (kept.lowest >= how.renew_below or kept.age < how.renew_every):
        return kept
    return _renewed(planner, task, kept, how)


def _continued(planner: Planner, task: Task, before: Plan, how: Search) -> Plan | None:
    """Return the improved plan of the sample before; None if it leads elsewhere."""
    points = shifted(before, task.path.place)
    found = planner.linearised(points, task)
    if found.miss.max() > _OTHER:
        return None
    start = Plan(task.path.place, points, before.solution, age=before.age + 1)
    return _improved(planner, task, start, how)


def _improved(planner: Planner, task: Task, plan: Plan, how: Search) -> Plan:
    points, solution, unsolved = plan.points, plan.solution, 0
    for _ in range(how.iterations):
        found = planner.linearised(points, task)
        points, answer = planner.improved(found, task, how.solver, solution)
        solution = answer if answer.solved else None
        unsolved += not answer.solved
    lowest = float(found.level.min())
    return plan._replace(points=points, solution=solution, lowest=lowest, unsolved=unsolved)


def _renewed(planner: Planner, task: Task, kept: Plan | None, how: Search) -> Plan:
    """Return the best of the plan there is and the better seed of either side, improved."""
    seeds = planner.seeds(task)
    costs = planner.costs(seeds, task)
    half = len(seeds) // 2
    picks = (int(np.argmin(costs[:half])), half + int(np.argmin(costs[half:])))
    start = kept.solution if kept else None
    plans = [_improved(planner, task, Plan(task.path.place, seeds[i], start), how) for i in picks]
    every = [kept._replace(age=0), *plans] if kept else plans
    costs = planner.costs(np.stack([p.points for p in every]), task)
    if kept:
        costs[0] *= _BETTER
    costs = np.where(np.isfinite(costs), costs, np.inf)
    best = every[int(np.argmin(costs))]
    return best._replace(unsolved=sum(p.unsolved for p in every))


def within(
    own: Planner, start: np.ndarray, point: np.ndarray, change: np.ndarray, limit: np.ndarray
) -> tuple[np.ndarray, float]:
    """Return a first point within the limits and the share of the momentum it gives.

    Args:
        own: Planner of the array.
        start: Gimbal angles now [rad], (n,).
        point: Gimbal angles after the sample [rad], (n,).
        change: Momentum that they are to give, (m,).
        limit: Greatest moves [rad], (n,).
    """
    momentum, share = own.momentum(start), 1.0
    for _ in range(3):
        excess = float((np.abs(point - start) / limit).max())
        if not excess > 1.0:
            return point, share
        share /= excess
        point = own.exact(start + (point - start) / excess, momentum + share * change)
    excess = max(1.0, float((np.abs(point - start) / limit).max()))
    return start + (point - start) / excess, share
