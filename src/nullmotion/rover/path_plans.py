"""The table of step costs that the step planner fills.

One step of each kind is planned at each of some slopes, as far as the ground needs them. Downhill
steps are the uphill ones run backwards (from the other face, with the rotor turned about: the
kind stays the same), and a slope along the edge counts by its size (reflection across the edge),
so that only slopes from 0 on are planned. What is slow is done once: see `path_store`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from itertools import product

import numpy as np

from nullmotion.errors import InputError
from nullmotion.rover.path_cost import PlannedStep, StepTable
from nullmotion.rover.path_kinds import kinds
from nullmotion.rover.path_store import StepStore
from nullmotion.rover.rover import MARS, Rover, Site
from nullmotion.rover.wheels import stays_around

Progress = Callable[[float], None]
# a step over an edge, from a face, at a pitch and cross slope; None if there is no such step
StepPlanner = Callable[[int, int, float, float, Progress | None], PlannedStep | None]

PITCHES = np.radians([0.0, 15.0, 30.0, 45.0, 54.0])
CROSSES = np.radians([0.0, 20.0, 40.0])
_NONE = (np.nan, np.nan, np.nan)


def step_table(
    rover: Rover,
    gravity: float = MARS,
    pitches: Iterable[float] = PITCHES,
    crosses: Iterable[float] = CROSSES[:1],
    *,
    plan: StepPlanner | None = None,
    store: StepStore | None = None,
    least_margin: float = 0.0,
    progress: Progress | None = None,
) -> StepTable:
    """Return what the steps of a rover cost.

    Args:
        rover: A tetrahedron with a CMG.
        gravity: g [m/s^2].
        pitches: Slopes in the direction of the step at which steps are planned, up and down
            [rad], from 0 on.
        crosses: The same along the edge.
        plan: Plans one step; `plan_step` by default.
        store: Where planned steps are kept; in the user's cache by default.
        least_margin: Margin below which a step is refused [N m].
        progress: Called with the finished share.

    Raises:
        InputError: For a chassis that is no regular tetrahedron, or slopes that are no slopes.
    """
    found = kinds(rover)
    along, across = _slopes("pitches", pitches), _slopes("crosses", crosses)
    kept = StepStore.of(rover, gravity) if store is None else store
    make = planner(rover, gravity) if plan is None else plan
    wanted = [(*step, x, y) for step, x, y in product(found.examples, along, across)]
    for done, step in enumerate(wanted):
        if not kept.has(*step):
            kept.put(*step, make(*step, _part(progress, done, len(wanted))))
        if progress:
            progress((done + 1) / len(wanted))
    values = np.array([kept.get(*step) or _NONE for step in wanted], float)
    up = values.reshape(len(found.examples), len(along), len(across), 3)
    table = np.concatenate([up[:, :0:-1], up], axis=1)
    both = np.concatenate([-along[:0:-1], along])
    moment = rover.mass * gravity * rover.edge_frame(1).com_distance
    energy, time, margin = np.moveaxis(table, -1, 0)
    return StepTable(found.of, both, energy, time, margin, moment, across, least_margin)


def planner(rover: Rover, gravity: float) -> StepPlanner:
    """Return the step planner as `step_table` asks for it.

    No step is looked for where the rover would not stay before or after it.
    """

    def plan(
        edge: int, face: int, pitch: float, cross: float, progress: Progress | None
    ) -> PlannedStep | None:
        from nullmotion.rover.plan_error import PlanError
        from nullmotion.rover.planner import plan_step

        place = site(gravity, pitch, cross)
        if not stays_around(rover.chassis, rover.edge_frame(edge, face), place):
            return None
        try:
            found = plan_step(rover, edge, place, face, progress=progress)
        except PlanError:
            return None
        return PlannedStep(found.energy, found.duration, found.least_margin)

    return plan


def site(gravity: float, pitch: float, cross: float) -> Site:
    """Return the site that has a slope in the direction of a step and along its edge [rad]."""
    f, r, p = np.cos(cross) * np.sin(pitch), np.sin(cross), np.cos(cross) * np.cos(pitch)
    return Site(gravity, float(np.arctan2(np.hypot(f, r), p)), float(np.arctan2(r, f)))


def covering(greatest: float, slopes: np.ndarray) -> np.ndarray:
    """Return as many of some slopes as it takes to pass a greatest one [rad]."""
    return slopes[: int(np.searchsorted(slopes, greatest)) + 1]


def _slopes(key: str, values: Iterable[float]) -> np.ndarray:
    found = np.unique(np.asarray(list(values), float))
    if not len(found) or found[0] != 0 or not found[-1] < np.pi / 2:
        raise InputError(f"rover.{key}", found.tolist(), "0 and slopes up to 90 deg")
    return found


def _part(progress: Progress | None, done: int, count: int) -> Progress | None:
    return progress and (lambda share: progress((done + share) / count))
