"""Metrics of each law over the values of a varied key."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from nullmotion.plot import palette
from nullmotion.plot.view import Curve, Panel

# metric, title, ordinate, factor to its unit
VARIED_METRICS = (
    ("stopped_at_s", "Time to stop", "Time [s]", 1.0),
    ("final_momentum_reserve_Nms", "Momentum reserve at the end", "Reserve [N m s]", 1.0),
    ("max_off_axis_torque_fraction", "Off-axis torque, peak", "Share of command [%]", 100.0),
    (
        "max_along_axis_torque_fraction",
        "Along-axis torque error, peak",
        "Share of command [%]",
        100.0,
    ),
    ("max_rate_step_rad_s", "Largest rate step", "Step [rad/s]", 1.0),
    ("min_sigma_min", "Least sigma_min", "sigma_min [-]", 1.0),
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
    made = [_panel(key, ticks, laws, *entry) for entry in VARIED_METRICS]
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


def _panel(
    key: str,
    ticks: tuple[str, ...],
    laws: Sequence[Series],
    metric: str,
    title: str,
    y_title: str,
    factor: float,
) -> Panel:
    curves = tuple(
        Curve(
            law.label,
            law.x,
            factor * law.metrics[metric],
            palette.colour(i),
            palette.dash(i),
            marker=len(law.x) <= 30,
        )
        for i, law in enumerate(laws)
        if metric in law.metrics and np.isfinite(law.metrics[metric]).any()
    )
    return Panel(f"varied_{metric}", title, y_title, curves, x_title=key, ticks=ticks)
