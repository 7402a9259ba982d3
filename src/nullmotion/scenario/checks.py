"""Checks of a scenario that need more than one key."""

from __future__ import annotations

import math
from typing import Any

from nullmotion.errors import InputError, UnknownNameError
from nullmotion.scenario import (
    array_checks,
    mission_checks,
    objects,
    requirements,
    spacecraft_checks,
    start_checks,
    vscmg_checks,
)
from nullmotion.scenario.construction import add_construction
from nullmotion.scenario.scenario import Scenario
from nullmotion.scenario.toml import Path
from nullmotion.scenario.validate import Validator

WHOLE = 1e-9  # how near to a whole multiple of dt a time must be
MOST_STEPS = 2**31


def check(scenario: Scenario, validator: Validator) -> None:
    """Add to the validator what does not fit together."""
    array = array_checks.check(scenario.array, validator)
    if array is not None:
        start_checks.check(scenario.array, scenario.initial, array, validator)
        mission_checks.check(scenario, array, validator)
        spacecraft_checks.check(scenario, array, validator)
    requirements.check(scenario, validator)
    _check_times(scenario, validator)
    _check_cost(scenario, validator)
    for path, section in [(("law",), scenario.law), *_cases(scenario)]:
        try:
            objects.law(section)
        except InputError as error:
            add_construction(validator, path, error)
    if array is not None:
        vscmg_checks.check(scenario, array, validator)


def _check_cost(scenario: Scenario, v: Validator) -> None:
    if scenario.plan is None:
        return
    from nullmotion.plan import costs  # only where a plan is asked for: it brings the compiler

    try:
        costs.get(scenario.plan.cost)
    except UnknownNameError as error:
        v.add(("plan", "cost"), error.value, error.allowed)


def _cases(scenario: Scenario) -> list[tuple[Path, Any]]:
    return [(("compare", "case", i), case) for i, case in enumerate(scenario.cases)]


def _check_times(scenario: Scenario, v: Validator) -> None:
    times, law = scenario.simulation, scenario.law
    if times.dt_s > times.duration_s:
        v.add(("simulation", "dt_s"), times.dt_s, f"at most duration_s = {times.duration_s:g}")
    elif times.duration_s / times.dt_s > MOST_STEPS:
        v.add(
            ("simulation", "dt_s"),
            times.dt_s,
            f"a step of which at most {MOST_STEPS} make up duration_s = {times.duration_s:g}",
        )
    plan = scenario.plan
    if plan is not None and plan.duration_s is not None and plan.duration_s > times.duration_s:
        allowed = f"at most simulation.duration_s = {times.duration_s:g}"
        v.add(("plan", "duration_s"), plan.duration_s, allowed)
    for key in ("period_s", "delay_s"):
        value = getattr(law, key)
        if value is not None and not is_multiple(
            value, times.dt_s, least=1 if key == "period_s" else 0
        ):
            v.add(("law", key), value, f"a whole multiple of simulation.dt_s = {times.dt_s:g}")


def is_multiple(value: float, step: float, least: int = 0) -> bool:
    """Return whether a time is a whole multiple of a step."""
    count = value / step
    return (
        math.isfinite(count)
        and round(count) >= least
        and abs(count - round(count)) <= WHOLE * max(1.0, count)
    )
