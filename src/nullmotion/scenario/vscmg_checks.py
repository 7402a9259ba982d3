"""Checks of variable-speed CMGs and of startups."""

from __future__ import annotations

from typing import Any

import numpy as np

from nullmotion.array import CmgArray
from nullmotion.errors import InputError
from nullmotion.scenario import plant, start, startup_checks, vehicle, vscmg_units
from nullmotion.scenario.array_checks import INERTIA
from nullmotion.scenario.construction import add_construction
from nullmotion.scenario.problems import MISSING
from nullmotion.scenario.scenario import Scenario
from nullmotion.scenario.spacecraft_checks import each_cmg
from nullmotion.scenario.validate import Validator


def check(scenario: Scenario, array: CmgArray, v: Validator) -> None:
    """Add to the validator what cannot be or does not fit together."""
    _units_alone(scenario, array, v)
    startup_checks.check(scenario, array, v)
    _events(scenario, array, v)
    if scenario.variable_speed and array.wheels is not None:
        _beside(scenario, v)
        _speeds(scenario, array, v)
        if not v.problems and scenario.spacecraft is not None:
            _inertias(scenario, array, v)
        if not v.problems and scenario.mission.kind == "startup":
            startup_checks.budget(scenario, array, v)
    elif scenario.initial.wheel_speed_rad_s is not None and not v.problems:
        allowed = f"only with {INERTIA}, and a law that turns the wheels or [vscmg]"
        v.add(("initial", "wheel_speed_rad_s"), scenario.initial.wheel_speed_rad_s, allowed)


def _units_alone(scenario: Scenario, array: CmgArray, v: Validator) -> None:
    """Check the units without what surrounds them."""
    section = scenario.vscmg
    if section is None:
        return
    if array.wheels is None:
        v.add(("vscmg",), MISSING, f"needs array.{INERTIA}: wheels whose speed may change")
    each_cmg(scenario, array, "vscmg", v)
    if v.problems:
        return
    try:
        vscmg_units.made(section, scenario.array, array.n).for_n(array.n)
    except InputError as error:
        add_construction(v, ("vscmg",), error)


def _events(scenario: Scenario, array: CmgArray, v: Validator) -> None:
    """Note faults that this kind of array does not have."""
    variable = scenario.variable_speed and array.wheels is not None
    drive = "rate" if scenario.vscmg is None else scenario.vscmg.drive
    for i, event in enumerate(scenario.events):
        path = ("event", i, "kind")
        if event.kind == "wheel-dead" and not variable:
            allowed = f"only with array.{INERTIA}, and a law that turns the wheels or [vscmg]"
            v.add(path, event.kind, allowed)
        elif event.kind == "spin-down" and variable:
            v.add(path, event.kind, "'wheel-dead', or a gimbal's fault: wheel speeds change here")
        elif event.kind == "stuck" and variable and drive == "torque":
            v.add(path, event.kind, 'only with vscmg.drive = "rate" (this is "torque")')


def _beside(scenario: Scenario, v: Validator) -> None:
    """Note what does not go with wheels whose speed changes."""
    why = "[vscmg]" if scenario.vscmg is not None else f"the law {scenario.law.name}"
    told = [problem.key for problem in v.problems]
    for key in startup_checks.NOT_BESIDE:
        if getattr(scenario, key) is not None and key not in told:
            own = "; [vscmg] says how gimbals are driven" if key == "servo" else ""
            v.add((key,), MISSING, f"not beside {why}, which changes wheel speeds{own}")
    if scenario.simulation.integrator != "rk4" and scenario.spacecraft is not None:
        value = scenario.simulation.integrator
        allowed = "'rk4' for a spacecraft whose wheel speeds change"
        v.add(("simulation", "integrator"), value, allowed)
    section = scenario.array
    if section.angle_limits_deg is not None and _driven_by_torque(scenario):
        allowed = 'only with vscmg.drive = "rate" (this is "torque")'
        v.add(("array", "angle_limits_deg"), section.angle_limits_deg, allowed)


def _driven_by_torque(scenario: Scenario) -> bool:
    return scenario.vscmg is not None and scenario.vscmg.drive == "torque"


def _speeds(scenario: Scenario, array: CmgArray, v: Validator) -> None:
    """Note wheel speeds at the start that are too many, too few or too high."""
    given = scenario.initial.wheel_speed_rad_s
    if given is None:
        return
    path = ("initial", "wheel_speed_rad_s")
    total = array.n + len(set(scenario.array.failed_cmgs))
    if isinstance(given, tuple) and len(given) not in (array.n, total):
        counts = " or ".join(map(str, sorted({array.n, total})))
        v.add(path, given, f"one number or {counts}, one for each CMG (this has {len(given)})")
        return
    most = array.flywheels.speed_limit * (1 + 1e-9)
    if np.any(np.abs(vscmg_units.wheel_speed(scenario, array)) > most):
        v.add(path, given, "speeds within array.wheel_speed_limit_rpm")


def _inertias(scenario: Scenario, array: CmgArray, v: Validator) -> None:
    """Check the units' inertias beside those of wheels and body."""
    section, craft = scenario.vscmg, scenario.spacecraft
    if section is None or craft is None:
        return
    real, _ = plant.drawn(scenario.plant, array)
    units = vscmg_units.made(section, scenario.array, array.n).for_n(array.n)
    inertia = vehicle.spacecraft(craft).inertia
    delta = start.angles(scenario.array, scenario.initial, array)
    try:
        units.check_beside(array if real is None else real, inertia, delta)
    except InputError as error:
        name: Any = "spacecraft" if error.key.startswith("spacecraft") else "vscmg"
        add_construction(v, (name,), error)
