"""Search for the best null motion of a manoeuvre, by any method."""

from __future__ import annotations

import dataclasses
import time
from collections.abc import Callable
from typing import Any

import numpy as np

from nullmotion.errors import InputError, UnknownNameError
from nullmotion.laws.follow_plan import FollowPlan
from nullmotion.plan import costs, exact, preferred, skip
from nullmotion.plan import enumerate as everything
from nullmotion.plan.best import INTERRUPTED, Progress
from nullmotion.plan.cost import Cost
from nullmotion.plan.describe import described
from nullmotion.plan.from_scenario import setup_of
from nullmotion.plan.result import Found, PlanResult
from nullmotion.plan.rollout import Rollouts
from nullmotion.sim.setup import Setup

METHODS = ("exact", "skip", "enumerate", "preferred", "continuous")
_START_LIMIT = 5.0  # seconds for the course that a continuous search starts from


def search(
    manoeuvre: Setup | Any,
    method: str = "exact",
    *,
    cost: str | Cost | None = None,
    depth: int | None = None,
    levels: int | None = None,
    k_max: float | None = None,
    lag: bool | None = None,
    duration: float | None = None,
    progress: Progress | None = None,
    **options: Any,
) -> PlanResult:
    """Return the best course of null motion over a whole manoeuvre.

    The result is never worse than no null motion. Ctrl-C ends a search with the best so far.

    Args:
        manoeuvre: A setup of any kind (see `Rollouts`), or a scenario, its file or its name,
            whose section ``[plan]`` then gives what is not given here.
        method: ``exact`` (branch and bound, proven), ``enumerate`` (all courses), ``skip``
            (the paper's heuristic), ``continuous`` (knots of any value) or ``preferred``
            (the best start angles instead of null motion on the way).
        cost: What is maximised: a name from `costs`, or a cost with its parameters; the
            paper's by default.
        depth: Number of knots; 10 by default.
        levels: Values of a knot, an odd number from 3; 3 by default.
        k_max: Unit of the knots [rad/s]; 0.7, or that of a law that follows a plan.
        lag: Take the null vector of the sample before; False, or likewise.
        duration: Time from the first knot to the last [s], after which nothing counts; the
            whole run by default.
        progress: Called with the finished share.
        **options: The method's own; see the module of its name.

    Raises:
        UnknownNameError: For an unknown method or cost.
        InputError: For a depth, levels or a duration that cannot be.
        UnsupportedArrayError: For an array without null motion.
        TraceError: For a law that cannot be compiled.
    """
    if method not in METHODS:
        raise UnknownNameError("method", method, METHODS)
    setup, asked = (manoeuvre, {}) if isinstance(manoeuvre, Setup) else setup_of(manoeuvre)
    given = {"cost": cost, "depth": depth, "k_max": k_max, "lag": lag, "duration": duration}
    asked |= {k: v for k, v in given.items() if v is not None}
    own = asked.pop("levels", 3)
    levels = own if levels is None else levels
    begin = time.perf_counter()
    rollouts = prepared(setup, **asked)
    middle = time.perf_counter()
    found = _found(method, rollouts, levels, progress, options)
    end = time.perf_counter()
    if len(found.knots) != rollouts.depth:
        rollouts = rollouts.of_depth(len(found.knots))
    result = described(rollouts, found, method)
    if setup.stop:
        result.remarks.append("stop conditions are left out: a plan is for the whole run")
    result.levels = levels if method in _ON_LEVELS else None
    return dataclasses.replace(result, seconds=end - middle, compile_seconds=middle - begin)


def prepared(
    setup: Setup,
    cost: str | Cost = "papakonstantinou",
    depth: int = 10,
    k_max: float | None = None,
    lag: bool | None = None,
    duration: float | None = None,
) -> Rollouts:
    """Return a manoeuvre compiled for a search; its arguments are those of `search`."""
    own = setup.law if isinstance(setup.law, FollowPlan) else FollowPlan()
    chosen = costs.create(cost) if isinstance(cost, str) else cost
    if duration is not None:
        steps = round(duration / setup.dt) if np.isfinite(duration) else 0
        if not 1 <= steps <= setup.steps:
            longest = setup.steps * setup.dt
            raise InputError("duration", duration, f"from {setup.dt:g} to {longest:g} s")
        setup = dataclasses.replace(setup, steps=steps)
    return Rollouts(
        setup,
        chosen,
        depth,
        own.k_max if k_max is None else k_max,
        own.lag if lag is None else lag,
    )


def _found(
    method: str, rollouts: Rollouts, levels: int, progress: Progress | None, more: dict[str, Any]
) -> Found:
    if method == "preferred":
        return preferred.search(rollouts, progress=progress, **more)
    if method == "continuous":
        from nullmotion.plan import continuous  # differentiates and compiles the manoeuvre

        start = exact.search(rollouts, levels, time_limit=_START_LIMIT)
        if INTERRUPTED in start.remarks:
            return start
        return continuous.search(rollouts, np.array(start.knots), progress=progress, **more)
    return _ON_LEVELS[method](rollouts, levels, progress=progress, **more)


_ON_LEVELS: dict[str, Callable[..., Found]] = {
    "exact": exact.search,
    "enumerate": everything.search,
    "skip": skip.search,
}
