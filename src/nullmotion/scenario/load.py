"""Find and read a scenario: a file, a text, or a name in the library."""

from __future__ import annotations

from collections.abc import Mapping
from importlib.resources import files
from pathlib import Path
from typing import Any

from nullmotion.errors import InputError, UnknownNameError
from nullmotion.scenario.scenario import Scenario, checked
from nullmotion.scenario.source import Source


def _library() -> Any:
    return files("nullmotion.scenario") / "library"


def library_names() -> list[str]:
    """Return the names of the scenarios that come with nullmotion."""
    return sorted(
        item.name.removesuffix(".toml")
        for item in _library().iterdir()
        if item.name.endswith(".toml")
    )


def load_scenario(
    scenario: str | Path, values: Mapping[str, Any] | None = None, origin: str = "--set"
) -> Scenario:
    """Return a checked scenario.

    Args:
        scenario: Path of a TOML file, TOML text, or a name of the library.
        values: Values by dotted key, set over the file (``{"law.sigma_c": 0.05}``).
        origin: What messages call those values.

    Raises:
        ScenarioError: For a scenario that cannot be used, with everything that is wrong.
        InputError: For a file that cannot be read.
    """
    source = find(scenario)
    return checked(source.over(values, origin) if values else source)


def find(scenario: str | Path) -> Source:
    """Return the unchecked text of a scenario; see `load_scenario`."""
    if isinstance(scenario, str) and ("\n" in scenario or "=" in scenario):
        return Source(scenario, "scenario text", Path())
    path = Path(scenario)
    if path.is_file():
        return Source(_text(path), str(scenario), path.parent)
    if str(scenario) in library_names():
        text = (_library() / f"{scenario}.toml").read_text(encoding="utf-8")
        return Source(text, str(scenario), _library())
    if path.is_dir():
        raise InputError("scenario", str(scenario), "a TOML file, not a folder")
    if path.suffix or path.name != str(scenario):
        raise InputError(
            "scenario",
            str(scenario),
            "an existing file, or a name from `nullmotion list scenarios`",
        )
    raise UnknownNameError("scenario", str(scenario), library_names())


def _text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError:
        raise InputError("scenario", str(path), "a text file in UTF-8") from None
    except OSError as error:
        raise InputError(
            "scenario", str(path), f"a file that can be read ({error.strerror})"
        ) from None
