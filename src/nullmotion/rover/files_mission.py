"""Missions from TOML files.

    [mission]
    rover = "peter"                 # a rover file or a name; or [chassis] and [cmg] in this file
    start_m = [2.0, 2.0]
    goal_m = [18.0, 18.0]
    [terrain]
    size_m = 20.0                   # generated from a seed; or file = "heights.csv"
    seed = 1

[chassis] and [cmg] beside ``rover`` are set over the rover's.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from math import radians
from pathlib import Path
from typing import Any

from nullmotion.rover.files_find import find
from nullmotion.rover.files_mission_rover import BODY, rover
from nullmotion.rover.files_mission_schema import MISSION
from nullmotion.rover.files_read import Reader, located
from nullmotion.rover.files_terrain import TERRAIN, terrain
from nullmotion.rover.mission_cost import Upkeep
from nullmotion.rover.rover import Rover
from nullmotion.rover.terrain import HeightField
from nullmotion.scenario.problems import MISSING, Problem, ScenarioError
from nullmotion.scenario.source import Source

_STEP = "a rover without a [mission]: `nullmotion rover plan` and `nullmotion rover run` take it"
_WRITTEN = {f"mission.{key}_m": ("mission", f"{key}_m") for key in ("start", "goal")} | TERRAIN


@dataclass(frozen=True, eq=False)
class MissionFile:
    """A trip as a file has it; SI and radians.

    Attributes:
        source: Text and file.
        title: What it is about.
        rover: The rover.
        gravity: g [m/s^2].
        terrain: The ground.
        start: Middle of the first footprint, (x, y) [m].
        goal: Where to go, (x, y) [m].
        within: Distance from the goal that is good enough [m].
        heading: Of the first edge [rad]; None: towards the goal.
        drift: How far a spike may stand from its lattice point, over the edge length.
        upkeep: What the rotor takes beside the steps.
    """

    source: Source
    title: str
    rover: Rover
    gravity: float
    terrain: HeightField
    start: tuple[float, float]
    goal: tuple[float, float]
    within: float
    heading: float | None
    drift: float
    upkeep: Upkeep

    @property
    def name(self) -> str:
        """Short name: that of the file without its ending."""
        return Path(self.source.name).stem or "mission"

    @contextmanager
    def located(self) -> Iterator[None]:
        """Say file and line in what turns out to be wrong with the trip later."""
        with located(self.source, _WRITTEN):
            yield


def load_mission(
    document: str | Path | MissionFile,
    values: Mapping[str, Any] | None = None,
    origin: str = "--set",
) -> MissionFile:
    """Return a mission, checked.

    Args:
        document: Path of a TOML file, TOML text, or a name of the library.
        values: Values by dotted key, set over the file (``{"terrain.seed": 3}``).
        origin: What messages call those values.

    Raises:
        ScenarioError: For a file that cannot be used: everything that is wrong with it, each with
            key, value, what is allowed, file and line.
        InputError: For a file that cannot be read.
    """
    source = document.source if isinstance(document, MissionFile) else find(document)
    if "mission" not in source.data and "chassis" in source.data:
        raise ScenarioError([Problem("chassis", MISSING, _STEP, source.where(("chassis",)))])
    reader = Reader(source.over(values, origin) if values else source, MISSION, BODY)
    found = _mission_file(reader)
    reader.raise_problems()
    assert found is not None
    return found


def _mission_file(reader: Reader) -> MissionFile | None:
    """Return what a document has, None with problems noted."""
    trip = reader.section("mission", needed=True)
    place, care = reader.section("site"), reader.section("upkeep")
    field = terrain(reader)
    if trip is None:
        return None
    body, gravity = rover(reader, trip.rover)
    if place is None or care is None or body is None or field is None:
        return None
    return MissionFile(
        source=reader.source,
        title=trip.title or Path(reader.source.name).stem,
        rover=body,
        gravity=place.gravity_m_s2 or gravity,
        terrain=field,
        start=trip.start_m,
        goal=trip.goal_m,
        within=trip.within_m,
        heading=None if trip.heading_deg is None else radians(trip.heading_deg),
        drift=trip.drift,
        upkeep=Upkeep.of(body, care.power_W, care.pause_s, care.spin_up_time_s),
    )
