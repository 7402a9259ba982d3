"""VSCMG units and their wheel speeds from the sections of a scenario, in SI."""

from __future__ import annotations

from typing import Any

import numpy as np

from nullmotion.array import CmgArray
from nullmotion.scenario import keys, objects
from nullmotion.scenario.scenario import Scenario
from nullmotion.scenario.schema import ArraySection
from nullmotion.scenario.schema_vscmg import VscmgSection
from nullmotion.vscmg import Units


def made(section: VscmgSection, array: ArraySection, n: int) -> Units:
    """Return the units of the n working CMGs; lists may have one value for each CMG of all."""
    own: dict[str, Any] = {}
    for key in type(section).model_fields:
        value = getattr(section, key)
        if value is None:
            continue
        field = keys.without_unit(key)
        own[field] = objects.working(array, value, n) if isinstance(value, tuple) else value
    return Units(**own)


def wheel_speed(scenario: Scenario, array: CmgArray) -> np.ndarray:
    """Return the wheel speeds at the start [rad/s], (n,): given, 0 for a startup, or h0 / I."""
    given = scenario.initial.wheel_speed_rad_s
    if given is None:
        return np.zeros(array.n) if scenario.mission.kind == "startup" else array.design_speed
    if isinstance(given, tuple):
        return objects.working(scenario.array, given, array.n)
    return np.full(array.n, float(given))
