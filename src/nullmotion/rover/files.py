"""Rovers, steps and missions from TOML files, or by their names in the library.

    [chassis]                       # a platonic solid of uniform density, or vertices_m
    shape = "tetrahedron"
    edge_length_m = 1.0
    mass_kg = 47.0
    [cmg]                           # or [wheels]: three reaction wheels
    momentum_Nms = 115.0
    rate_limit_rad_s = 2.0
    acceleration_limit_rad_s2 = 20.0
    [site]
    incline_deg = 15.0
    [step]
    edge = 1

`[planner]`, `[control]`, `[initial]` and `[ground]` have defaults: see `files_schema`. A mission
file has `[mission]` and `[terrain]`, and names its rover or holds it: see `files_mission`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from math import radians
from pathlib import Path
from typing import Any

from nullmotion.rover import files_objects as objects
from nullmotion.rover.files_find import find, library_names
from nullmotion.rover.files_read import Reader, located
from nullmotion.rover.files_schema import ROVER
from nullmotion.rover.ground import Ground
from nullmotion.rover.rover import Rover, Site
from nullmotion.rover.settings import Settings
from nullmotion.rover.tracking import Gains
from nullmotion.rover.wheels import WheelRover
from nullmotion.scenario.problems import MISSING, Problem, ScenarioError
from nullmotion.scenario.source import Source

__all__ = ["StepFile", "library_names", "load_step"]

_MISSION = "a mission, not a step: `nullmotion rover mission` runs it"
_WRITTEN = {
    "edge": ("step", "edge"),
    "face": ("step", "face"),
    "incline": ("site", "incline_deg"),
    "incline_deg": ("site", "incline_deg"),
    "share": ("initial", "threshold_share"),
}


@dataclass(frozen=True, eq=False)
class StepFile:
    """A rover and a step, as a file has them; SI and radians.

    Attributes:
        source: Text and file.
        title: What it is about.
        rover: The rover.
        site: Gravity and slope.
        edge: Edge of the step, from 1.
        face: Face on the ground before it; None: the lower number of the two.
        motion: ``planned``, or ``versine``.
        versine_rate: Greatest rate of the body in a versine [rad/s].
        settings: The planner's.
        gains: Those of the tracking controller.
        ground: Where it lands.
        initial_gimbal: Where the gimbal is before the step [rad]; None: where the step starts.
        threshold_share: Share of the static threshold that may be used on the way from there.
    """

    source: Source
    title: str
    rover: Rover | WheelRover
    site: Site
    edge: int
    face: int | None
    motion: str
    versine_rate: float
    settings: Settings
    gains: Gains
    ground: Ground
    initial_gimbal: float | None
    threshold_share: float

    @property
    def name(self) -> str:
        """Short name: that of the file without its ending."""
        return Path(self.source.name).stem or "rover"

    @contextmanager
    def located(self) -> Iterator[None]:
        """Say file and line in what turns out to be wrong with the step later."""
        with located(self.source, _WRITTEN):
            yield


def load_step(
    document: str | Path | StepFile,
    values: Mapping[str, Any] | None = None,
    origin: str = "--set",
) -> StepFile:
    """Return a rover and its step, checked.

    Args:
        document: Path of a TOML file, TOML text, or a name of the library.
        values: Values by dotted key, set over the file (``{"site.incline_deg": 15.0}``).
        origin: What messages call those values.

    Raises:
        ScenarioError: For a file that cannot be used: everything that is wrong with it, each with
            key, value, what is allowed, file and line.
        InputError: For a file that cannot be read.
    """
    source = document.source if isinstance(document, StepFile) else find(document)
    if "mission" in source.data:
        raise ScenarioError([Problem("mission", MISSING, _MISSION, source.where(("mission",)))])
    reader = Reader(source.over(values, origin) if values else source, ROVER)
    found = _step_file(reader)
    reader.raise_problems()
    assert found is not None
    return found


def _step_file(reader: Reader) -> StepFile | None:
    """Return what a document has, None with problems noted."""
    names = ["rover", "site", "step", "control", *(["initial"] if reader.given("initial") else [])]
    sections = {name: reader.section(name) for name in names}
    stem = Path(reader.source.name).stem
    rover = objects.rover(reader, getattr(sections["rover"], "name", "") or stem)
    settings, ground = objects.settings(reader), objects.ground(reader)
    if None in sections.values() or rover is None or settings is None or ground is None:
        return None
    about, place, step, control = (sections[name] for name in names[:4])
    initial = sections.get("initial")
    reader.attempt(
        "step",
        lambda: rover.chassis.edge_frame(step.edge, step.face),
        edge="edge",
        face="face",
    )
    return StepFile(
        source=reader.source,
        title=about.title or rover.name,
        rover=rover,
        site=objects.site(place),
        edge=step.edge,
        face=step.face,
        motion=step.motion,
        versine_rate=step.versine_rate_rad_s,
        settings=settings,
        gains=Gains(control.kp, control.kd, control.gimbal),
        ground=ground,
        initial_gimbal=None if initial is None else radians(initial.gimbal_deg),
        threshold_share=0.5 if initial is None else initial.threshold_share,
    )
