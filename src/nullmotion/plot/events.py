"""What happened to the CMGs during a run: marks in its charts, and in words."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from nullmotion.plot.view import Mark, Panel, Run

TOLD = {
    "stuck": " stuck",
    "slow": " slow",
    "spin-down": " spinning down",
    "wheel-dead": "'s wheel motor dead",
}
_LETTER = 0.02  # width of a letter over that of a chart, on a telephone
_LATE = 0.6  # share of the time from which a mark's name runs to the left


def happened(run: Run) -> list[Any]:
    """Return the faults that began before the run ended, in order of time."""
    events = [e for e in getattr(run.setup, "events", ()) if e.at < run.t[-1]]
    return sorted(events, key=lambda e: float(e.at))


def name(event: Any) -> str:
    """Return what happened to which CMG, counted from 1."""
    return f"CMG {event.cmg + 1}{TOLD[event.kind]}"


def found_at(event: Any) -> float:
    """Return when the law is told [s]; infinite if never."""
    return float(event.at + event.detected_after)


def marks(run: Run) -> tuple[Mark, ...]:
    """Return the instants of faults, and those at which the law is told of them."""
    events = happened(run)
    made = []
    for event in events:
        made.append(Mark(float(event.at), name(event)))
        if event.detected_after > 0 and found_at(event) <= run.t[-1]:
            label = f"CMG {event.cmg + 1} found" if len(events) > 1 else "found"
            made.append(Mark(found_at(event), label))
    made.sort(key=lambda mark: mark.at)
    late = run.t[0] + _LATE * (run.t[-1] - run.t[0])
    sided = [replace(m, side="left") if m.at > late else m for m in made]
    return _spaced(sided, float(run.t[-1] - run.t[0]))


def _spaced(ordered: Sequence[Mark], span: float) -> tuple[Mark, ...]:
    """Return marks of which those whose names would overlap have one name together."""
    groups: list[list[Mark]] = []
    for mark in ordered:
        groups.append([mark])
        while len(groups) > 1 and _extent(groups[-1], span)[0] < _extent(groups[-2], span)[1]:
            groups[-2:] = [groups[-2] + groups[-1]]
    return tuple(
        replace(mark, label=_name_of(group) if i == 0 else "")
        for group in groups
        for i, mark in enumerate(group)
    )


def _extent(group: Sequence[Mark], span: float) -> tuple[float, float]:
    """Return where the name of marks begins and ends along the abscissa."""
    first, width = group[0], _LETTER * span * len(_name_of(group))
    return (first.at - width, first.at) if first.side == "left" else (first.at, first.at + width)


def _name_of(group: Sequence[Mark]) -> str:
    return ", ".join(mark.label for mark in group)


def marked(panels: Sequence[Panel], run: Run) -> list[Panel]:
    """Return charts over time with the marks of what happened in a run."""
    found = marks(run)
    return [replace(panel, marks=found) for panel in panels]


def stuck(run: Run) -> set[int]:
    """Return the CMGs that are stuck at the end, from 0."""
    return {e.cmg for e in happened(run) if e.kind == "stuck"}


def told(run: Run) -> str:
    """Return what was lost, in words; empty where nothing happened."""
    events = happened(run)
    if not events:
        return ""
    left = run.delta.shape[1] - len(stuck(run))
    count = [f"{left} CMG{'' if left == 1 else 's'} left"] if stuck(run) else []
    return "; ".join([*(_sentence(event, float(run.t[-1])) for event in events), *count])


def _sentence(event: Any, end: float) -> str:
    known = f"found at {found_at(event):.4g} s" if found_at(event) <= end else "not found"
    if event.detected_after == 0:
        known = "known at once"
    return f"{name(event)} at t = {event.at:.4g} s, {known}"
