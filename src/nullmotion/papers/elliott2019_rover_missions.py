"""Table 7 of Elliott 2019: cost of travel over five distances."""

from __future__ import annotations

from statistics import fmean

from nullmotion.papers.base import Cell, Source
from nullmotion.papers.elliott2019_rover_wheels import INCLINES, PETER, ROVERS, impulsive_cost
from nullmotion.rover.mission_cost import CmgMission, Upkeep
from nullmotion.rover.rover import peter

# row: distance [m] and PETER's cost [J/(kg m)]
MISSIONS = {"50": 2038.1, "78": 1367.1, "100": 1109.7, "1000": 273.5, "10000": 190.0}
WHEELS = {"hedgehog": 1367.1, "hypothesized": 2306.0}
PACE = 160.17  # (60 s + t)/d [s/m]: neither t nor d is printed
_DIGIT = 0.05
_PETER = 5e-4  # share
_NOTE = "(60 s + t)/d = 160.17 s/m from the table itself"
_EQUAL = 78.28  # [m]: what the row of 78 m is computed with


def mission() -> CmgMission:
    """Return PETER's missions as Table 7 has them."""
    rover = peter()
    return CmgMission(rover.mass, fmean(PETER), PACE, Upkeep.of(rover))


def mean_costs() -> dict[str, float]:
    """Return the wheel rovers' costs: means of Table 6's impulsive columns [J/(kg m)]."""
    found = {}
    for name, make in ROVERS.items():
        costs = [impulsive_cost(make(), incline) for incline in INCLINES.values()]
        found[name] = fmean(c for c in costs if isinstance(c, float))
    return found


def cells() -> list[Cell]:
    """Return Table 7, and where PETER and Hedgehog cost the same."""
    trips, others = mission(), mean_costs()
    even = trips.break_even(others["hedgehog"])
    found = []
    for row, value in MISSIONS.items():
        distance = _EQUAL if row == "78" else float(row)
        note = f"{_NOTE}; D = {_EQUAL} m" if row == "78" else _NOTE
        cost = trips.cost_of_travel(distance)
        found.append(Cell("7", row, "peter_J_kg_m", value, cost, _PETER * value, "fitted", note))
        for name, printed in WHEELS.items():
            source: Source = "inferred" if name == "hypothesized" else "printed"
            label = f"{name}_J_kg_m"
            found.append(Cell("7", row, label, printed, others[name], _DIGIT, source))
    found.append(Cell("text", "equal cost", "distance_m", 78.0, even, 0.5, "fitted", _NOTE))
    return found
