"""Ground from a TOML file, or by its name in the library.

    [ground]
    name = "loose regolith"
    stiffness_N_m = 2.0e4              # across the ground
    damping_Ns_m = 2.0e4               # across the ground
    drag_Ns_m = 5.0e4                  # along the ground
    friction = 0.8                     # greatest force along the ground over that across; optional

What is left out is that of the default ground.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from nullmotion.errors import InputError, UnknownNameError
from nullmotion.rover.ground import Ground

LIBRARY = {
    "rock": Ground(),
    "soft": Ground(2e4, 1e4, 1e5, None, "soft"),
    "gravel": Ground(5e4, 5e3, 5e4, 0.9, "gravel"),
    "regolith": Ground(2e4, 2e3, 2e4, 0.8, "regolith"),
    "sand": Ground(1e4, 1e3, 1e4, 0.6, "sand"),
    "ice": Ground(1e6, 1e4, 1e5, 0.1, "ice"),
}
"""Grounds by name: the first is Table 3 of Elliott 2019, the others are examples."""

KEYS = {
    "name": "name",
    "stiffness_N_m": "stiffness",
    "damping_Ns_m": "damping",
    "drag_Ns_m": "drag",
    "friction": "friction",
}


def load_ground(ground: str | Path | Ground) -> Ground:
    """Return a ground.

    Args:
        ground: Path of a TOML file, TOML text, or a name in `LIBRARY`.

    Raises:
        ScenarioError: For one that cannot be used: everything that is wrong with it, each with
            key, value, what is allowed, file and line.
        InputError: For a file that cannot be read.
    """
    if isinstance(ground, Ground):
        return ground
    return LIBRARY[str(ground)] if str(ground) in LIBRARY else _read(_find(ground))


def _find(ground: str | Path) -> Any:
    """Return the text of a file, or text itself, as the source of a document."""
    from nullmotion.scenario.source import Source

    if isinstance(ground, str) and ("\n" in ground or "=" in ground):
        return Source(ground, "ground text")
    path, name = Path(ground), str(ground)
    if path.is_file():
        try:
            return Source(path.read_text(encoding="utf-8-sig"), name, path.parent)
        except (OSError, UnicodeDecodeError):
            raise InputError("ground", name, "a text file in UTF-8 that can be read") from None
    if path.is_dir() or path.suffix or path.name != name:
        raise InputError("ground", name, f"an existing TOML file, or {', '.join(LIBRARY)}")
    raise UnknownNameError("ground", name, LIBRARY)


def _read(source: Any) -> Ground:
    """Return the ground in a document."""
    from nullmotion.scenario.keys import hint
    from nullmotion.scenario.problems import MISSING
    from nullmotion.scenario.validate import Validator

    found, table = Validator(source), source.data.get("ground", MISSING)
    for key in source.data:
        if key != "ground":
            found.add((key,), MISSING, hint(key, ["ground"]).replace("key", "section", 1))
    if not isinstance(table, dict):
        missing = "this section is missing" if table is MISSING else "a section with keys"
        found.add(("ground",), table, missing)
        table = {}
    for key, value in table.items():
        said = _wrong(key, value) if key in KEYS else hint(key, KEYS)
        if said:
            found.add(("ground", key), value, said)
    found.raise_problems()
    return Ground(**{KEYS[key]: value for key, value in {"name": source.name, **table}.items()})


def _wrong(key: str, value: Any) -> str:
    """Return what a key allows if it does not allow this value."""
    if key == "name":
        return "" if isinstance(value, str) else "a text in quotes"
    try:
        Ground(**{KEYS[key]: value})
    except InputError as error:
        return error.allowed
    return ""
