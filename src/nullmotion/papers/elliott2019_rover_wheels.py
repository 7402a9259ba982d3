"""Table 6 of Elliott 2019: energy of a step with reaction wheels, on five inclines."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

from nullmotion.errors import InputError
from nullmotion.papers.base import Cell, Source, Value
from nullmotion.rover.impulsive import impulsive_step
from nullmotion.rover.rover import Site
from nullmotion.rover.versine_wheels import versine_step
from nullmotion.rover.wheels import WheelRover, hedgehog, hypothesised

# incline as printed [deg]: as meant [rad]
INCLINES = {
    **{str(deg): math.radians(deg) for deg in (0, 15, 30, 45)},
    "55": math.atan(math.sqrt(2)),  # the steepest that a tetrahedron stays on
}
PETER = (9.8, 10.5, 9.9, 10.1, 11.3)
IMPULSIVE: dict[str, tuple[float | str, ...]] = {
    "hedgehog": (632.1, 1079.0, 1599.4, 2158.0, "NA"),
    "hypothesized": (1086.1, 1679.7, 2333.9, 3004.2, 3426.2),
}
VERSINE: dict[str, tuple[float | str, ...]] = {
    "hedgehog": (5844.6, 9129.1, 11331.4, 12834.2, "NA"),
    "hypothesized": (11070.3, 16261.0, 19470.4, 20984.0, 21407.6),
}
ROVERS: dict[str, Callable[[], WheelRover]] = {
    "hedgehog": hedgehog,
    "hypothesized": hypothesised,
}
_DIGIT = 0.05
_VERSINE = 1e-3  # share: the paper's come from a simulation whose start is not described
_LENGTH = "L = sqrt(6) 0.25 m (inscribed sphere of the cube); the cube's inertia"


def impulsive_cost(rover: WheelRover, incline: float) -> Value:
    """Return the mean cost of an impulsive step over all edges [J/(kg m)], or NA."""
    return _mean(rover, lambda e: impulsive_step(rover, e, Site(incline=incline)).cost_of_travel)


def versine_cost(rover: WheelRover, incline: float) -> Value:
    """Return the mean cost of a versine step over all edges [J/(kg m)], or NA."""
    return _mean(rover, lambda e: versine_step(rover, e, Site(incline=incline)).cost_of_travel)


def cells(peter: Mapping[str, float] | None = None) -> list[Cell]:
    """Return Table 6.

    Args:
        peter: The CMG rover's mean costs [J/(kg m)] by incline as printed; its column is left
            out without them.
    """
    found = []
    for name, make in ROVERS.items():
        rover, note = make(), _LENGTH if name == "hypothesized" else ""
        for column, printed, cost, tolerance in (
            ("impulsive", IMPULSIVE[name], impulsive_cost, 0.0),
            ("versine", VERSINE[name], versine_cost, _VERSINE),
        ):
            for (row, incline), value in zip(INCLINES.items(), printed, strict=True):
                allowed = 0.0 if isinstance(value, str) else max(_DIGIT, tolerance * value)
                label = f"{name}_{column}_J_kg_m"
                computed = cost(rover, incline)
                source: Source = "inferred" if note else "printed"
                found.append(Cell("6", row, label, value, computed, allowed, source, note))
    return [*_peter(peter or {}), *found]


def _peter(costs: Mapping[str, float]) -> list[Cell]:
    note = "the mean of Table 4 over six edges"
    return [
        Cell("6", row, "peter_J_kg_m", value, costs[row], 0.35 * value, "inferred", note)
        for row, value in zip(INCLINES, PETER, strict=True)
        if row in costs
    ]


def _mean(rover: WheelRover, cost: Callable[[int], float]) -> Value:
    costs = []
    for edge in range(1, len(rover.chassis.edges) + 1):
        try:
            costs.append(cost(edge))
        except InputError:  # it does not stay on this slope
            return "NA"
    return sum(costs) / len(costs)
