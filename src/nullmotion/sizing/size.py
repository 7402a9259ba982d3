"""From a requirement to the smallest array of each layout that meets it."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path

from nullmotion.sizing.choose import chosen
from nullmotion.sizing.design import designed, why_not
from nullmotion.sizing.files import scenario_files
from nullmotion.sizing.guaranteed import guaranteed
from nullmotion.sizing.load import load_requirement
from nullmotion.sizing.requirement import Requirement
from nullmotion.sizing.result import Row, Sizing
from nullmotion.sizing.rows import fill, tried
from nullmotion.sizing.trial import Fleet

Progress = Callable[[float], None]
_CHOSEN, _DESIGNED = 0.5, 0.85  # shares of a layout's work


def size(requirement: str | Path | Requirement, progress: Progress | None = None) -> Sizing:
    """Return the smallest array of each layout that meets a requirement when flown.

    Ctrl-C ends it with the layouts that are done.

    Args:
        requirement: What `load_requirement` takes.
        progress: Called with the finished share.

    Raises:
        InputError: For a requirement that cannot be used.
        KeyboardInterrupt: If no layout is done.
    """
    r, start = load_requirement(requirement), time.monotonic()
    fleet, found, count = Fleet(r), Sizing(r, [], True, 0.0), len(r.layouts)
    try:
        for i, layout in enumerate(r.layouts):

            def step(share: float, done: int = i) -> None:
                if progress is not None:
                    progress((done + share) / count)

            row, files = _sized(r, layout, fleet, step)
            found.rows.append(row)
            found.files[layout] = files
            step(1.0)
    except KeyboardInterrupt:
        if not found.rows:
            raise
        found.complete = False
    found.seconds = time.monotonic() - start
    return found


def _sized(r: Requirement, layout: str, fleet: Fleet, step: Progress) -> tuple[Row, dict[str, str]]:
    """Return the row of a layout and the files that fly its worst slew."""
    before = fleet.flown
    choice = chosen(r, layout, fleet, lambda share: step(_CHOSEN * share))
    row = Row(layout, choice.tried[0].trial.geometry.whole.n, tried=tried(choice))
    found = designed(choice, lambda share: step(_CHOSEN + (_DESIGNED - _CHOSEN) * share))
    if found is None:
        row.status, row.reason = "cannot", why_not(choice)
        row.flights = fleet.flown - before
        return row, {}
    fill(row, found)
    certified = guaranteed(found.polished)
    if isinstance(certified, str):
        row.certified_reason = certified
    else:
        row.certified = certified
    row.flights = fleet.flown - before
    design, worst = found.polished.design, found.polished.worst
    assert worst is not None
    return row, scenario_files(found.polished.trial, design.h0, design.rate, worst)
