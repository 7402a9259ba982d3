"""The page of a comparison."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from nullmotion.plot.atlas_runs import case_scene
from nullmotion.plot.events import told
from nullmotion.plot.overlays import angle_panels, overlays
from nullmotion.plot.varied import varied_panels
from nullmotion.plot.view import Case, Panel
from nullmotion.report import page
from nullmotion.report.atlas import Atlas
from nullmotion.report.charts import Charts, grid, shared_legend
from nullmotion.report.markup import Markup, tag
from nullmotion.report.requirements import compared_table
from nullmotion.report.results import attitudes, outcome, result_table, varied_table
from nullmotion.report.run import thinning

MOST_MULTIPLES = 24  # small multiples of gimbal angles on one page
TALLY: dict[str, str] = {
    "stopped": "stopped by a condition",
    "done": "ran to the end",
    "trouble": "stuck or failed",
    "refused": "could not run",
}
TALLY_ATTITUDE = TALLY | {"done": "settled", "trouble": "not settled"}


def compare_report(comparison: Any, path: str | Path, title: str, scenario_text: str = "") -> Path:
    """Write a comparison of laws as an HTML page that needs no network.

    Args:
        comparison: What `nullmotion.campaign.compare` returns.
        path: File to write.
        title: Title of the page.
        scenario_text: The scenario file as written, shown on demand.

    Returns:
        The path.
    """
    cases: Sequence[Case] = comparison.cases
    varied = varied_panels(comparison)
    together = [] if varied else overlays(cases)
    multiples = [] if varied else angle_panels(cases)[:MOST_MULTIPLES]
    charts = Charts.for_curves(sum(len(p.curves) for p in (*varied, *together, *multiples)))
    atlas = Atlas(None if varied else case_scene(cases), begin_at_end=True)
    parts = [headline(cases, title)]
    if varied:
        key = comparison.varied
        parts.append(curves(charts, varied, f"Over {key}", "varied", page.clockless()))
        parts.append(
            page.section(
                "Results", page.details("All cases", varied_table(cases, key)), id="results"
            )
        )
    else:
        parts.append(page.section("Results", result_table(cases), id="results"))
        kept = compared_table(cases)
        parts += [page.section("Requirements", kept, id="requirements")] if kept else []
    if together:
        parts.append(curves(charts, together, "Over time", "time", page.toolbar()))
        parts.append(atlas.section())
    if multiples:
        drawn = [charts.add(panel, "time", "angles", small=True) for panel in multiples]
        parts.append(
            page.section("Gimbal angles", shared_legend("angles"), grid(drawn, True), id="angles")
        )
    parts.append(thinning(charts))
    if scenario_text:
        parts.append(page.scenario(scenario_text))
    ran = [case.trajectory for case in cases if case.trajectory is not None]
    made = page.document(title, parts, charts, page.versions(*ran), *atlas.extras())
    return page.write(path, made)


def curves(
    charts: Charts, panels: Sequence[Panel], title: str, group: str, tools: Markup
) -> Markup:
    """Return a section of charts that share one legend, a curve a case."""
    drawn = [charts.add(panel, group, "cases") for panel in panels]
    return page.section(
        title,
        tag("div", tools, shared_legend("cases"), class_="tools"),
        grid(drawn),
        id=f"over-{group}",
    )


def headline(cases: Sequence[Case], title: str) -> Markup:
    """Return the first lines: title, how the cases went, what they ran on."""
    tones: Counter[str] = Counter(outcome(case).tone for case in cases)
    known = TALLY_ATTITUDE if attitudes(cases) else TALLY
    tally = ", ".join(f"{tones[tone]} {words}" for tone, words in known.items() if tones[tone])
    plural = "case" if len(cases) == 1 else "cases"
    ran = [case.trajectory for case in cases if case.trajectory is not None]
    return tag(
        "header",
        tag("p", title, class_="title"),
        tag("h1", f"{len(cases)} {plural}: {tally}"),
        tag("p", subject(ran[0]), class_="subject") if ran else "",
    )


def subject(run: Any) -> str:
    """Return what the cases ran on, and what was lost on the way."""
    array = run.setup.array
    return "; ".join(filter(None, [f"On {array.label}, {array.n} CMGs", told(run)]))
