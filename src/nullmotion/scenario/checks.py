"""Checks of a scenario that need more than one key."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from nullmotion.array import CmgArray
from nullmotion.errors import InputError, UnknownNameError
from nullmotion.scenario import (
    array_checks,
    mission_checks,
    objects,
    requirements,
    spacecraft_checks,
    start,
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
        _check_start(scenario, array, validator)
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


def _check_start(scenario: Scenario, array: CmgArray, v: Validator) -> None:
    section, angles = scenario.array, scenario.initial.gimbal_deg
    momentum = scenario.initial.momentum_Nms
    total = array.n + len(set(section.failed_cmgs))
    if angles is not None and len(angles) not in (array.n, total):
        v.add(
            ("initial", "gimbal_deg"),
            angles,
            f"{_counts(array.n, total)} numbers, one for each CMG (this has {len(angles)})",
        )
        return
    if momentum is not None:
        _check_momentum(scenario, array, v)
        return
    delta = objects.start(section, angles, array.n)
    low, high = array.angle_limits[:, 0], array.angle_limits[:, 1]
    if np.any((delta < low - 1e-12) | (delta > high + 1e-12)):
        value = np.round(np.degrees(delta), 6).tolist() if angles is None else angles
        v.add(("initial", "gimbal_deg"), value, "angles within array.angle_limits_deg")


def _check_momentum(scenario: Scenario, array: CmgArray, v: Validator) -> None:
    path, initial = ("initial", "momentum_Nms"), scenario.initial
    assert initial.momentum_Nms is not None
    if initial.gimbal_deg is not None:
        v.add(path, initial.momentum_Nms, "give one of gimbal_deg and momentum_Nms")
    elif mission_checks.torque_dimensions(v, path, initial.momentum_Nms, array.m):
        try:
            start.angles(scenario.array, initial, array)
        except InputError as error:
            v.add(path, error.value, error.allowed)


def _counts(n: int, total: int) -> str:
    return str(n) if n == total else f"{n} or {total}"


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
