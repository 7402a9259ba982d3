"""The page of one run."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from nullmotion.plot.panels import run_panels
from nullmotion.plot.view import Run
from nullmotion.report import page
from nullmotion.report.charts import Charts, grid
from nullmotion.report.markup import Markup, join, tag
from nullmotion.report.tables import metric_table
from nullmotion.report.tiles import row, run_tiles
from nullmotion.report.verdict import status_words, verdict
from nullmotion.report.wording import number


def run_report(trajectory: Run, path: str | Path, title: str, scenario_text: str = "") -> Path:
    """Write one run as an HTML page that needs no network.

    Args:
        trajectory: The run.
        path: File to write.
        title: Title of the page.
        scenario_text: The scenario file as written, shown on demand.

    Returns:
        The path.
    """
    panels = run_panels(trajectory)
    charts = Charts.for_curves(sum(len(panel.curves) for panel in panels))
    drawn = [charts.add(panel, group="time") for panel in panels]
    parts = [
        headline(trajectory, title),
        page.section("Key numbers", row(run_tiles(trajectory)), id="numbers"),
        page.section(
            "Over time", page.toolbar(), grid(drawn), thinning(charts), id="charts-section"
        ),
        page.section(
            "Metrics", tag("div", metric_table(trajectory.metrics), class_="metrics"), id="metrics"
        ),
    ]
    if scenario_text:
        parts.append(page.scenario(scenario_text))
    return page.write(path, page.document(title, parts, charts, page.versions(trajectory)))


def headline(run: Run, title: str) -> Markup:
    """Return the first lines: title, verdict, what ran."""
    said = verdict(run)
    flags = [tag("li", flag) for flag in status_words(run)]
    return tag(
        "header",
        tag("p", title, class_="title"),
        tag("h1", said.words, class_=f"verdict {said.tone}"),
        tag("p", subject(run), class_="subject"),
        tag("ul", join(*flags), class_="flags", aria_label="Status") if flags else "",
    )


def subject(run: Run) -> str:
    """Return what ran: law, array, command."""
    array, law = run.setup.array, run.setup.law
    long = getattr(law, "full_name", "")
    name = f"{long} ({law.name})" if long and long.lower() != law.name.lower() else law.name
    same = np.ptp(array.h0) == 0
    size = f"{number(array.mean_momentum)} N m s {'each' if same else 'in the mean'}"
    asked = "a command that changes over time"
    if np.ptp(run.hdot, axis=0).max() == 0:
        asked = f"({', '.join(number(v) for v in run.hdot[0])}) N m"
    return f"{name} on {array.label}, {array.n} CMGs of {size}; asked for {asked}"


def thinning(charts: Charts) -> Markup:
    """Return a line that says so where curves were thinned."""
    if not charts.thinned:
        return Markup("")
    words = f"Curves are drawn with about {charts.most} points each, their extremes kept."
    return tag("p", words, class_="note")
