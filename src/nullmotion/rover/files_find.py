"""Where rover and mission files are: on disk, in a text, or in the library."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path
from typing import Any

from nullmotion.errors import InputError, UnknownNameError
from nullmotion.scenario.source import Source


def library_names() -> list[str]:
    """Return the names of the rovers and missions that come with nullmotion."""
    names = [item.name for item in _library().iterdir()]
    return sorted(name.removesuffix(".toml") for name in names if name.endswith(".toml"))


def find(document: str | Path, folder: Any = None) -> Source:
    """Return the unchecked text of a rover or a mission.

    Args:
        document: Path of a TOML file, TOML text, or a name of the library.
        folder: Where a path is looked for; the current folder by default.

    Raises:
        InputError: For one that is not there, or cannot be read.
    """
    name = str(document)
    if isinstance(document, str) and ("\n" in name or "=" in name):
        return Source(name, "rover text", Path())
    path = Path(name) if folder is None or Path(name).is_absolute() else Path(folder) / name
    if path.is_file():
        try:
            return Source(path.read_text(encoding="utf-8-sig"), str(path), path.parent)
        except (OSError, UnicodeDecodeError):
            raise InputError("rover", name, "a text file in UTF-8 that can be read") from None
    if name in library_names():
        text = (_library() / f"{name}.toml").read_text(encoding="utf-8")
        return Source(text, name, _library())
    if path.is_dir() or path.suffix or Path(name).name != name:
        known = ", ".join(library_names())
        raise InputError("rover", name, f"an existing TOML file, or one of: {known}")
    raise UnknownNameError("rover", name, library_names())


def _library() -> Any:
    return files("nullmotion.rover") / "library"
