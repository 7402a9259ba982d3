"""The sections of a mission file as pydantic models; keys and units are those of the file."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BeforeValidator, Discriminator, Field, Tag

from nullmotion.scenario.schema import NotNegative, Pair, Positive, Section, sized


def _is_list(value: Any) -> str:
    return "list" if isinstance(value, tuple) else "one"


_Two = Annotated[Pair, BeforeValidator(sized(2))]
_Size = Annotated[
    Annotated[Positive, Tag("one")]
    | Annotated[tuple[Positive, Positive], BeforeValidator(sized(2)), Tag("list")],
    Discriminator(_is_list),
]


class MissionSection(Section):
    """``[mission]``: from where to where; (x, y) on the map."""

    title: str = ""
    description: str = ""
    rover: str | None = None
    start_m: _Two
    goal_m: _Two
    within_m: NotNegative = 0.0
    heading_deg: float | None = None
    drift: Positive = 0.25


class TerrainSection(Section):
    """``[terrain]``: generated from a seed, or read from a file."""

    file: str | None = None
    size_m: _Size | None = None
    seed: Annotated[int, Field(ge=0)] | None = None
    rms_slope_deg: Annotated[float, Field(ge=0, le=60)] | None = None
    shortest_m: Positive | None = None
    hurst: Annotated[float, Field(ge=0, le=1)] | None = None
    incline_deg: Annotated[float, Field(ge=-80, le=80)] | None = None
    heading_deg: float | None = None
    spacing_m: Positive | None = None
    origin_m: _Two | None = None


class GravitySection(Section):
    """``[site]`` of a mission: the rover's unless it is given; slopes are the terrain's."""

    gravity_m_s2: Positive | None = None


class UpkeepSection(Section):
    """``[upkeep]``: what the rotor takes beside the steps; see `Upkeep`."""

    power_W: NotNegative = 50.0
    pause_s: NotNegative = 60.0
    spin_up_time_s: NotNegative = 86_400.0


MISSION: dict[str, type[Section]] = {
    "mission": MissionSection,
    "terrain": TerrainSection,
    "site": GravitySection,
    "upkeep": UpkeepSection,
}
"""Sections of a mission file; beside them `[chassis]` and `[cmg]`, as in a rover file."""
