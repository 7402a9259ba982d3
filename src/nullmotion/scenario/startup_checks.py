"""Checks of startups: wheels and a law that turns them, and momentum that the array can hold."""

from __future__ import annotations

from typing import Any

import numpy as np

from nullmotion import laws
from nullmotion.array import CmgArray
from nullmotion.law import Law
from nullmotion.scenario import momentum_budget
from nullmotion.scenario.array_checks import INERTIA
from nullmotion.scenario.scenario import Scenario
from nullmotion.scenario.validate import Validator

NOT_BESIDE = ("servo", "reaction_wheel")  # wheels whose speed changes


def check(scenario: Scenario, array: CmgArray, v: Validator) -> None:
    """Ask for wheels and a law that brings them to their speeds."""
    if scenario.mission.kind != "startup":
        return
    if array.wheels is None:
        allowed = f"needs array.{INERTIA}: wheels that can be brought to their speed"
        v.add(("mission", "kind"), "startup", allowed)
    law = laws.get(scenario.law.name)
    if not law.turns_wheels:
        v.add(("law", "name"), scenario.law.name, startup_laws())
        return
    aim = getattr(scenario.law, "wheel_speed_rad_s", None)
    if aim is None or array.wheels is None:
        return
    if np.any(np.abs(aim - array.design_speed) > scenario.mission.wheel_tolerance * abs(aim)):
        design = ", ".join(f"{speed:.6g}" for speed in sorted(set(array.design_speed.tolist())))
        allowed = f"the speed that a startup is to reach, the array's: {design} rad/s"
        v.add(("law", "wheel_speed_rad_s"), aim, allowed)


def startup_laws() -> str:
    """Return which laws a startup can have."""
    known = [name for name in laws.names() if laws.get(name).turns_wheels]
    return f"a startup needs a law that turns the wheels: {', '.join(known)}"


def unsuitable(scenario: Scenario, law: type[Law]) -> str:
    """Return why a law cannot fly a scenario that another law can; empty if it can."""
    turns = law.turns_wheels
    if scenario.mission.kind == "startup" and not turns:
        return startup_laws()
    beside = [key for key in NOT_BESIDE if getattr(scenario, key) is not None]
    if turns and beside:
        return f"turns the wheels, which does not go with [{beside[0]}]"
    if not turns and scenario.vscmg is None and scenario.initial.wheel_speed_rad_s is not None:
        return "does not turn the wheels, and initial.wheel_speed_rad_s is given"
    return ""


def budget(scenario: Scenario, array: CmgArray, v: Validator) -> None:
    """Refuse a startup whose momentum the array cannot hold in the end."""
    found = momentum_budget.shortfall(scenario, array)
    if found is None:
        return
    needed, held = found
    allowed = (
        f"less momentum: {needed:.4g} N m s would be left at the end, and at the speeds it is "
        f"designed for the array holds at most {held:.4g} N m s in that direction"
    )
    path, value = _blamed(scenario, array)
    v.add(path, value, allowed)


def _blamed(scenario: Scenario, array: CmgArray) -> tuple[tuple[str, ...], Any]:
    """Return the key and value that most of the momentum comes from."""
    found, craft = momentum_budget.budget(scenario, array), scenario.spacecraft
    if np.linalg.norm(found.outside) > np.linalg.norm(found.start):
        assert scenario.disturbance is not None
        return ("disturbance", "constant_Nm"), scenario.disturbance.constant_Nm
    if craft is not None and any(craft.omega_BN_B):
        return ("spacecraft", "omega_BN_B"), craft.omega_BN_B
    return ("mission", "kind"), scenario.mission.kind
