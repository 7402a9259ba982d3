"""A trip over uneven ground: steps planned on the lattice, rolled on the ground.

The rover's real footprints leave the lattice little by little, since the ground is not even. The
path is searched again from where it stands, on a lattice laid anew, when it is further off than
allowed or when the next step turns out not to be feasible there.
"""

from __future__ import annotations

import math

import numpy as np

from nullmotion.errors import InputError
from nullmotion.rover.chassis import positive
from nullmotion.rover.mission_cost import Upkeep
from nullmotion.rover.path import STEEPEST, find_path
from nullmotion.rover.path_cost import StepCost, StepCosts, StepTable
from nullmotion.rover.path_graph import slopes
from nullmotion.rover.path_kinds import check_tetrahedron
from nullmotion.rover.path_lattice import Lattice
from nullmotion.rover.path_plans import CROSSES, PITCHES, covering, step_table
from nullmotion.rover.path_search import Progress
from nullmotion.rover.path_tour import Tour
from nullmotion.rover.path_travel import Travel
from nullmotion.rover.rover import MARS, Rover
from nullmotion.rover.terrain import HeightField
from nullmotion.spacecraft.body import checked_vector

DRIFT = 0.25  # of the edge length: how far a spike may stand from its lattice point
_PLANNING = 0.95  # share of the work that planning steps is
_SLACK = math.radians(3.0)  # by how much real footprints may be steeper than the lattice's


def travel(
    field: HeightField,
    rover: Rover,
    start: tuple[float, float],
    goal: tuple[float, float],
    *,
    gravity: float = MARS,
    heading: float | None = None,
    within: float = 0.0,
    upkeep: Upkeep | None = None,
    cost: StepCost | None = None,
    drift: float = DRIFT,
    progress: Progress | None = None,
) -> Travel:
    """Roll a rover over the ground from a start to a goal, on the path that takes least energy.

    Args:
        field: The ground.
        rover: A tetrahedron with a CMG.
        start: Middle of the first footprint, (x, y) [m].
        goal: Where to go, (x, y) [m].
        gravity: g [m/s^2].
        heading: Of the first edge, from +x towards +y [rad]; towards the goal by default.
        within: Distance of a footprint's middle from the goal that is good enough [m]; the
            footprint that holds the goal always is.
        upkeep: What the rotor takes beside the steps; that of the rover by default.
        cost: What a step costs; planned steps (`step_table`) by default.
        drift: How far a spike may stand from its lattice point, over the edge length.
        progress: Called with the finished share. What it raises, and Ctrl-C, ends the work;
            steps that were planned are kept.

    Returns:
        The trip.

    Raises:
        InputError: For a start or goal that the rover cannot stand on or reach.
    """
    size, care = check_tetrahedron(rover.chassis), upkeep or Upkeep.of(rover)
    for key, place in (("start", start), ("goal", goal)):
        checked_vector(f"mission.{key}_m", place, 2)
    positive("gravity", gravity)
    if not drift > 0:
        raise InputError("mission.drift", drift, "a number above 0")
    turn = math.atan2(goal[1] - start[1], goal[0] - start[0]) if heading is None else heading
    lattice = Lattice.laid(size, start, turn, field.mean_normal())
    find_path(field, lattice, _any_step, goal, within=within)  # refuses before the long work
    planning = _part(progress, 0.0, _PLANNING) if cost is None else None
    table = cost or table_for(field, lattice, rover, gravity, planning)
    tour = Tour(field, lattice, table, size, care)
    tour.go(goal, within, drift * size, _part(progress, 0.0 if cost else _PLANNING, 1.0))
    if progress:
        progress(1.0)
    return _travel(goal, rover.mass, tour)


def table_for(
    field: HeightField,
    lattice: Lattice,
    rover: Rover,
    gravity: float,
    progress: Progress | None = None,
) -> StepTable:
    """Return planned steps at the slopes that a ground has where a rover can stand."""
    ways = slopes(field.points(lattice.corners(lattice.cells_on(field))))
    stays = (ways[0] > -STEEPEST).all(axis=1)
    pitch, cross = (float(np.abs(way[stays]).max(initial=0.0)) + _SLACK for way in ways)
    up, across = covering(pitch, PITCHES), covering(cross, CROSSES)
    return step_table(rover, gravity, up, across, progress=progress)


def _travel(goal: tuple[float, float], mass: float, tour: Tour) -> Travel:
    """Return what is kept of a trip."""
    stances = [tour.first, *(step.after for step in tour.steps)]
    corners, feet = (np.array(values) for values in zip(*stances, strict=True))
    numbers = np.array([step[2:] for step in tour.steps]).reshape(-1, 6).T
    turn, pitch, cross, energy, time, margin = numbers
    return Travel(
        goal,
        mass,
        tour.upkeep,
        tour.paths[0],
        corners,
        feet,
        np.array([step.left for step in tour.steps], int),
        turn,
        pitch,
        cross,
        energy,
        time,
        margin,
        tour.off,
        len(tour.paths),
    )


def _any_step(a: np.ndarray, b: np.ndarray, pitch: np.ndarray, cross: np.ndarray) -> StepCosts:
    """Return a cost at which every step can be made."""
    one = np.ones(np.shape(pitch))
    return StepCosts(one, one, one)


def _part(progress: Progress | None, first: float, last: float) -> Progress | None:
    """Return what reports a part of the work, never less than before."""
    if progress is None:
        return None
    most = first

    def report(share: float) -> None:
        nonlocal most
        most = max(most, first + (last - first) * min(share, 1.0))
        progress(most)

    return report
