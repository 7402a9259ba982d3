"""A mission from its file, and what the same trip costs rovers with reaction wheels.

Both are charged as in Elliott 2019, Table 7: the CMG rover with what its rotor takes all the time,
a wheel rover with impulsive steps, here over the slopes of the trip.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from statistics import fmean
from time import perf_counter

import numpy as np

from nullmotion.errors import InputError
from nullmotion.rover.files_mission import MissionFile
from nullmotion.rover.impulsive import impulsive_step
from nullmotion.rover.interrupt import interruptible
from nullmotion.rover.mission_cost import CmgMission
from nullmotion.rover.path_mission import travel
from nullmotion.rover.path_plans import site
from nullmotion.rover.path_travel import Travel
from nullmotion.rover.watch import Progress
from nullmotion.rover.wheels import WheelRover, hedgehog, hypothesised

DISTANCES = (50.0, 100.0, 1000.0, 10_000.0)  # [m], Table 7


@dataclass(frozen=True)
class WheelTrip:
    """The trip of a rover with wheels over the same slopes.

    Attributes:
        rover: Its name.
        cost_of_travel: Energy per mass and distance [J/(kg m)]; NaN if it cannot make a step.
        refused: Share of the steps on slopes where it would not stay.
        break_even: Distance from which the CMG rover costs less [m]; inf: it never does.
    """

    rover: str
    cost_of_travel: float
    refused: float
    break_even: float


@dataclass(frozen=True, eq=False)
class MissionResult:
    """A mission as it was made.

    Attributes:
        file: What was asked for.
        travel: The trip.
        trips: Longer and shorter trips of the same kind.
        wheels: The same with reaction wheels.
        seconds: How long it took to compute.
    """

    file: MissionFile
    travel: Travel
    trips: CmgMission | None
    wheels: tuple[WheelTrip, ...]
    seconds: float

    def costs(self) -> dict[float, float]:
        """Return the CMG rover's cost of travel [J/(kg m)] by distance [m], upkeep included."""
        trips = self.trips
        return {} if trips is None else {D: trips.cost_of_travel(D) for D in DISTANCES}


def run_mission(file: MissionFile, progress: Progress | None = None) -> MissionResult:
    """Roll a rover from start to goal.

    Args:
        file: The mission.
        progress: Called with the share done, in [0, 1]; what it raises ends the work.

    Raises:
        InputError: For a start or goal that the rover cannot stand on or reach.
    """
    begin = perf_counter()
    with file.located(), interruptible(progress) as told:
        made = travel(
            file.terrain,
            file.rover,
            file.start,
            file.goal,
            gravity=file.gravity,
            heading=file.heading,
            within=file.within,
            upkeep=file.upkeep,
            drift=file.drift,
            progress=told,
        )
    trips = _trips(made) if made.steps else None
    wheels = () if trips is None else tuple(
        wheel_trip(rover, made, trips, file.gravity) for rover in (hedgehog(), hypothesised())
    )  # fmt: skip
    return MissionResult(file, made, trips, wheels, perf_counter() - begin)


def _trips(made: Travel) -> CmgMission:
    """Return trips whose steps cost and take what these do on average."""
    return CmgMission(made.mass, made.step_cost, made.duration / made.distance, made.upkeep)


def wheel_trip(rover: WheelRover, made: Travel, trips: CmgMission, gravity: float) -> WheelTrip:
    """Return what impulsive steps over the slopes of a trip cost a rover with wheels.

    Args:
        rover: The rover.
        made: The trip; each of its slopes counts once.
        trips: Those of the CMG rover.
        gravity: g [m/s^2].
    """
    costs = []
    for pitch, cross in np.column_stack([made.pitch, made.cross]).tolist():
        try:
            step = impulsive_step(rover, 1, site(gravity, pitch, cross))
        except InputError:  # it does not stay there
            continue
        costs.append(step.cost_of_travel)
    cost = fmean(costs) if costs else math.nan
    even = trips.break_even(cost) if costs else math.inf
    return WheelTrip(rover.name, cost, 1 - len(costs) / made.steps, even)
