"""A step in numbers: plan, closed loop and landing side by side."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from nullmotion.report.markup import Markup, tag
from nullmotion.report.rover_step_panels import OnGround
from nullmotion.report.tables import table
from nullmotion.report.wording import number

Column = tuple[str, Any]


def number_table(plan: Any, run: Any, landing: Any) -> Markup:
    """Return the numbers of plan, run and landing side by side, None where there is none."""
    columns: list[Column] = [("plan", plan)]
    if run is not None:
        columns.append(("closed loop", run))
    if landing is not None:
        columns.append(("on the ground", landing))
    rows = [
        (name, *(_value(step, read) for _, step in columns), _unit(unit))
        for name, unit, read in ROWS
    ]
    head = ("Quantity", *(name for name, _ in columns), "Unit")
    said = [entry for entry in rows if set(entry[1:-1]) != {"–"}]
    return table(head, said, "The step in numbers", range(1, len(columns) + 1), wide=True)


def _unit(name: str) -> Markup:
    return tag("span", name, class_="unit")


def _value(step: Any, read: Callable[[Any], float]) -> str:
    try:
        return number(read(step), 4)
    except AttributeError:
        return "–"


def _largest(key: str) -> Callable[[Any], float]:
    def read(step: Any) -> float:
        source = OnGround(step) if hasattr(step, "signals") else step
        return float(np.degrees(np.abs(getattr(source, key)).max()))

    return read


ROWS: Sequence[tuple[str, str, Callable[[Any], float]]] = (
    ("Time", "s", lambda s: s.landed_at if hasattr(s, "landed_at") else float(s.t[-1])),
    ("Energy of the motors", "J", lambda s: s.energy),
    ("Cost of travel", "J/(kg m)", lambda s: s.cost_of_travel),
    ("Least margin", "N m", lambda s: s.least_margin),
    ("Least margin at rest", "N m", lambda s: s.least_static_margin),
    ("Largest angle error", "deg", lambda s: float(np.degrees(s.max_angle_error))),
    ("Largest rate of the body", "deg/s", _largest("theta_dot")),
    ("Largest gimbal rate", "deg/s", _largest("delta_dot")),
    ("Largest gimbal acceleration", "deg/s²", _largest("delta_ddot")),
    ("Slip of the edge", "mm", lambda s: 1e3 * s.slip),
    ("Off-axis tilt", "deg", lambda s: float(np.degrees(s.tilt))),
    ("Energy balance", "of the energy used", lambda s: s.energy_balance),
)
