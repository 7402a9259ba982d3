"""Planned steps kept on disk, so that a rover is planned for once.

One JSON file for each rover and gravity; its name is a digest of all numbers behind a plan and of
the planner's own source, so that nothing stale is ever read. The folder is
``$NULLMOTION_CACHE``, or ``nullmotion`` in the user's cache. A folder that cannot be written to,
or a file that cannot be read, only costs time.
"""

from __future__ import annotations

import dataclasses
import hashlib
import json
import os
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np

from nullmotion.rover.path_cost import PlannedStep
from nullmotion.rover.rover import Rover

_SOURCES = (
    "chassis",
    "collocation",
    "edge_frame",
    "planner",
    "polyhedron",
    "settings",
    "solve",
    "step_dynamics",
    "step_energy",
    "step_model",
)


class StepStore:
    """Planned steps in a file, by edge, face and slope; in memory only without one.

    Args:
        path: The file; it need not exist.
    """

    def __init__(self, path: Path | None = None) -> None:
        """Read what is there."""
        self.path = path
        self._known: dict[str, list[float] | None] = {}
        if path is not None:
            with suppress(OSError, ValueError):
                found = json.loads(path.read_text(encoding="utf-8"))
                self._known = {str(key): _checked(value) for key, value in found.items()}

    @classmethod
    def of(cls, rover: Rover, gravity: float) -> StepStore:
        """Return the store of a rover under a gravity [m/s^2] in the user's cache."""
        return cls(folder() / f"steps-{digest(rover, gravity)}.json")

    def has(self, edge: int, face: int, pitch: float, cross: float) -> bool:
        """Return whether a step was planned, found or not."""
        return _key(edge, face, pitch, cross) in self._known

    def get(self, edge: int, face: int, pitch: float, cross: float) -> PlannedStep | None:
        """Return a planned step; None if there is no such step."""
        found = self._known[_key(edge, face, pitch, cross)]
        return None if found is None else PlannedStep(*found)

    def put(
        self, edge: int, face: int, pitch: float, cross: float, step: PlannedStep | None
    ) -> None:
        """Keep a step, or that there is none, at once on disk."""
        self._known[_key(edge, face, pitch, cross)] = (
            None if step is None else [float(v) for v in step]
        )
        if self.path is not None:
            with suppress(OSError):
                self.path.parent.mkdir(parents=True, exist_ok=True)
                temporary = self.path.with_name(f".{self.path.name}.{os.getpid()}.tmp")
                temporary.write_text(json.dumps(self._known, indent=1), encoding="utf-8")
                temporary.replace(self.path)


def folder() -> Path:
    """Return where planned steps are kept."""
    given = os.environ.get("NULLMOTION_CACHE")
    if given:
        return Path(given)
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "nullmotion"


def digest(rover: Rover, gravity: float) -> str:
    """Return 16 hexadecimal digits of all numbers behind a plan, and of the planner's source."""
    numbers = json.dumps([_plain(rover), repr(float(gravity))], sort_keys=True)
    found = hashlib.sha256(numbers.encode())
    for name in _SOURCES:
        with suppress(OSError):
            found.update(Path(__file__).with_name(f"{name}.py").read_bytes())
    return found.hexdigest()[:16]


def _plain(value: Any) -> Any:
    """Return a record as lists and strings that tell any two numbers apart."""
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        return {f.name: _plain(getattr(value, f.name)) for f in dataclasses.fields(value)}
    if isinstance(value, np.ndarray):
        return [repr(float(v)) for v in value.ravel()]
    return repr(value)


def _key(edge: int, face: int, pitch: float, cross: float) -> str:
    slope, tilt = np.degrees([pitch, cross])
    return f"e{edge} from face {face} at {slope:+.6f} deg, {tilt:+.6f} deg across"


def _checked(value: Any) -> list[float] | None:
    if value is None:
        return None
    if len(value) != len(PlannedStep._fields):
        raise ValueError(value)
    return [float(v) for v in value]
