"""A path of steps over uneven ground, and the search for the best one.

What is least is the energy of all steps, with what the rover draws whether or not it moves:

    cost of a step = E + P (t_pause + t_step)
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from nullmotion.errors import InputError
from nullmotion.rover.path_cost import StepCost
from nullmotion.rover.path_graph import StepGraph, slopes, step_graph
from nullmotion.rover.path_lattice import Lattice, steps_between
from nullmotion.rover.path_refusal import apart, unusable
from nullmotion.rover.path_search import Found, Progress, shortest
from nullmotion.rover.terrain import HeightField

Way = tuple[np.ndarray, np.ndarray]
STEEPEST = math.atan(math.sqrt(2))  # a tetrahedron falls over its edge beyond [rad], Table 8


@dataclass(frozen=True, eq=False)
class Path:
    """Steps from one footprint to another; n steps.

    Attributes:
        cells: Cells of the lattice, (n + 1, 3).
        corners: Footprints on the ground, counter-clockwise [m], (n + 1, 3, 3).
        feet: Which spike stands on each corner, (n + 1, 3).
        left: Which corner each step leaves, (n,).
        pitch: Slope under the rover in the direction of each step [rad], (n,).
        cross: Slope along the edge of each step [rad], (n,).
        energy: Energy of each step [J], (n,).
        time: Duration of each step [s], (n,).
        margin: Torque to spare in each step [N m], (n,).
        cost: What was made least: energy with the upkeep [J].
        expanded: Footprints that were looked at.
    """

    cells: np.ndarray
    corners: np.ndarray
    feet: np.ndarray
    left: np.ndarray
    pitch: np.ndarray
    cross: np.ndarray
    energy: np.ndarray
    time: np.ndarray
    margin: np.ndarray
    cost: float
    expanded: int

    @property
    def edges(self) -> np.ndarray:
        """Spikes (a, b) about which each step turns, (n, 2)."""
        steps = np.arange(len(self.left))
        return np.column_stack([self.feet[steps, (self.left + k) % 3] for k in (1, 2)])

    @property
    def middles(self) -> np.ndarray:
        """Middles of the footprints [m], (n + 1, 3)."""
        return self.corners.mean(axis=1)

    @property
    def length(self) -> float:
        """Way of the footprints' middles [m]."""
        return float(np.linalg.norm(np.diff(self.middles, axis=0), axis=1).sum())


def find_path(
    field: HeightField,
    lattice: Lattice,
    cost: StepCost,
    goal: tuple[float, float],
    *,
    within: float = 0.0,
    power: float = 0.0,
    pause: float = 0.0,
    steepest: float = STEEPEST,
    barred: Iterable[Way] = (),
    progress: Progress | None = None,
) -> Path:
    """Return the best path from the lattice's first cell (0, 0, 0) to a goal.

    Args:
        field: The ground.
        lattice: Where the spikes can come to stand.
        cost: What a step costs.
        goal: Where to go, (x, y) [m]: the cell that holds it.
        within: Distance of a footprint's middle from the goal that is good enough [m].
        power: Drawn all the time [W].
        pause: Rest before each step [s].
        steepest: Slope towards an edge beyond which the rover falls over it [rad].
        barred: Steps that must not be made: middles of the footprints before and after, (x, y).
        progress: Called with the share of the way that has been searched.

    Raises:
        InputError: For a start or goal that the rover cannot stand on or reach.
    """
    graph = step_graph(field, lattice, cost, steepest)
    first = np.zeros(3, int)
    start = _standing(graph, first, "start", lattice.middles(first))
    goals = np.linalg.norm(lattice.middles(graph.cells) - goal, axis=1) <= within
    held = graph.number(lattice.cell_at(goal))
    if held >= 0:
        goals[held] = True
    goals &= graph.stays
    if not goals.any():
        raise InputError("mission.goal_m", list(goal), unusable(graph, held, "goal"))
    least = steps_between(graph.cells, graph.cells[goals])
    weights = graph.steps.energy + power * (pause + graph.steps.time)
    for way in barred:
        weights[graph.step_near(*way)] = np.inf
    found = shortest(graph.following, weights, start, goals, least, progress)
    if not found.nodes:
        raise InputError("mission.goal_m", list(goal), apart(graph, found, goal))
    return _path(field, graph, found)


def _standing(graph: StepGraph, cell: np.ndarray, what: str, at: np.ndarray) -> int:
    number = graph.number(cell)
    if number < 0 or not graph.stays[number]:
        raise InputError(f"mission.{what}_m", at.tolist(), unusable(graph, number, what))
    return number


def _path(field: HeightField, graph: StepGraph, found: Found) -> Path:
    nodes = np.array(found.nodes)
    at, lattice = nodes[:-1], graph.lattice
    cells = graph.cells[nodes]
    left = np.argmax(graph.following[at] == nodes[1:, None], axis=1)
    corners = field.points(lattice.corners(cells))
    cross = slopes(corners)[1]
    energy, time, margin = (values[at, left] for values in graph.steps)
    return Path(
        cells,
        corners,
        lattice.feet(cells),
        left,
        graph.pitch[at, left],
        cross[np.arange(len(at)), left],
        energy,
        time,
        margin,
        found.cost,
        found.expanded,
    )
