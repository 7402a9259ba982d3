"""The row of key numbers at the top of a page."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from nullmotion.plot.quantities import (
    rate_limits,
    sigma_min,
    steady_direction,
    torque_fractions,
)
from nullmotion.plot.view import Run
from nullmotion.report.markup import Markup, join, tag
from nullmotion.report.wording import number, percent


class Tile(NamedTuple):
    """One key number."""

    label: str
    value: str
    unit: str = ""
    note: str = ""


def row(tiles: Iterable[Tile]) -> Markup:
    """Return key numbers side by side."""
    return tag("dl", join(*(_tile(tile) for tile in tiles)), class_="tiles")


def _tile(tile: Tile) -> Markup:
    value = tag("dd", tile.value, tile.unit and tag("span", f" {tile.unit}", class_="unit"))
    note = tag("dd", tile.note, class_="note") if tile.note else ""
    return tag("div", tag("dt", tile.label), value, note)


def run_tiles(run: Run) -> list[Tile]:
    """Return the key numbers of a run."""
    made = [
        _time(run),
        _momentum(run),
        _along(run),
        least_sigma(run),
        _error(run),
        _rate(run),
        _step(run),
    ]
    return [tile for tile in made if tile is not None]


def _time(run: Run) -> Tile:
    label = "Ran for" if run.stopped_at_s is None else "Stopped at"
    return Tile(
        label, number(run.t[-1]), "s", f"{len(run.t) - 1} steps of {number(run.setup.dt)} s"
    )


def _momentum(run: Run) -> Tile:
    size = float(np.linalg.norm(run.momentum[-1]))
    scale = float(run.setup.array.mean_momentum)
    return Tile(
        "Momentum at the end", number(size), "N m s", f"{number(size / scale, 3)} × mean h0"
    )


def _along(run: Run) -> Tile | None:
    direction = steady_direction(run)
    if direction is None:
        return None
    gained = (run.momentum[-1] - run.momentum[0]) @ direction
    asked = np.sum(run.hdot[:-1] * np.diff(run.t)[:, None], axis=0) @ direction
    share = f"{percent(gained / asked)} % of what was asked" if asked > 0 else ""
    return Tile("Gained along command", number(gained), "N m s", share)


def least_sigma(run: Run) -> Tile | None:
    """Return the least singular value and when; None if it is not known."""
    values = sigma_min(run)
    if values is None or not np.isfinite(values).any():
        return None
    at = int(np.nanargmin(values))
    note = f"at {number(run.t[at])} s; 0 is singular"
    return Tile("Least sigma_min", number(values[at], 3), "", note)


def _error(run: Run) -> Tile | None:
    _, across = torque_fractions(run)
    if not np.isfinite(across).any():
        return None
    rms = float(np.sqrt(np.nanmean(across**2)))
    note = f"of the command; RMS {percent(rms)} %"
    return Tile("Off-axis torque, peak", percent(np.nanmax(across)), "%", note)


def _rate(run: Run) -> Tile | None:
    if not np.isfinite(run.rates).any():
        return None
    largest = float(np.nanmax(np.abs(run.rates)))
    limits = rate_limits(run)
    note = f"{percent(largest / limits[0])} % of the limit" if limits else "no limit set"
    return Tile("Largest gimbal rate", number(np.degrees(largest)), "deg/s", note)


def _step(run: Run) -> Tile | None:
    step = run.metrics.get("max_rate_step_rad_s")
    if step is None:
        return None
    return Tile(
        "Largest rate step",
        number(step, 3),
        "rad/s",
        f"{number(np.degrees(step), 3)} deg/s between samples",
    )
