"""What happened in a step: in words, and as marks in its charts."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from nullmotion.plot.view import Mark

_NEAR = 0.06  # of the time: marks closer than that share the weightiest name
_LATE = 0.6  # share of the time from which a mark's name runs to the left
_RISES = ("departure", "lift-off")
_HOW = {"m": "by up to", "rad": "by up to", "m/s": "at"}
WEIGHT = ("landing", "tipping", "turning", "slip", "lift-off", "touchdown", "departure", "sliding")


def happened(run: Any, landing: Any) -> list[tuple[float, str, str]]:
    """Return what happened: time [s], kind, and words; in order of time."""
    if landing is not None:
        return [(event.t, event.kind, told(event)) for event in landing.events]
    if run is None:
        return []
    found = [(float(run.t[-1]), "landing", "Landed")]
    if run.outcome == "tipped":
        found = [(tipping(run), "tipping", "Torque to spare used up: a spike lifts off")]
    elif run.outcome != "landed":
        found = [(float(run.t[-1]), run.outcome, f"{run.outcome.capitalize()}: the end of the run")]
    if np.isfinite(run.lift_off):
        found.append((float(run.lift_off), "lift-off", "The body begins to turn"))
    return sorted(found)


def tipping(run: Any) -> float:
    """Return when the margin of a run that tips falls below 0 [s]."""
    return float(run.t[np.argmax(run.margin < 0)])


def told(event: Any) -> str:
    """Return an event in words."""
    sizes = {"m": (1e3, "mm"), "rad": (float(np.degrees(1.0)), "deg")}
    factor, unit = sizes.get(event.unit, (1.0, event.unit))
    where = "" if event.spike is None else f" of spike {event.spike}"
    how = "rising up to" if event.kind in _RISES else _HOW[event.unit]
    return f"{event.kind.capitalize()}{where}, {how} {event.size * factor:.3g} {unit}"


def marks(run: Any, landing: Any) -> tuple[Mark, ...]:
    """Return the instants as marks of a chart; those close together have one name."""
    found = happened(run, landing)
    if not found:
        return ()
    end = float((landing or run).t[-1])
    groups: list[list[tuple[float, str]]] = []
    for at, kind, _ in found:
        if groups and at - groups[-1][0][0] < _NEAR * end:
            groups[-1].append((at, kind))
        else:
            groups.append([(at, kind)])
    return tuple(_mark(group, end) for group in groups)


def _mark(group: Sequence[tuple[float, str]], end: float) -> Mark:
    rank = {kind: i for i, kind in enumerate(WEIGHT)}
    at, kind = min(group, key=lambda event: rank.get(event[1], len(WEIGHT)))
    return Mark(at, kind, "left" if at > _LATE * end else "right")
