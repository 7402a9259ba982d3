"""Arrays and laws from the sections of a scenario, in SI and radians."""

from __future__ import annotations

from typing import Any

import numpy as np

from nullmotion import laws
from nullmotion.array import CmgArray, layouts
from nullmotion.array.layout import Layout
from nullmotion.array.wheels import Wheels
from nullmotion.law import Law
from nullmotion.scenario.schema import ArraySection, CustomArraySection, NamedLaw
from nullmotion.scenario.sections import parameters

RPM = 2 * np.pi / 60


def layout(section: ArraySection) -> Layout:
    """Return the layout with its parameters; raises InputError for impossible ones."""
    cls = layouts.get(section.layout)
    made: Layout = cls(**parameters(section, cls))
    return made


def whole_array(section: ArraySection) -> CmgArray:
    """Return the array before any CMG failed."""
    own: dict[str, Any] = {"h0": momenta(section), "rate_limit_mode": section.rate_limit_mode}
    if section.rate_limit_deg_s is not None:
        own["rate_limit"] = np.radians(section.rate_limit_deg_s)
    if section.angle_limits_deg is not None:
        own["angle_limits"] = np.radians(section.angle_limits_deg)
    if section.momentum_bias_Nms is not None:
        own["momentum_bias"] = np.array(section.momentum_bias_Nms, float)
    if section.wheel_inertia_kg_m2 is not None:
        own["wheels"] = wheels(section)
    if isinstance(section, CustomArraySection):
        return CmgArray(np.array(section.gimbal_axes), np.array(section.spin_axes), **own)
    return layout(section).array(**own)


def whole_count(section: ArraySection) -> int:
    """Return the number of CMGs before any failed."""
    if isinstance(section, CustomArraySection):
        return len(section.gimbal_axes)
    return layout(section).array().n


def array(section: ArraySection) -> CmgArray:
    """Return the array that works: the layout's without the failed CMGs."""
    whole = whole_array(section)
    if not section.failed_cmgs:
        return whole
    frozen = None if section.frozen_at_deg is None else np.radians(section.frozen_at_deg)
    return whole.without(section.failed_cmgs, frozen)


def momenta(section: ArraySection) -> Any:
    """Return the spin momenta [N m s]: given, or wheel inertia times wheel speed."""
    speed = wheel_speed(section)
    if section.wheel_inertia_kg_m2 is None or speed is None:
        return np.asarray(section.h0_Nms, float)
    return np.asarray(section.wheel_inertia_kg_m2, float) * speed


def wheel_speed(section: ArraySection) -> Any:
    """Return the wheel speed that is given [rad/s]; None where it is not."""
    if section.wheel_speed_rad_s is not None:
        return np.asarray(section.wheel_speed_rad_s, float)
    given = section.wheel_speed_rpm
    return None if given is None else np.asarray(given, float) * RPM


def wheels(section: ArraySection) -> Wheels:
    """Return the flywheels with the limits of their motors."""
    limits = {
        "torque_limit": (section.wheel_torque_limit_Nm, 1.0),
        "speed_limit": (section.wheel_speed_limit_rpm, RPM),
        "power_limit": (section.wheel_power_limit_W, 1.0),
    }
    own = {k: np.asarray(v, float) * unit for k, (v, unit) in limits.items() if v is not None}
    return Wheels(np.asarray(section.wheel_inertia_kg_m2, float), **own)


def working(section: ArraySection, values: Any, n: int) -> np.ndarray:
    """Return values of the working CMGs (last axis) from those of the working or of all."""
    given = np.asarray(values, float)
    if given.shape[-1] == n:
        return given
    keep = [i for i in range(given.shape[-1]) if i not in section.failed_cmgs]
    return given[..., keep]


def start(section: ArraySection, gimbal_deg: Any, n: int) -> np.ndarray:
    """Return the start angles [rad], (n,): those given or the layout's home."""
    if gimbal_deg is not None:
        return working(section, np.radians(gimbal_deg), n)
    if isinstance(section, CustomArraySection):
        return np.zeros(n)
    return working(section, layout(section).home(), n)


def law(section: NamedLaw) -> Law:
    """Return the law with its parameters; raises InputError for impossible ones."""
    cls = laws.get(section.name)
    made: Law = cls(**parameters(section, cls))
    return made
