"""The rover of a mission: named in ``[mission]``, or held by the file itself."""

from __future__ import annotations

from nullmotion.errors import InputError
from nullmotion.rover import files_objects as objects
from nullmotion.rover.files_find import find
from nullmotion.rover.files_mission_schema import MISSION
from nullmotion.rover.files_read import Reader
from nullmotion.rover.files_schema import ROVER
from nullmotion.rover.path_kinds import check_tetrahedron
from nullmotion.rover.rover import Rover
from nullmotion.scenario.problems import MISSING
from nullmotion.scenario.source import Source

BODY = ("chassis", "cmg")
_CMG = "a rover with a CMG: what trips with wheels cost is told beside it"


def rover(reader: Reader, named: str | None) -> tuple[Rover | None, float]:
    """Return a mission's rover and the gravity of its file [m/s^2].

    Args:
        reader: The mission; notes what is wrong.
        named: What ``mission.rover`` says.

    Returns:
        Both; None and 0 with problems noted.
    """
    if named is None:
        source = reader.source
        if not reader.given("chassis"):
            reader.add(
                ("mission", "rover"), MISSING, "this key, or [chassis] and [cmg], is missing"
            )
            return None, 0.0
    else:
        source = _over(_find_rover(reader, named), reader.source)
    inner = Reader(source, ROVER, MISSION)
    name = "rover" if named is None else str(source.data.get("rover", {}).get("name", named))
    made, place = objects.rover(inner, name), inner.section("site")
    inner.raise_problems()
    if not isinstance(made, Rover):
        reader.add(("mission", "rover"), named, _CMG)
        return None, 0.0
    reader.attempt("mission", lambda: check_tetrahedron(made.chassis), chassis="rover")
    return made, place.gravity_m_s2


def _find_rover(reader: Reader, named: str) -> Source:
    """Return the file of a rover that a mission names."""
    try:
        return find(named, reader.source.folder)
    except InputError as error:
        reader.add(("mission", "rover"), named, error.allowed)
        reader.raise_problems()
        raise


def _over(source: Source, mission: Source) -> Source:
    """Return a rover's file with the mission's own values set over it."""
    values = {
        f"{name}.{key}": value
        for name in BODY
        for key, value in dict(mission.data.get(name, {})).items()
    }
    first = next(iter(values), None)
    if first is None:
        return source
    return source.over(values, mission.where(tuple(first.split("."))))
