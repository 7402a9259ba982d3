"""Runs in an array's momentum space."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from nullmotion.array.model import CmgArray
from nullmotion.plot import palette
from nullmotion.plot.atlas_view import Motion, Scene, scene
from nullmotion.plot.quantities import sigma_min
from nullmotion.plot.view import Case, Run

MOST_POINTS = 16_000  # of the sheets beside a run's charts
MOST_CMGS = 16  # whose sign patterns are counted


def motion(run: Run, label: str, slot: int | None = None) -> Motion:
    """Return how a run's gimbals turned.

    Args:
        run: The run.
        label: Its name.
        slot: Its place among others, which fixes colour and dash; None if it is alone.
    """
    look = {} if slot is None else {"colour": palette.colour(slot), "dash": palette.dash(slot)}
    return Motion(label, run.t, run.delta, run.momentum, sigma_min(run), **look)


def run_scene(run: Run) -> Scene | None:
    """Return a run in momentum space; None where its array has no surfaces to show."""
    return _scene(run, [motion(run, "this run")])


def case_scene(cases: Sequence[Case]) -> Scene | None:
    """Return the runs of a comparison in momentum space; None where there are none."""
    ran = [(i, case) for i, case in enumerate(cases) if case.trajectory is not None]
    if not ran:
        return None
    motions = [motion(case.trajectory, case.label, i) for i, case in ran]
    return _scene(ran[0][1].trajectory, motions)


def _scene(run: Any, motions: Sequence[Motion]) -> Scene | None:
    array = run.setup.array
    if not drawable(array) or getattr(run, "wheel_speed", None) is not None:
        return None
    home = motions[0].delta[0]
    start = home if np.isfinite(home).all() else None
    return scene(array, start, motions=motions, most=MOST_POINTS)


def drawable(array: CmgArray) -> bool:
    """Return whether an array has singular surfaces, or lines, that can be drawn."""
    return array.m in (2, 3) and int(np.sum(np.asarray(array.h0) > 0)) <= MOST_CMGS
