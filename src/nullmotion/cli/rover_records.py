"""The rovers and missions that come with nullmotion, as plain records."""

from __future__ import annotations

from typing import Any


def rovers() -> list[dict[str, Any]]:
    """Return the rovers and missions that come with nullmotion."""
    from nullmotion.rover.files_find import find, library_names

    return [_record(name, find(name).data) for name in library_names()]


def _record(name: str, data: dict[str, Any]) -> dict[str, Any]:
    about = data.get("mission") or data.get("rover", {})
    drive = "CMG" if "cmg" in data else "reaction wheels" if "wheels" in data else ""
    return {
        "name": name,
        "title": about.get("title", ""),
        "kind": "mission" if "mission" in data else f"rover with {drive}",
        "command": f"nullmotion rover {_command(data)} {name}",
        "about": about.get("description", ""),
    }


def _command(data: dict[str, Any]) -> str:
    return "mission" if "mission" in data else "run" if "cmg" in data else "plan"
