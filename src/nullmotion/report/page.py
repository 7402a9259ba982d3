"""One self-contained HTML document out of parts."""

from __future__ import annotations

import os
import platform
import re
from collections.abc import Sequence
from functools import cache
from importlib.resources import files
from importlib.util import find_spec
from pathlib import Path
from string import Template
from typing import Any

import numpy as np

from nullmotion import __version__
from nullmotion.errors import NullmotionError
from nullmotion.report.charts import Charts
from nullmotion.report.markup import Markup, join, tag, text

_SECTION = re.compile(r'<section id="([\w-]+)"[^>]*><h2[^>]*>(.*?)</h2>')


def document(
    title: str,
    parts: Sequence[Markup],
    charts: Charts,
    footer: Markup,
    style: str = "",
    script: str = "",
) -> str:
    """Return the page as one string.

    Args:
        title: Title of the window and of the page's first line.
        parts: Sections of the page, in order.
        charts: The charts that the sections placed.
        footer: Last lines.
        style: Further style sheet.
        script: Further data and script elements; they run before the charts are drawn.
    """
    drawn = bool(charts.figures)
    return Template(asset("page.html")).substitute(
        title=text(title),
        style=asset("page.css") + style,
        body=join(*parts),
        footer=footer,
        more=script,
        data=charts.script() if drawn else "",
        plotly=f"<script>{_plotly()}</script>" if drawn else "",
        script=f"<script>{asset('charts.js')}</script>" if drawn else "",
    )


def section(title: str, *parts: object, id: str) -> Markup:
    """Return a section with a heading."""
    return tag(
        "section", tag("h2", title, id=f"{id}-title"), *parts, id=id, aria_labelledby=f"{id}-title"
    )


def links(parts: Sequence[str]) -> Markup:
    """Return the way to each section among parts of a page."""
    found = [hit for part in parts for hit in _SECTION.findall(part)]
    there = [tag("a", Markup(name), href=f"#{key}") for key, name in found]
    return tag("nav", join(*there), class_="links", aria_label="Sections")


def details(summary: str, content: Markup) -> Markup:
    """Return content that opens on demand."""
    return tag("details", tag("summary", summary), content)


def scenario(content: str) -> Markup:
    """Return the section with a scenario file as it was written."""
    shown = tag("pre", tag("code", content), tabindex="0", aria_label="Scenario file")
    return section("Scenario", details("Scenario file", shown), id="scenario")


def toolbar() -> Markup:
    """Return the time cursor that linked charts share."""
    return tag(
        "div",
        tag("label", "Time ", tag("output", "", id="cursor-time")),
        tag(
            "input",
            type="range",
            id="cursor",
            min=0,
            max=1000,
            value=0,
            step=1,
            aria_label="Time shown in all charts",
        ),
        tag("button", "Whole run", id="reset", type="button"),
        class_="toolbar",
    )


def clockless() -> Markup:
    """Return a toolbar for charts whose abscissa is not time."""
    return tag("div", tag("button", "Whole range", id="reset", type="button"), class_="toolbar")


def versions(*runs: Any) -> Markup:
    """Return what made the page: versions, and how its runs were computed."""
    backends = sorted({str(getattr(run, "backend", "")) for run in runs} - {""})
    instructions = sorted({str(getattr(run, "instruction_set", "")) for run in runs} - {""})
    said = [
        f"nullmotion {__version__}",
        f"Python {platform.python_version()}",
        f"NumPy {np.__version__}",
        f"{platform.system()} {platform.machine()}",
        *([f"computed by {' and '.join(backends)}"] if backends else []),
        *([f"instruction set {', '.join(instructions)}"] if instructions else []),
    ]
    return tag("p", " · ".join(said))


@cache
def asset(name: str) -> str:
    """Return the text of a file of `report/assets`."""
    return files("nullmotion.report").joinpath("assets", name).read_text(encoding="utf-8")


@cache
def _plotly() -> str:
    """Return plotly.js as the installed plotly package ships it (the package is not imported)."""
    spec = find_spec("plotly")
    for folder in (spec.submodule_search_locations or ()) if spec else ():
        file = Path(folder, "package_data", "plotly.min.js")
        if file.is_file():
            return file.read_text(encoding="utf-8").replace("</script", "<\\/script")
    raise NullmotionError(
        "plotly.min.js is missing from the installed plotly package: install plotly again"
    )


def write(path: str | Path, content: str) -> Path:
    """Write a file under a temporary name beside it and rename it; return the path."""
    target = Path(path)
    part = target.with_name(f".{target.name}.{os.getpid()}.part")
    try:
        part.write_text(content, encoding="utf-8")
        os.replace(part, target)
    finally:
        part.unlink(missing_ok=True)
    return target
