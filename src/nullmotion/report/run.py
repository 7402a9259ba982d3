"""The page of one run."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from nullmotion import rotation
from nullmotion.plot.atlas_runs import run_scene
from nullmotion.plot.events import told
from nullmotion.plot.panels import run_panels
from nullmotion.plot.quantities import of_attitude, turns_wheels
from nullmotion.plot.view import Run
from nullmotion.report import page
from nullmotion.report.atlas import Atlas
from nullmotion.report.attitude_tiles import attitude_tiles
from nullmotion.report.charts import Charts, grid
from nullmotion.report.findings import findings
from nullmotion.report.markup import Markup, join, tag
from nullmotion.report.requirements import Results, requirement_table
from nullmotion.report.tables import metric_table
from nullmotion.report.tiles import row, run_tiles
from nullmotion.report.verdict import status_words, verdict
from nullmotion.report.wheels import wheel_findings, wheel_tiles
from nullmotion.report.wording import number

_HELD = 1e-6  # angle between attitude at the start and at the end below which it is held [deg]


def run_report(
    trajectory: Run,
    path: str | Path,
    title: str,
    scenario_text: str = "",
    requirements: Results = (),
    wheels: Mapping[str, Any] | None = None,
) -> Path:
    """Write one run as an HTML page that needs no network.

    Args:
        trajectory: The run.
        path: File to write.
        title: Title of the page.
        scenario_text: The scenario file as written, shown on demand.
        requirements: What `nullmotion.scenario.requirements.evaluate` returns.
        wheels: What `nullmotion.scenario.vscmg_summary.summary` returns.

    Returns:
        The path.
    """
    panels = run_panels(trajectory)
    charts = Charts.for_curves(sum(len(panel.curves) for panel in panels))
    drawn = [charts.add(panel, group="time") for panel in panels]
    attitude = of_attitude(trajectory)
    tiles = attitude_tiles(trajectory) if attitude else run_tiles(trajectory)
    tiles += [] if attitude else wheel_tiles(trajectory)
    kept = requirement_table(requirements) if requirements else None
    atlas = Atlas(run_scene(trajectory), begin_at_end=True)
    parts = [
        headline(trajectory, title, requirements, wheels),
        page.section("Key numbers", row(tiles), id="numbers"),
        *([page.section("Requirements", kept, id="requirements")] if kept else []),
        page.section(
            "Over time", page.toolbar(), grid(drawn), thinning(charts), id="charts-section"
        ),
        atlas.section(),
        page.section(
            "Metrics", tag("div", metric_table(trajectory.metrics), class_="metrics"), id="metrics"
        ),
    ]
    if scenario_text:
        parts.append(page.scenario(scenario_text))
    made = page.document(title, parts, charts, page.versions(trajectory), *atlas.extras())
    return page.write(path, made)


def headline(
    run: Run, title: str, requirements: Results = (), wheels: Mapping[str, Any] | None = None
) -> Markup:
    """Return the first lines: title, verdict, what ran, what else happened."""
    said = verdict(run)
    lost = told(run) if said.tone == "trouble" else ""
    words = f"{lost}; {said.words[0].lower()}{said.words[1:]}" if lost else said.words
    flags = [tag("li", flag) for flag in status_words(run)]
    more = findings(run, requirements, not lost, wheels) if of_attitude(run) else []
    if turns_wheels(run) and not of_attitude(run):
        more = list(wheel_findings(run, wheels))
    return tag(
        "header",
        tag("p", title, class_="title"),
        tag("h1", words, class_=f"verdict {said.tone}"),
        tag("p", subject(run), class_="subject"),
        tag("ul", join(*(tag("li", sentence) for sentence in more)), class_="findings")
        if more
        else "",
        tag("ul", join(*flags), class_="flags", aria_label="Status") if flags else "",
    )


def subject(run: Run) -> str:
    """Return what ran: law, array, command."""
    array, law = run.setup.array, run.setup.law
    long = getattr(law, "full_name", "")
    name = f"{long} ({law.name})" if long and long.lower() != law.name.lower() else law.name
    same = np.ptp(array.h0) == 0
    size = f"{number(array.mean_momentum)} N m s {'each' if same else 'in the mean'}"
    kind = "VSCMGs" if turns_wheels(run) else "CMGs"
    on = f"{name} on {array.label}, {array.n} {kind} of {size}"
    return f"{on}; {turn(run)}" if of_attitude(run) else f"{on}; asked for {command(run)}"


def command(run: Run) -> str:
    """Return the commanded rate of momentum."""
    if np.ptp(run.hdot, axis=0).max() == 0:
        return f"({', '.join(number(v) for v in run.hdot[0])}) N m"
    return "a command that changes over time"


def turn(run: Run) -> str:
    """Return which attitude was asked, and of which controller."""
    first, last = run.q_BN[0], run.reference[-1]
    angle = np.degrees(rotation.angle(rotation.multiply(rotation.conjugate(first), last)))
    way = "" if run.setup.reference is None else "following a reference "
    controller = run.setup.controller
    long = getattr(controller, "full_name", "") or controller.name
    asked = f"turn by {number(angle)} deg" if angle > _HELD else "hold its attitude"
    return f"asked to {asked}, {way}under {long.lower()}"


def thinning(charts: Charts) -> Markup:
    """Return a line that says so where curves were thinned."""
    if not charts.thinned:
        return Markup("")
    words = f"Curves are drawn with about {charts.most} points each, their extremes kept."
    return tag("p", words, class_="note")
