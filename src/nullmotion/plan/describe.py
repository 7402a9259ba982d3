"""What was found, beside what it was found for."""

from __future__ import annotations

import dataclasses

import numpy as np

from nullmotion.plan.result import Found, PlanResult
from nullmotion.plan.rollout import Rollouts


def described(rollouts: Rollouts, found: Found, method: str) -> PlanResult:
    """Return what was found beside what it was found for."""
    cost, steps = rollouts.cost, rollouts.steps
    zero = np.zeros(rollouts.depth)
    start = rollouts.setup.delta
    delta = np.array([start, start if found.delta is None else found.delta])
    totals = rollouts.totals(np.array([zero, found.knots]), delta)
    baseline, own = totals[:, 0], totals[:, 1]
    parts = [{k: float(v) for k, v in cost.parts(t, steps).items()} for t in (baseline, own)]
    result = PlanResult(
        **{f.name: getattr(found, f.name) for f in dataclasses.fields(Found)},
        method=method,
        baseline_value=float(cost.value(baseline, steps)),
        depth=rollouts.depth,
        k_max=rollouts.k_max,
        duration_s=rollouts.duration,
        lag=rollouts.lag,
        law=rollouts.base.name,
        cost=cost.name,
        cost_parameters=dataclasses.asdict(cost),
        parts=parts[1],
        baseline_parts=parts[0],
    )
    result.remarks = [*result.remarks, *cost.remarks(own, steps)]
    return result
