"""The page of one run."""

from __future__ import annotations

from pathlib import Path

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
        page.section("Over time", page.toolbar(), grid(drawn), thinning(charts), id="charts-section"),
        page.section("Metrics", metric_table(trajectory.metrics), id="metrics"),
    ]
    if scenario_text:
        parts.append(page.section("Scenario", page.details("Scenario file", scenario_text), id="scenario"))
    return page.write(path, page.document(title, parts, charts, page.versions(trajectory)))


def headline(run: Run, title: str) -> Markup:
    """Return the first lines: title, verdict, what ran."""
    said = verdict(run)
    array, law = run.setup.array, run.setup.law
    subject = (
        f"Law {law.name} on {array.label}, {array.n} CMGs of {number(array.mean_momentum)} N m s in the mean"
    )
    flags = [tag("li", flag) for flag in status_words(run)]
    return tag(
        "header",
        tag("p", title, class_="title"),
        tag("h1", said.words, class_=f"verdict {said.tone}"),
        tag("p", subject, class_="subject"),
        tag("ul", join(*flags), class_="flags", aria_label="Status") if flags else "",
    )


def thinning(charts: Charts) -> Markup:
    """Return a line that says so where curves were thinned."""
    if not charts.thinned:
        return Markup("")
    words = f"Curves are drawn with about {charts.most} points each, their extremes kept."
    return tag("p", words, class_="note")
