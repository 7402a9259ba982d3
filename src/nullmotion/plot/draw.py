"""Draw a `Panel` with matplotlib, and save figures."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from nullmotion.errors import InputError
from nullmotion.plot import palette, style
from nullmotion.plot.view import Mark, Panel

SUFFIXES = (".png", ".pdf", ".svg")


def draw(panel: Panel, axes: Any, legend: bool = True) -> None:
    """Draw one chart into matplotlib axes."""
    for curve in panel.curves:
        axes.plot(
            curve.x,
            np.where(np.isfinite(curve.y), curve.y, np.nan),
            label=curve.label,
            color=curve.colour,
            linestyle=style.LINE_STYLES[curve.dash],
            linewidth=0.75 * curve.width,
            marker="o" if curve.marker else None,
            markersize=3,
        )
    for level in panel.levels:
        dash: Any = (0, (2, 2)) if level.dash == "dot" else style.LINE_STYLES[level.dash]
        axes.axhline(level.value, color=palette.QUIET, linewidth=0.9, linestyle=dash)
        if level.label:
            _name(axes, level.value, level.label)
    for start, end in panel.spans:
        axes.axvspan(start, end, color=palette.SHADE, linewidth=0.4, zorder=0)
    for mark in panel.marks:
        axes.axvline(mark.at, color=palette.ALERT, linewidth=0.8, linestyle=(0, (1, 1.5)))
        if mark.label:
            _name_mark(axes, mark)
    if panel.ticks:
        axes.set_xticks(range(len(panel.ticks)), panel.ticks)
    axes.set_title(panel.title, pad=12 if panel.marks else None)
    axes.set_xlabel(panel.x_title)
    axes.set_ylabel(panel.y_title)
    axes.margins(x=0.01, y=0.12 if panel.levels else 0.05)
    if panel.log:
        axes.set_yscale("log")
    else:
        axes.ticklabel_format(axis="y", style="sci", scilimits=(-3, 4), useOffset=False)
    if legend and len(panel.curves) > 1:
        axes.legend(ncols=_columns(len(panel.curves)), loc="best")


def _columns(curves: int) -> int:
    return 1 if curves < 4 else 2 if curves < 9 else 3


def _name(axes: Any, value: float, label: str) -> None:
    place: Any = {"xy": (0.0, value), "xycoords": ("axes fraction", "data")}
    _small(axes, label, xytext=(3, 2), **place)


def _name_mark(axes: Any, mark: Mark) -> None:
    side = {"ha": "left" if mark.side == "right" else "right"}
    _small(axes, mark.label, xy=(mark.at, 1.0), xycoords=("data", "axes fraction"), **side)


def _small(axes: Any, label: str, **where: Any) -> None:
    """Write the name of a line beside it."""
    usual: dict[str, Any] = {"xytext": (0, 2), "ha": "left", "va": "bottom"}
    usual |= {"fontsize": 6.5, "color": palette.QUIET}
    axes.annotate(label, textcoords="offset points", **(usual | where))


def sheet(
    panels: Sequence[Panel], columns: int = 2, title: str = "", common_legend: bool = False
) -> Any:
    """Return a matplotlib figure with the charts in a grid.

    Args:
        panels: What to draw.
        columns: Charts side by side.
        title: Above all.
        common_legend: One legend below all charts in place of one in each.
    """
    from matplotlib.figure import Figure

    rows = -(-len(panels) // columns)
    labels = {curve.label for panel in panels for curve in panel.curves}
    lines = -(-len(labels) // _legend_columns(list(labels), columns)) if common_legend else 0
    extra = 0.3 * bool(title) + 0.16 * lines
    size = (style.PANEL_WIDTH_IN * columns, style.PANEL_HEIGHT_IN * rows + extra)
    figure = Figure(figsize=size, layout="constrained")
    grid = figure.subplots(rows, columns, squeeze=False)
    for axes, panel in zip(grid.flat, panels, strict=False):
        draw(panel, axes, legend=not common_legend)
    for axes in list(grid.flat)[len(panels) :]:
        axes.set_axis_off()
    if title:
        figure.suptitle(title, fontsize=10, fontweight="bold", x=0.01, ha="left")
    if common_legend:
        handles, names = _handles(grid)
        figure.legend(
            handles, names, loc="outside lower center", ncols=_legend_columns(names, columns)
        )
    return figure


def _legend_columns(names: Sequence[str], sheet_columns: int) -> int:
    """Return how many legend entries fit side by side."""
    entry = 0.062 * max(len(name) for name in names) + 0.65  # [in] at the legend's font size
    return int(np.clip(style.PANEL_WIDTH_IN * sheet_columns // entry, 1, len(names)))


def _handles(grid: Any) -> tuple[list[Any], list[str]]:
    found: dict[str, Any] = {}
    for axes in grid.flat:
        for handle, label in zip(*axes.get_legend_handles_labels(), strict=True):
            found.setdefault(label, handle)
    return list(found.values()), list(found)


def save(panels: Sequence[Panel], path: str | Path, **options: Any) -> Path:
    """Draw the charts and write them to a file: png, pdf or svg by its suffix.

    Raises:
        InputError: For another suffix, or when there is nothing to draw.
    """
    target = Path(path)
    if target.suffix.lower() not in SUFFIXES:
        raise InputError("figure file", str(path), f"a name that ends in {', '.join(SUFFIXES)}")
    if not panels:
        raise InputError("figure", str(path), "at least one case that ran")
    import matplotlib

    part = target.with_name(f".{target.stem}.{os.getpid()}.part{target.suffix}")
    with matplotlib.rc_context(style.rc()):
        try:
            sheet(panels, **options).savefig(part)
            os.replace(part, target)
        finally:
            part.unlink(missing_ok=True)
    return target
