"""The ground of a mission from its ``[terrain]``: generated, or read from a file."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

from nullmotion.errors import InputError
from nullmotion.rover.files_read import Reader, value_at
from nullmotion.rover.terrain import HeightField
from nullmotion.rover.terrain_files import load_terrain
from nullmotion.rover.terrain_random import generated

_SEEDED = {
    "seed": "seed",
    "rms_slope_deg": "rms_slope",
    "shortest_m": "shortest",
    "hurst": "hurst",
    "incline_deg": "incline",
    "heading_deg": "heading",
}
_SIZE = 20.0
_KEYS = ("file", "size_m", *_SEEDED, "spacing_m", "origin_m")
TERRAIN = {f"terrain.{key}": ("terrain", key) for key in _KEYS}
"""Where a mission file has what the keys of errors about its ground name."""


def terrain(reader: Reader) -> HeightField | None:
    """Return the ground of ``[terrain]``, None with problems noted."""
    given = reader.section("terrain", needed=True)
    if given is None:
        return None
    if given.file is None:
        return _generated(reader, given)
    for key in ("size_m", *_SEEDED):
        if given.given(key):
            reader.add(("terrain", key), getattr(given, key), "not beside file")
    path = Path(reader.source.folder or "") / given.file
    origin = given.origin_m or (0.0, 0.0)
    try:
        return load_terrain(path, given.spacing_m, origin)
    except InputError as error:
        if error.where:
            raise  # the line of the terrain's own file
        key = TERRAIN.get(error.key, ("terrain", "file"))[1]
        reader.add(("terrain", key), value_at(reader.source, ("terrain", key)), error.allowed)
    return None


def _generated(reader: Reader, given: Any) -> HeightField | None:
    if given.given("origin_m"):
        reader.add(("terrain", "origin_m"), given.origin_m, "only beside file")
    values: dict[str, Any] = {
        name: math.radians(getattr(given, key)) if key.endswith("_deg") else getattr(given, key)
        for key, name in _SEEDED.items()
        if getattr(given, key) is not None
    }
    if given.spacing_m is not None:
        values["spacing"] = given.spacing_m
    size = given.size_m or _SIZE
    return reader.attempt(
        "terrain", lambda: generated(size, **values), **{key: key for key in _KEYS}
    )
