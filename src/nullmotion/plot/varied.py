"""Metrics of each law over the values of a varied key."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from nullmotion.plot import palette
from nullmotion.plot.quantities import of_attitude, turns_wheels
from nullmotion.plot.view import Curve, Panel


class Varied(NamedTuple):
    """A metric as an ordinate: its key, title, name with unit, factor to this unit, a remark."""

    metric: str
    title: str
    y_title: str
    factor: float = 1.0
    log: bool = False
    note: str = ""


_SHARE, _GAP = "Share of command [%]", "No point where a run did not settle."
VARIED_METRICS = (
    Varied("stopped_at_s", "Time to stop", "Time [s]"),
    Varied("final_momentum_reserve_Nms", "Momentum reserve at the end", "Reserve [N m s]"),
    Varied("max_off_axis_torque_fraction", "Off-axis torque, peak", _SHARE, 100.0),
    Varied("max_along_axis_torque_fraction", "Along-axis torque error, peak", _SHARE, 100.0),
    Varied("max_rate_step_rad_s", "Largest rate step", "Step [rad/s]"),
    Varied("min_sigma_min", "Least sigma_min", "sigma_min [-]"),
)
VARIED_ATTITUDE = (
    Varied("settling_time_s", "Settling time", "Time [s]", note=_GAP),
    Varied("final_pointing_error_deg", "Pointing error at the end", "Error [deg]", log=True),
    Varied("max_motor_torque_Nm", "Largest gimbal motor torque", "Torque [N m]"),
    Varied("rate_saturated_s", "Rate-saturated time", "Time [s]"),
    Varied("min_sigma_min", "Least sigma_min", "sigma_min [-]"),
    Varied("gimbal_travel_rad", "Gimbal travel", "Travel [rad]"),
)
VARIED_WHEELS = (
    *VARIED_ATTITUDE[:2],
    Varied("wheel_settling_s", "Settling time of the wheels", "Time [s]", note=_GAP),
    Varied("final_wheel_speed_error", "Wheel speed error at the end", "Error [%]", 100.0, log=True),
    Varied("max_wheel_torque_Nm", "Largest wheel torque", "Torque [N m]"),
    *VARIED_ATTITUDE[2:],
)


class Series(NamedTuple):
    """One law over the varied value."""

    label: str
    x: np.ndarray
    metrics: dict[str, np.ndarray]


def varied_panels(comparison: Any) -> list[Panel]:
    """Return one chart a metric, one curve a law; empty when nothing was varied."""
    key = getattr(comparison, "varied", None)
    if not key:
        return []
    ticks = tick_names(comparison.cases)
    laws = series(comparison.cases, ticks)
    runs = [case.trajectory for case in comparison.cases]
    attitude = any(of_attitude(run) for run in runs)
    chosen: tuple[Varied, ...] = VARIED_ATTITUDE if attitude else VARIED_METRICS
    if attitude and any(turns_wheels(run) for run in runs):
        chosen = VARIED_WHEELS
    made = [_panel(key, ticks, laws, entry) for entry in chosen]
    return [panel for panel in made if panel.curves]


def tick_names(cases: Sequence[Any]) -> tuple[str, ...]:
    """Return the names of the varied values if these are no numbers; else nothing."""
    values = [case.value for case in cases]
    if all(isinstance(v, (int, float, np.number)) for v in values):
        return ()
    return tuple(dict.fromkeys(str(v) for v in values))


def series(cases: Sequence[Any], ticks: Sequence[str] = ()) -> list[Series]:
    """Return the cases of a varied comparison gathered by label, ascending in value."""
    labels = list(dict.fromkeys(case.label for case in cases))
    return [
        _series(label, [case for case in cases if case.label == label], ticks) for label in labels
    ]


def _series(label: str, cases: Sequence[Any], ticks: Sequence[str]) -> Series:
    x = np.array([ticks.index(str(case.value)) if ticks else case.value for case in cases], float)
    order = np.argsort(x, kind="stable")
    names = {name for case in cases for name in case.metrics}
    columns = {
        name: np.array([_number(case.metrics.get(name)) for case in cases]) for name in names
    }
    return Series(label, x[order], {name: column[order] for name, column in columns.items()})


def _number(value: Any) -> float:
    return float(value) if isinstance(value, (int, float, np.number)) else np.nan


def _panel(key: str, ticks: tuple[str, ...], laws: Sequence[Series], what: Varied) -> Panel:
    curves = tuple(
        Curve(
            law.label,
            law.x,
            what.factor * law.metrics[what.metric],
            palette.colour(i),
            palette.dash(i),
            marker=len(law.x) <= 30,
        )
        for i, law in enumerate(laws)
        if what.metric in law.metrics and np.isfinite(law.metrics[what.metric]).any()
    )
    name = f"varied_{what.metric}"
    return Panel(
        name, what.title, what.y_title, curves, (), what.note, key, ticks=ticks, log=what.log
    )
