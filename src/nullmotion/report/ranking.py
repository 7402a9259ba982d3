"""Columns of a compare table, and which of their values are best."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Literal, NamedTuple

import numpy as np

from nullmotion.report.markup import Markup, join, tag
from nullmotion.report.wording import number, percent


class Column(NamedTuple):
    """A number that each case has.

    Args:
        title: Head of the column, with its unit.
        key: Its key in a case's metrics.
        better: Which values are best; empty where neither is.
    """

    title: str
    key: str
    better: Literal["low", "high", ""] = ""

    def written(self, value: Any) -> str:
        """Return a value as the column shows it."""
        return percent(value) if self.key.endswith("_fraction") else number(value)


COLUMNS = (
    Column("Time to stop [s]", "stopped_at_s"),
    Column("Momentum reserve [N\u00a0m\u00a0s]", "final_momentum_reserve_Nms", "low"),
    Column("Off-axis torque, peak [%]", "max_off_axis_torque_fraction", "low"),
    Column("Off-axis torque, RMS [%]", "rms_off_axis_torque_fraction", "low"),
    Column("Along-axis error, peak [%]", "max_along_axis_torque_fraction", "low"),
    Column("Along-axis error, RMS [%]", "rms_along_axis_torque_fraction", "low"),
    Column("Rate step [rad/s]", "max_rate_step_rad_s", "low"),
    Column("Least sigma_min [-]", "min_sigma_min", "high"),
)
ATTITUDE_COLUMNS = (
    Column("Settling time [s]", "settling_time_s", "low"),
    Column("Final pointing error [deg]", "final_pointing_error_deg", "low"),
    Column("Peak body rate [deg/s]", "max_body_rate_deg_s"),
    Column("Peak motor torque [N\u00a0m]", "max_motor_torque_Nm", "low"),
    Column("Rate-saturated [s]", "rate_saturated_s", "low"),
    Column("Least sigma_min [-]", "min_sigma_min", "high"),
    Column("Gimbal travel [rad]", "gimbal_travel_rad", "low"),
)

WHEEL_COLUMNS = (
    *ATTITUDE_COLUMNS[:2],
    Column("Wheels at speed [s]", "wheel_settling_s", "low"),
    Column("Final wheel speed error [-]", "final_wheel_speed_error", "low"),
    Column("Peak wheel torque [N\u00a0m]", "max_wheel_torque_Nm", "low"),
    *ATTITUDE_COLUMNS[2:],
)

_FLOOR = 1e-6  # differences below are rounding, not merit


def best(column: Column, values: Sequence[Any], eligible: Sequence[bool]) -> list[bool]:
    """Return which values are the best of a column.

    Ties within a millionth count together; nothing is marked where all are alike.

    Args:
        column: The column.
        values: Numbers or None.
        eligible: Which cases did their job; others are never best.
    """
    numbers = np.array(
        [_as_float(v) if ok else np.nan for v, ok in zip(values, eligible, strict=True)]
    )
    known = np.isfinite(numbers)
    if not column.better or known.sum() < 2:
        return [False] * len(numbers)
    top = np.nanmin(numbers) if column.better == "low" else np.nanmax(numbers)
    won = known & (np.abs(numbers - top) <= _FLOOR * max(1.0, abs(top)))
    return [False] * len(numbers) if won[known].all() else won.tolist()


def _as_float(value: Any) -> float:
    return float(value) if isinstance(value, (int, float, np.number)) else np.nan


def cell(written: str, is_best: bool) -> Markup | str:
    """Return a cell; a best value has a star, a frame and bold figures."""
    if not is_best:
        return written
    star = tag("span", "★", aria_hidden="true")
    return tag(
        "span", star, join(" ", written), tag("span", " (best)", class_="unseen"), class_="best"
    )
