"""The page of an analysis."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from nullmotion.atlas.analysis import Analysis
from nullmotion.plot.atlas_view import Scene
from nullmotion.plot.view import Run
from nullmotion.report import atlas_page, page
from nullmotion.report.atlas_rows import OMNI, balls, failure_rows, number_rows
from nullmotion.report.atlas_state import state_section
from nullmotion.report.markup import Markup, tag
from nullmotion.report.tables import table
from nullmotion.report.wording import number


def shown(found: Analysis, home: Any, run: Run | None = None) -> Scene | None:
    """Return what page and figure show of an analysis; None where nothing can be drawn."""
    flown = None if run is None or run.wheel_speed is not None else run  # its surfaces change
    return atlas_page.analysis_scene(found.array, home, balls(found), flown, maps=found.maps)


def analysis_page(
    path: str | Path,
    title: str,
    found: Analysis,
    scene: Scene | None,
    run: Run | None = None,
    text: str = "",
) -> Path:
    """Write an analysis as an HTML page that needs no network.

    Args:
        path: File to write.
        title: Title of the page.
        found: The analysis.
        scene: What `shown` returns.
        run: A run whose history is shown beside.
        text: The file as written, shown on demand.

    Returns:
        The path.
    """
    more = []
    if found.failures:
        more.append(_failures(found))
    if found.state is not None:
        more.append(state_section(found.state))
    rows = number_rows(found)
    return atlas_page.atlas_page(
        path, title, scene, headline(found, title), rows, run, text, tuple(more)
    )


def headline(found: Analysis, title: str) -> Markup:
    """Return the first lines: what the array can rely on."""
    ball, nearest = found.radii.omnidirectional, found.radii.nearest_impassable
    unit = float(found.array.mean_momentum)
    words = f"{OMNI} {number(ball.lower)} N m s, {number(ball.lower / unit)} h0"
    if ball.upper == 0:
        words = "No momentum in every direction"
    sentences = [
        "Null motion leaves every internal singularity."
        if nearest is None
        else f"Impassable singularities from {number(nearest.radius)} N m s on."
    ]
    lost = [one.radii.omnidirectional.lower for one in found.failures]
    if lost:
        sentences.append(f"With one CMG failed: {number(min(lost))} N m s in every direction.")
    return tag(
        "header",
        tag("p", title, class_="title"),
        tag("h1", words),
        tag("p", atlas_page.subject(found.array), class_="subject"),
        tag("ul", *(tag("li", sentence) for sentence in sentences), class_="findings"),
    )


def _failures(found: Analysis) -> Markup:
    head, rows = failure_rows(found)
    note = "Momentum in N m s when a CMG has failed and its momentum is gone; CMGs count from 1."
    made = table(head, rows, "What is left when a CMG fails", numeric=(1, 2, 3, 4), wide=True)
    return page.section("One CMG failed", tag("p", note, class_="note"), made, id="failed")
