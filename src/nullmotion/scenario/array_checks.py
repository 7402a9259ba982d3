"""Checks of the array: its momenta, flywheels and failed CMGs."""

from __future__ import annotations

import numpy as np

from nullmotion.array import CmgArray
from nullmotion.errors import InputError
from nullmotion.scenario import objects
from nullmotion.scenario.construction import add_construction
from nullmotion.scenario.schema import ArraySection
from nullmotion.scenario.validate import Validator

INERTIA = "wheel_inertia_kg_m2"
SPEEDS = ("wheel_speed_rpm", "wheel_speed_rad_s")
LIMITS = ("wheel_torque_limit_Nm", "wheel_speed_limit_rpm", "wheel_power_limit_W")


def check(section: ArraySection, v: Validator) -> CmgArray | None:
    """Return the array that works; None, with the reasons noted, if there is none."""
    _momenta(section, v)
    if section.frozen_at_deg is not None and not section.failed_cmgs:
        v.add(("array", "frozen_at_deg"), section.frozen_at_deg, "only together with failed_cmgs")
    if not v.problems:
        _lengths(section, v)
    if v.problems:
        return None
    try:
        whole = objects.whole_array(section)
    except InputError as error:
        add_construction(v, ("array",), error)
        return None
    _speeds(section, whole, v)
    return _failures(section, whole, v)


def _momenta(section: ArraySection, v: Validator) -> None:
    """Note momenta that are said twice, and wheels that are said in part."""
    speeds = [key for key in SPEEDS if section.given(key)]
    given = [key for key in (INERTIA, *speeds) if section.given(key)]
    h0 = section.given("h0_Nms")
    if h0 and speeds:
        allowed = f"either h0_Nms or {INERTIA} and {speeds[0]}; {speeds[0]} is given too"
        v.add(("array", "h0_Nms"), section.h0_Nms, allowed)
    elif len(speeds) > 1:
        value = getattr(section, speeds[0])
        v.add(("array", speeds[0]), value, f"give one of {' and '.join(speeds)}")
    elif given == [INERTIA] and not h0:
        others = "wheel_speed_rpm, wheel_speed_rad_s or h0_Nms"
        v.add(("array", INERTIA), getattr(section, INERTIA), f"only together with {others}")
    for key in (*speeds, *LIMITS):
        if section.given(key) and not section.given(INERTIA) and not v.problems:
            v.add(("array", key), getattr(section, key), f"only together with {INERTIA}")


def _lengths(section: ArraySection, v: Validator) -> None:
    """Note lists about wheels that have another length than the array."""
    listed = [k for k in (INERTIA, *SPEEDS, *LIMITS) if isinstance(getattr(section, k), tuple)]
    if not listed:
        return
    try:
        count = objects.whole_count(section)
    except InputError as error:
        add_construction(v, ("array",), error)
        return
    for key in listed:
        value = getattr(section, key)
        if len(value) != count:
            allowed = f"one number or {count}, one for each CMG (this has {len(value)})"
            v.add(("array", key), value, allowed)


def _speeds(section: ArraySection, whole: CmgArray, v: Validator) -> None:
    """Note a design speed beyond what the wheels may turn at."""
    wheels = whole.wheels
    if wheels is not None and np.any(whole.design_speed > wheels.speed_limit * (1 + 1e-9)):
        most = float(np.max(whole.design_speed)) / objects.RPM
        allowed = f"at least the speed that the array is designed for, {most:.6g} rpm"
        v.add(("array", "wheel_speed_limit_rpm"), section.wheel_speed_limit_rpm, allowed)


def _failures(section: ArraySection, whole: CmgArray, v: Validator) -> CmgArray | None:
    frozen = section.frozen_at_deg
    if isinstance(frozen, tuple) and len(frozen) != len(set(section.failed_cmgs)):
        v.add(
            ("array", "frozen_at_deg"),
            frozen,
            f"one number or {len(section.failed_cmgs)}, one for each failed CMG",
        )
    elif len(set(section.failed_cmgs)) >= whole.n or any(i >= whole.n for i in section.failed_cmgs):
        v.add(
            ("array", "failed_cmgs"),
            section.failed_cmgs,
            f"indices from 0 to {whole.n - 1}, at least one CMG left",
        )
    else:
        return objects.array(section)
    return None
