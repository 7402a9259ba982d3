"""The section of a scenario file about variable-speed CMGs."""

from __future__ import annotations

from typing import Literal

from nullmotion.scenario.schema import NotNegative, Positive, Section, one_or_each


class VscmgSection(Section):
    """``[vscmg]``: inertias of the units (wheel and gimbal together), motors and friction."""

    spin_inertia_kg_m2: one_or_each(NotNegative)  # type: ignore[valid-type]
    transverse_inertia_kg_m2: one_or_each(NotNegative)  # type: ignore[valid-type]
    gimbal_inertia_kg_m2: one_or_each(NotNegative)  # type: ignore[valid-type]
    drive: Literal["rate", "torque"] = "rate"
    terms: Literal["all", "published"] = "all"
    gimbal_torque_limit_Nm: one_or_each(Positive) | None = None  # type: ignore[valid-type]
    gimbal_bandwidth_rad_s: one_or_each(Positive) | None = None  # type: ignore[valid-type]
    gimbal_friction_Nm: one_or_each(NotNegative) = 0.0  # type: ignore[valid-type]
    gimbal_drag_Nms: one_or_each(NotNegative) = 0.0  # type: ignore[valid-type]
    wheel_friction_Nm: one_or_each(NotNegative) = 0.0  # type: ignore[valid-type]
    wheel_drag_Nms: one_or_each(NotNegative) = 0.0  # type: ignore[valid-type]
    inertia_includes_units: bool = True
