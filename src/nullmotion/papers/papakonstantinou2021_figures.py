"""Figures 6 to 12 of Papakonstantinou et al. 2021, and the optimum beside the paper's plan."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from nullmotion.papers import papakonstantinou2021_panels as shown
from nullmotion.papers.papakonstantinou2021_flight import Flight
from nullmotion.papers.papakonstantinou2021_tables import Flights
from nullmotion.plot import palette
from nullmotion.plot.view import Curve, Panel

_COURSES = {"none": "SRI alone", "paper": "the paper's L", "optimum": "exact optimum"}
_SEARCH = {"none": "SRI alone", "paper": "with planned null motion"}
_BESIDE_TITLE: dict[str, Any] = {
    "loc": "lower right",
    "borderaxespad": 0.2,
    "handlelength": 1.7,
    "handletextpad": 0.4,
    "columnspacing": 0.8,
}

_COMPLEX = (
    shown.attitude,
    shown.body_rate,
    shown.momentum,
    shown.attitude_error,
    shown.angles,
    shown.rates,
    shown.torque,
    shown.manipulability,
)
_THREE = (shown.attitude, shown.rates, shown.null_motion, shown.manipulability)
_KINEMATIC = (
    shown.angles,
    shown.rates,
    shown.momentum_error,
    shown.manipulability,
)
FIGURES: dict[int, tuple[str, str, tuple[Callable[[Flight], Panel], ...]]] = {
    6: ("roll", "none", _COMPLEX),
    7: ("roll", "paper", _COMPLEX),
    8: ("three-axis", "none", _THREE),
    9: ("three-axis", "paper", _THREE),
    10: ("kinematic", "none", _KINEMATIC),
    11: ("kinematic", "paper", _KINEMATIC),
}
COUNT = len(FIGURES) + 2  # Figure 12 and the optimum


def draw(
    folder: Path,
    flights: Mapping[str, Flights],
    titles: Mapping[str, str],
    physical: Mapping[str, Flights],
) -> Iterator[Path]:
    """Draw all figures, one after another.

    Args:
        folder: Where they go.
        flights: On the paper's plant, by case and course.
        titles: Of the cases.
        physical: On plants that leave nothing out, by title.
    """
    folder.mkdir(parents=True, exist_ok=True)
    for number, (case, course, panels) in FIGURES.items():
        title = f"Figure {number}: {titles[case]}, {_SEARCH[course]}"
        made = lettered([panel(flights[case][course]) for panel in panels])
        yield save(made, folder / f"figure_{number:02d}.png", title=title)
    made = lettered(interpolation(flights["kinematic"]["paper"]))
    title = f"Figure 12: size of the null motion, {titles['kinematic']}"
    yield save(made, folder / "figure_12.png", title=title)
    named = {f"{case}: as published": found for case, found in flights.items()}
    yield save(
        [optimum(title, found) for title, found in (named | dict(physical)).items()],
        folder / "figure_optimum.png",
        columns=len(flights),
        title="The exact optimum beside the paper's plan",
        common_legend=True,
    )


def save(panels: Sequence[Panel], path: Path, **options: Any) -> Path:
    """Write charts with their legends beside the titles: curves and limits fill the charts."""
    import matplotlib

    from nullmotion.plot import draw as drawing
    from nullmotion.plot import style

    part = path.with_name(f".{path.stem}.{os.getpid()}.part{path.suffix}")
    with matplotlib.rc_context(style.rc()):
        figure = drawing.sheet(panels, **options)
        for axes in figure.axes:
            if axes.get_legend():
                columns = len(axes.get_legend().get_texts())
                axes.legend(ncols=columns, bbox_to_anchor=(1.0, 1.0), **_BESIDE_TITLE)
        try:
            figure.savefig(part)
            part.replace(path)
        finally:
            part.unlink(missing_ok=True)
    return path


def lettered(panels: Sequence[Panel]) -> list[Panel]:
    """Return panels with the paper's letters."""
    return [
        replace(panel, title=f"{letter}) {panel.title}")
        for letter, panel in zip("abcdefgh", panels, strict=False)
    ]


def interpolation(run: Flight) -> list[Panel]:
    """Return k before and after the interpolation."""
    knots, values = run.law.k_max * np.array(run.law.knots), run.gain[:-1]
    hue = palette.colour(0)
    before = Curve("k", np.arange(1.0, len(knots) + 1), knots, hue, width=0.0, marker=True)
    after = Curve("k", np.arange(1.0, len(values) + 1), values, hue, width=0.0, marker=True)
    return [
        Panel("before", "Knots of L", "k [rad/s]", (before,), x_title="Knot"),
        Panel("after", "Interpolated", "k [rad/s]", (after,), x_title="Sample"),
    ]


def optimum(title: str, flights: Flights) -> Panel:
    """Return the manipulability under three courses."""
    curves = tuple(
        Curve(_COURSES[name], run.t, run.manipulability, palette.colour(i), palette.dash(i))
        for i, (name, run) in enumerate(flights.items())
    )
    return shown.index("optimum", title, flights["none"], curves)
