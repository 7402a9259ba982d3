"""Find, read and check a requirement: a file, a text, or a name in the library."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path
from typing import Any

from nullmotion.errors import InputError, UnknownNameError
from nullmotion.scenario.source import Source
from nullmotion.sizing import checks
from nullmotion.sizing.read import Reader
from nullmotion.sizing.requirement import Requirement


def load_requirement(requirement: str | Path | Requirement) -> Requirement:
    """Return a checked requirement.

    Args:
        requirement: Path of a TOML file, TOML text, or a name of the library.

    Raises:
        ScenarioError: For one that cannot be used, with everything that is wrong.
        InputError: For a file that cannot be read.
    """
    if isinstance(requirement, Requirement):
        return requirement
    source = _find(requirement)
    reader = Reader(source)
    found = Requirement(source, reader.sections())
    checks.check(found, reader)
    reader.raise_problems()
    return found


def library_names() -> list[str]:
    """Return the names of the requirements that come with nullmotion."""
    names = [item.name for item in _library().iterdir()]
    return sorted(name.removesuffix(".toml") for name in names if name.endswith(".toml"))


def _library() -> Any:
    return files("nullmotion.sizing") / "library"


def _find(requirement: str | Path) -> Source:
    if isinstance(requirement, str) and ("\n" in requirement or "=" in requirement):
        return Source(requirement, "requirement text", Path())
    path, name = Path(requirement), str(requirement)
    if path.is_file():
        try:
            return Source(path.read_text(encoding="utf-8-sig"), name, path.parent)
        except (OSError, UnicodeDecodeError):
            raise InputError("requirement", name, "a text file in UTF-8 that can be read") from None
    if name in library_names():
        return Source((_library() / f"{name}.toml").read_text(encoding="utf-8"), name, _library())
    if path.is_dir() or path.suffix or path.name != name:
        raise InputError("requirement", name, f"an existing TOML file, or {_known()}")
    raise UnknownNameError("requirement", name, library_names())


def _known() -> str:
    return "one that comes along: " + ", ".join(library_names())
