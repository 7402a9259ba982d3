"""Checks of what a mission asks for."""

from __future__ import annotations

from typing import Any

import numpy as np

from nullmotion.array import CmgArray
from nullmotion.scenario import attitude, profile
from nullmotion.scenario.problems import MISSING
from nullmotion.scenario.scenario import Scenario
from nullmotion.scenario.schema import MissionSection
from nullmotion.scenario.toml import Path
from nullmotion.scenario.validate import Validator

_TARGETS = ("target_q_BN", "target_euler_321_deg")
_ATTITUDE = (*_TARGETS, "profile", "profile_hold", "slew_time_s", "settle_tolerance_deg")
_KEYS = {
    "momentum-rate": ("hdot_Nm", "profile"),
    "momentum": ("momentum_Nms",),
    "attitude": _ATTITUDE,
    "startup": (*_ATTITUDE, "wheel_tolerance"),
}


def check(scenario: Scenario, array: CmgArray, v: Validator) -> None:
    """Add to the validator what a mission lacks, has too much, or cannot mean."""
    mission = scenario.mission
    for key in type(mission).model_fields:
        kinds = [kind for kind, known in _KEYS.items() if key in known]
        if key != "kind" and mission.given(key) and mission.kind not in kinds:
            words = " or ".join(f'"{kind}"' for kind in kinds)
            allowed = f'only with mission.kind = {words} (this is "{mission.kind}")'
            v.add(("mission", key), getattr(mission, key), allowed)
    if v.problems:
        return
    checks = {"momentum-rate": _rate, "momentum": _momentum}
    checks.get(mission.kind, _attitude)(scenario, array, v)


def torque_dimensions(v: Validator, path: Path, value: tuple[float, ...], m: int) -> bool:
    """Return whether a list has a number for each torque dimension; note it if not."""
    if len(value) != m:
        allowed = f"{m} numbers, one for each torque dimension of the array (this has {len(value)})"
        v.add(path, value, allowed)
    return len(value) == m


def quaternion(v: Validator, path: Path, value: Any) -> None:
    """Note a quaternion that has no direction."""
    if value is not None and np.linalg.norm(value) < attitude.LEAST_LENGTH:
        v.add(path, value, "a quaternion that is not zero")


def _rate(scenario: Scenario, array: CmgArray, v: Validator) -> None:
    mission = scenario.mission
    if (mission.hdot_Nm is None) == (mission.profile is None):
        both = "exactly one of hdot_Nm and profile"
        v.add(
            ("mission",),
            MISSING,
            f"needs {both}" if mission.profile is None else f"takes {both}, not both",
        )
    elif mission.hdot_Nm is not None:
        torque_dimensions(v, ("mission", "hdot_Nm"), mission.hdot_Nm, array.m)
    else:
        _load(scenario, v, lambda name: profile.load(scenario.source, name, array.m))


def _momentum(scenario: Scenario, array: CmgArray, v: Validator) -> None:
    wanted = scenario.mission.momentum_Nms
    if wanted is None:
        v.add(("mission",), MISSING, 'kind = "momentum" needs momentum_Nms')
    else:
        torque_dimensions(v, ("mission", "momentum_Nms"), wanted, array.m)


def _attitude(scenario: Scenario, array: CmgArray, v: Validator) -> None:
    mission = scenario.mission
    targets = [key for key in _TARGETS if getattr(mission, key) is not None]
    if array.m != 3 and not (array.m == 2 and scenario.reaction_wheel is not None):
        wheel = ", or [reaction_wheel] beside it" if array.m == 2 else ""
        allowed = (
            f"an array with torque in all three dimensions ({scenario.array.layout} has "
            f"{array.m}: momentum-rate and momentum missions only{wheel})"
        )
        v.add(("mission", "kind"), mission.kind, allowed)
    if len(targets) == 2:
        allowed = f"give one of {' and '.join(_TARGETS)}: this is the same target twice"
        v.add(("mission", targets[0]), mission.target_q_BN, allowed)
    elif targets and mission.profile is not None:
        v.add(("mission", "profile"), mission.profile, f"give {targets[0]} or profile, not both")
    elif not targets and mission.profile is None:
        _without_target(mission, v)
    if mission.slew_time_s is not None and mission.profile is not None:
        allowed = "only with a target (a profile has times of its own)"
        v.add(("mission", "slew_time_s"), mission.slew_time_s, allowed)
    if mission.profile_hold and mission.profile is None:
        v.add(("mission", "profile_hold"), True, "only together with profile")
    quaternion(v, ("mission", "target_q_BN"), mission.target_q_BN)
    if mission.profile is not None and not targets:
        _load(scenario, v, lambda name: attitude.check_profile(mission, scenario.source, name))


def _without_target(mission: MissionSection, v: Validator) -> None:
    """Note a missing target; a startup goes to the attitude at its start."""
    if mission.kind == "attitude":
        v.add(("mission",), MISSING, f"needs {', '.join(_TARGETS)} or profile")
    elif mission.slew_time_s is not None:
        allowed = f"only together with {' or '.join(_TARGETS)}"
        v.add(("mission", "slew_time_s"), mission.slew_time_s, allowed)


def _load(scenario: Scenario, v: Validator, read: Any) -> None:
    name = scenario.mission.profile
    try:
        read(name)
    except profile.ProfileError as error:
        v.add(("mission", "profile"), name, str(error))
