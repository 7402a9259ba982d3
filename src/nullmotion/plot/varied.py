"""Metrics of each law over the values of a varied key."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from nullmotion.plot import palette
from nullmotion.plot.view import Curve, Panel

# metric, title, unit on the axis, factor to that unit
VARIED_METRICS = (
    ("stopped_at_s", "Time to stop", "s", 1.0),
    ("final_momentum_reserve_Nms", "Momentum reserve at the end", "N m s", 1.0),
    ("max_off_axis_torque_fraction", "Off-axis torque, peak", "% of command", 100.0),
    ("max_along_axis_torque_fraction", "Along-axis torque error, peak", "% of command", 100.0),
    ("max_rate_step_rad_s", "Largest rate step", "rad/s", 1.0),
    ("min_sigma_min", "Least sigma_min", "-", 1.0),
)


class Series(NamedTuple):
    """One law over the varied value."""

    label: str
    values: np.ndarray
    metrics: dict[str, np.ndarray]


def varied_panels(comparison: Any) -> list[Panel]:
    """Return one chart a metric, one curve a law; empty when nothing was varied."""
    key = getattr(comparison, "varied", None)
    if not key:
        return []
    laws = series(comparison.cases)
    made = [_panel(key, laws, *entry) for entry in VARIED_METRICS]
    return [panel for panel in made if panel.curves]


def series(cases: Sequence[Any]) -> list[Series]:
    """Return the cases of a varied comparison gathered by label, ascending in value."""
    labels = list(dict.fromkeys(case.label for case in cases))
    return [_series(label, [case for case in cases if case.label == label]) for label in labels]


def _series(label: str, cases: Sequence[Any]) -> Series:
    ordered = sorted(cases, key=lambda case: case.value)
    names = {name for case in ordered for name in case.metrics}
    return Series(
        label,
        np.array([case.value for case in ordered], float),
        {name: np.array([_number(case.metrics.get(name)) for case in ordered]) for name in names},
    )


def _number(value: Any) -> float:
    return float(value) if isinstance(value, (int, float, np.number)) else np.nan


def _panel(key: str, laws: Sequence[Series], metric: str, title: str, unit: str, factor: float) -> Panel:
    curves = tuple(
        Curve(
            law.label, law.values, factor * law.metrics[metric],
            palette.colour(i), palette.dash(i), marker=len(law.values) <= 30,
        )
        for i, law in enumerate(laws)
        if metric in law.metrics and np.isfinite(law.metrics[metric]).any()
    )
    return Panel(f"varied_{metric}", title, f"{title} [{unit}]", curves, x_title=key)
