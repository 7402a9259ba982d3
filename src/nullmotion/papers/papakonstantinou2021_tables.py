"""Tables 2 to 4 of Papakonstantinou et al. 2021: what the planned null motion changes."""

from __future__ import annotations

from collections.abc import Mapping

from nullmotion.papers.base import Cell
from nullmotion.papers.papakonstantinou2021_flight import Flight

Flights = Mapping[str, Flight]  # of one manoeuvre: "none", "paper", "optimum"

ROWS = ("mean_manipulability", "time_low_manipulability", "greatest_error", "time_rate_excess")
PRINTED = {
    "2": ("roll", (85.1, -50.0, 7.5, 47.1)),
    "3": ("three-axis", (67.0, -90.3, 0.0, 114.3)),
    "4": ("kinematic", (411.0, -60.0, 0.64, 235.7)),
}
_TOLERANCES = {("4", "greatest_error"): 0.005}
_TOLERANCE = 0.05  # half of the last printed digit

_OFF_AXIS = "norm of the greatest yaw and pitch errors; with roll as well {:+.2f} %"
_ALL_AXES = "norm of the greatest yaw, pitch and roll errors"
_MOMENTUM = "norm of the greatest parts of h_c - h along x, y and z"
_LOW = "does not come back: {} samples below 0.5 become {}"
_DET = "mean of det(A A^T) without the root"


def cells(flights: Mapping[str, Flights]) -> list[Cell]:
    """Return Tables 2 to 4."""
    found = []
    for table, (case, printed) in PRINTED.items():
        changes = _changes(flights[case], off_axis=table == "2")
        notes = _notes(table, flights[case])
        for row, value, ours in zip(ROWS, printed, changes, strict=True):
            tolerance = _TOLERANCES.get((table, row), _TOLERANCE)
            note = notes.get(row, "")
            found.append(
                Cell(table, row, "change_percent", value, ours, tolerance, "inferred", note)
            )
    return found


def percent(before: float, after: float) -> float:
    """Return a change in percent."""
    return 100.0 * (after - before) / before


def _changes(flights: Flights, off_axis: bool) -> tuple[float, ...]:
    before, after = flights["none"].terms, flights["paper"].terms
    return (
        percent(before.mean, after.mean),
        percent(before.low, after.low),
        percent(before.off_axis, after.off_axis) if off_axis else _error(flights),
        percent(before.excess, after.excess),
    )


def _error(flights: Flights) -> float:
    return percent(flights["none"].terms.error, flights["paper"].terms.error)


def _notes(table: str, flights: Flights) -> dict[str, str]:
    before, after = flights["none"].terms, flights["paper"].terms
    if table == "2":
        return {"greatest_error": _OFF_AXIS.format(_error(flights))}
    if table == "3":
        return {"greatest_error": f"printed as about 0; {_ALL_AXES}"}
    return {
        "mean_manipulability": _DET,
        "time_low_manipulability": _LOW.format(before.low, after.low),
        "greatest_error": _MOMENTUM,
    }
