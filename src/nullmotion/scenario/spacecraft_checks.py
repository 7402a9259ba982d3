"""Checks of the spacecraft, its servo, the torques from outside and the faults."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from nullmotion.array import CmgArray
from nullmotion.errors import InputError
from nullmotion.scenario import mission_checks, vehicle
from nullmotion.scenario.construction import add_construction
from nullmotion.scenario.problems import MISSING
from nullmotion.scenario.scenario import Scenario
from nullmotion.scenario.toml import Path
from nullmotion.scenario.validate import Validator

_ORBIT = ("inclination_deg", "ascending_node_deg", "argument_of_latitude_deg")
_OF_KIND = {
    "rate_limit_deg_s": "slow",
    "time_constant_s": "spin-down",
    "final_fraction": "spin-down",
}


def check(scenario: Scenario, array: CmgArray, v: Validator) -> None:
    """Add to the validator what cannot be or does not fit together."""
    craft, controller = scenario.spacecraft, scenario.controller
    if craft is not None:
        if craft.q_BN is not None and craft.euler_321_deg is not None:
            allowed = "give one of q_BN and euler_321_deg: this is the same attitude twice"
            v.add(("spacecraft", "q_BN"), craft.q_BN, allowed)
        mission_checks.quaternion(v, ("spacecraft", "q_BN"), craft.q_BN)
        inertia = craft.model_copy(update={"q_BN": None})
        _construct(v, ("spacecraft",), lambda: vehicle.spacecraft(inertia))
    if controller is not None:
        _construct(v, ("controller",), lambda: vehicle.controller(controller))
    _servo(scenario, array, v)
    _disturbance(scenario, v)
    _reaction_wheel(scenario, array, v)
    for i in range(len(scenario.events)):
        _event(scenario, array, i, v)


def _construct(v: Validator, section: Path, make: Callable[[], Any]) -> None:
    try:
        make()
    except InputError as error:
        add_construction(v, section, error)


def _servo(scenario: Scenario, array: CmgArray, v: Validator) -> None:
    section = scenario.servo
    if section is None:
        return
    each_cmg(scenario, array, "servo", v)
    if section.gimbal_inertia_kg_m2 is None:
        for key in ("motor_torque_limit_Nm", "friction_Nm"):
            value = getattr(section, key)
            if value is not None and np.any(np.asarray(value) != 0):
                v.add(("servo", key), value, "only together with gimbal_inertia_kg_m2")


def each_cmg(scenario: Scenario, array: CmgArray, name: str, v: Validator) -> None:
    """Note lists in a section that have another length than one value for each CMG."""
    section = getattr(scenario, name)
    total = array.n + len(set(scenario.array.failed_cmgs))
    counts = sorted({array.n, total})
    for key in type(section).model_fields:
        value = getattr(section, key)
        if isinstance(value, tuple) and len(value) not in counts:
            words = " or ".join(map(str, counts))
            allowed = f"one number or {words}, one for each CMG (this has {len(value)})"
            v.add((name, key), value, allowed)


def _disturbance(scenario: Scenario, v: Validator) -> None:
    section = scenario.disturbance
    if section is None:
        return
    needs = dict.fromkeys(_ORBIT, "altitude_km")
    needs |= {"frequency_Hz": "amplitude_Nm", "phase_deg": "amplitude_Nm"}
    needs |= {"amplitude_Nm": "frequency_Hz"}
    why = {"altitude_km": ", which switches the gravity gradient on"}
    for key, other in needs.items():
        if section.given(key) and getattr(section, other) is None:
            allowed = f"only together with {other}{why.get(other, '')}"
            v.add(("disturbance", key), getattr(section, key), allowed)


def _reaction_wheel(scenario: Scenario, array: CmgArray, v: Validator) -> None:
    section = scenario.reaction_wheel
    if section is None:
        return
    pair = ("wheel_inertia_kg_m2", "speed_limit_rpm")
    given = [key for key in pair if getattr(section, key) is not None]
    if len(given) == 1:
        other = pair[1 - pair.index(given[0])]
        path = ("reaction_wheel", given[0])
        v.add(path, getattr(section, given[0]), f"only together with {other}")
    elif given and section.momentum_limit_Nms is not None:
        allowed = f"either this or {' and '.join(pair)}"
        v.add(("reaction_wheel", "momentum_limit_Nms"), section.momentum_limit_Nms, allowed)
    elif array.m != 2:
        allowed = f"only beside an array with two torque dimensions (this one has {array.m})"
        v.add(("reaction_wheel",), MISSING, allowed)
    else:
        made = vehicle.reaction_wheel
        _construct(v, ("reaction_wheel",), lambda: made(section, array).check_beside(array))


def _event(scenario: Scenario, array: CmgArray, i: int, v: Validator) -> None:
    section, path = scenario.events[i], ("event", i)
    failed = set(scenario.array.failed_cmgs)
    total = array.n + len(failed)
    if section.cmg >= total:
        v.add((*path, "cmg"), section.cmg, f"from 0 to {total - 1}")
    elif section.cmg in failed:
        allowed = "a CMG that works (array.failed_cmgs has this one)"
        v.add((*path, "cmg"), section.cmg, allowed)
    duration = scenario.simulation.duration_s
    if section.at_s > duration:
        allowed = f"at most simulation.duration_s = {duration:g}"
        v.add((*path, "at_s"), section.at_s, allowed)
    for key, kind in _OF_KIND.items():
        value = getattr(section, key)
        if value is not None and section.kind != kind:
            v.add((*path, key), value, f'only with kind = "{kind}" (this is "{section.kind}")')
    if section.kind == "slow" and section.rate_limit_deg_s is None:
        v.add((*path, "kind"), section.kind, "needs rate_limit_deg_s, what a slow gimbal can turn")
