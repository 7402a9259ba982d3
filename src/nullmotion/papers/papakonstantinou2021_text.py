"""The figures printed in the text of Papakonstantinou et al. 2021."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from nullmotion.papers.base import Cell, Value
from nullmotion.papers.papakonstantinou2021_cases import Manoeuvre
from nullmotion.papers.papakonstantinou2021_flight import Flight, crossing
from nullmotion.papers.papakonstantinou2021_table1 import words
from nullmotion.papers.papakonstantinou2021_tables import Flights, percent

Line = tuple[str, Value, Any, float, str]  # column, published, computed, tolerance, note

_LAST = 69  # row of t = 6.9 s, the last sample of the paper's "7 s"
_END = "at t = 6.9 s, the last of 70 samples"
_STUCK = "where w is least"
_SAMPLE = 0.1  # [s], to which times are read off a chart
_LEAVES = "leaves evaluated"
_OFF_AXIS = "with yaw and pitch errors as third term; with roll as well {:.4f}"
_ALL_AXES = "with yaw, pitch and roll errors as third term; without roll {:+.2f} %"
_NINE = "the paper prints nine numbers: one zero is lost"
_OTHER = "the search as the paper describes it ends elsewhere"
_PRINTED_L = "with the printed L"


def cells(runs: Mapping[str, Manoeuvre], flights: Mapping[str, Flights]) -> list[Cell]:
    """Return the figures printed in the text."""
    roll, three, kinematic = (runs[name] for name in ("roll", "three-axis", "kinematic"))
    lines = {
        "singular state of Eq 26": _singular_state(kinematic),
        "roll, SRI": _roll(flights["roll"]["none"]),
        "roll, search": [*_search(roll, 308), *_roll_search(flights["roll"])],
        "three-axis, SRI": _three_axis(flights["three-axis"]["none"]),
        "three-axis, search": [*_search(three, None, _NINE), _gain(flights["three-axis"], 103.4)],
        "kinematic, SRI": _kinematic(flights["kinematic"]["none"]),
        "kinematic, search": [
            *_search(kinematic, 284, _OTHER),
            *_kinematic_search(flights["kinematic"]["paper"]),
        ],
    }
    return [
        Cell("text", row, column, value, _plain(ours), tolerance, "inferred", note)
        for row, found in lines.items()
        for column, value, ours, tolerance, note in found
    ]


def _plain(value: Any) -> Value:
    return value if isinstance(value, str) else float(value)


def _singular_state(run: Manoeuvre) -> Iterable[Line]:
    """E = diag(u . h_i) and the eigenvalues of M = N^T E N at [-90, 0, 90, 0] deg."""
    array, delta, u = run.setup.array, np.radians([-90.0, 0.0, 90.0, 0.0]), np.eye(3)[0]
    h = array.spin_axes.T * np.cos(delta) + array.transverse_axes.T * np.sin(delta)
    null = np.linalg.svd(array.jacobian(delta))[2][2:].T
    found = [*(u @ h), *np.linalg.eigvalsh(null.T @ np.diag(u @ h) @ null)[::-1]]
    printed = {"E_1": 0.5774, "E_2": -1, "E_3": 0.5774, "E_4": 1, "M_1": 0.5774, "M_2": 0.1444}
    for (column, value), ours in zip(printed.items(), found, strict=True):
        yield column, float(value), ours, 1e-4, "eigenvalue of M" if column[0] == "M" else ""


def _roll(run: Flight) -> Iterable[Line]:
    yaw, pitch, _ = np.degrees(run.greatest_errors)
    stuck = run.run.momentum[int(np.argmin(run.manipulability)), 0]
    full = run.t[:-1][run.saturated[:, 1]]
    terms, note = run.terms, _OFF_AXIS.format(run.terms.value(run.cost))
    yield "cost", 0.129, terms.value(run.cost, off_axis=True), 5e-4, note
    yield "roll_angle_deg", -86.25, run.attitude_deg[_LAST, 2], 0.005, _END
    yield "greatest_pitch_error_deg", 18.0, pitch, 0.5, ""
    yield "greatest_yaw_error_deg", 5.0, yaw, 0.5, ""
    yield "stuck_momentum_x_Nms", 1.15, stuck, 0.01, _STUCK
    yield "final_manipulability", 0.609, run.manipulability[_LAST], 5e-4, _END
    yield "gimbal_2_saturated_from_time_s", 2.0, full[0], 0.05, ""
    yield "gimbal_2_saturated_to_time_s", 3.3, full[-1], 0.05, ""


def _roll_search(flights: Flights) -> Iterable[Line]:
    run = flights["paper"]
    torque = -run.run.torque[:, 0]  # on the vehicle
    turn = int(np.argmax((torque[:-1] < 0) & (torque[1:] >= 0)))
    yield _gain(flights, 99.3)
    yield "roll_angle_deg", -87.7, run.attitude_deg[_LAST, 2], 0.05, _END
    yield "torque_turns_time_s", 2.2, crossing(run.t, torque, 0.0, turn), _SAMPLE, ""


def _gain(flights: Flights, printed: float) -> Line:
    all_axes, off_axis = (
        percent(
            *(flights[what].terms.value(flights[what].cost, only) for what in ("none", "paper"))
        )
        for only in (False, True)
    )
    return "cost_gain_percent", printed, all_axes, 0.05, _ALL_AXES.format(off_axis)


def _three_axis(run: Flight) -> Iterable[Line]:
    top = int(np.argmax(run.manipulability))
    yield "peak_manipulability_time_s", 1.6, run.t[top], 0.05, "from then on w falls"
    yield "low_manipulability_time_s", 4.1, run.first_below(top), _SAMPLE, ""


def _kinematic(run: Flight) -> Iterable[Line]:
    yield "low_manipulability_time_s", 1.2, run.first_below(), _SAMPLE, ""
    yield "final_momentum_x_Nms", 1.15, run.run.momentum[_LAST, 0], 0.01, _END
    yield "final_momentum_error_x_Nms", 0.35, run.momentum_error[_LAST, 0], 0.01, _END
    yield "final_gimbal_deg", "[-90, 0, 90, 0]", words(np.degrees(run.run.delta[_LAST]), 0), 0, ""


def _kinematic_search(run: Flight) -> Iterable[Line]:
    least = 1 + int(np.argmin(run.manipulability[1:_LAST]))
    yield "least_manipulability_time_s", 2.1, run.t[least], 0.05, _PRINTED_L
    yield "interpolated_values", 70.0, len(run.t) - 1, 0.0, ""


def _search(run: Manoeuvre, expansions: int | None, note: str = "") -> Iterable[Line]:
    evaluated = run.heuristic.certificate["leaves_evaluated"]
    printed = words(run.case.printed or run.case.course)
    yield "L", printed, words(run.heuristic_course), 0.0, note
    if expansions is not None:
        yield "expansions", float(expansions), evaluated, 0.0, note or _LEAVES
