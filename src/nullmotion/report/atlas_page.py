"""The page of `nullmotion analyze`."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from nullmotion.array.model import CmgArray
from nullmotion.plot.atlas_runs import drawable, motion
from nullmotion.plot.atlas_view import Ball, Scene, scene
from nullmotion.plot.panels import run_panels
from nullmotion.plot.view import Run
from nullmotion.report import atlas_numbers, page
from nullmotion.report.atlas import Atlas
from nullmotion.report.atlas_numbers import Number, number_table
from nullmotion.report.charts import Charts, grid
from nullmotion.report.markup import Markup, join, tag
from nullmotion.report.run import thinning
from nullmotion.report.wording import number

_PANELS = ("pointing_error", "rates", "angles", "torque", "torque_error", "measures", "momentum")
_FLAT = "This array gives torque in one direction only: there is no surface to draw."


def analysis_scene(
    array: CmgArray, home: Any, balls: Sequence[Ball], run: Run | None, **options: Any
) -> Scene | None:
    """Return what the page and the figure of an analysis show; None where nothing can be drawn."""
    if not drawable(array):
        return None
    motions = [] if run is None else [motion(run, run.setup.law.name)]
    return scene(array, home, balls, motions, **options)


def atlas_page(
    path: str | Path,
    title: str,
    shown: Scene | None,
    headline: Markup,
    rows: Sequence[Number],
    run: Run | None = None,
    text: str = "",
    more: Sequence[Markup] = (),
) -> Path:
    """Write the analysis of an array as an HTML page that needs no network.

    Args:
        path: File to write.
        title: Title of the page.
        shown: Surfaces, radii and maps; None where there is nothing to draw.
        headline: First lines.
        rows: Numbers of the table.
        run: A run whose history is shown beside.
        text: The file as written, shown on demand.
        more: What comes after the numbers.

    Returns:
        The path.
    """
    atlas, charts = Atlas(shown), Charts()
    parts = [
        atlas.section() if shown is not None else tag("p", _FLAT, class_="note"),
        atlas.maps(),
        page.section("Numbers", number_table(rows, title), id="numbers"),
        *more,
        _history(charts, run) if run is not None else Markup(""),
        _file(text),
    ]
    head = join(headline, page.links(parts))
    made = page.versions(*([run] if run is not None else []))
    pairs = zip(atlas.extras(), atlas_numbers.extras(), strict=True)
    style, script = ("".join(pair) for pair in pairs)
    return page.write(path, page.document(title, [head, *parts], charts, made, style, script))


def _file(text: str) -> Markup:
    if not text:
        return Markup("")
    shown = tag("pre", tag("code", text), tabindex="0", aria_label="Array file")
    return page.section("Array", page.details("File", shown), id="file")


def subject(array: CmgArray) -> str:
    """Return what was analysed."""
    size = f"{number(array.mean_momentum)} N m s"
    same = float(max(array.h0)) == float(min(array.h0))
    return f"{array.label}, {array.n} CMGs of {size} {'each' if same else 'in the mean'}"


def _history(charts: Charts, run: Run) -> Markup:
    """Return the charts of a run, on the same clock as the pictures."""
    panels = [panel for panel in run_panels(run) if panel.key in _PANELS]
    charts.most = Charts.for_curves(sum(len(panel.curves) for panel in panels)).most
    drawn = [charts.add(panel, group="time") for panel in panels]
    return page.section("Over time", page.toolbar(), grid(drawn), thinning(charts), id="history")
