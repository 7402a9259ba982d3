"""The plotly layout of a panel: axes, limits, ticks."""

from __future__ import annotations

import math
from html import escape
from typing import Any

import numpy as np

from nullmotion.plot import palette
from nullmotion.plot.view import Level, Mark, Panel

_FEW = 1.5  # decades below which an axis needs ticks between them
_TICKS = 6
_AXIS = {
    "gridcolor": palette.GRID,
    "linecolor": palette.QUIET,
    "tickcolor": palette.QUIET,
    "zeroline": False,
    "showline": True,
    "ticks": "outside",
    "ticklen": 4,
    "automargin": False,
}


def layout(panel: Panel) -> dict[str, Any]:
    """Return axes, limits and their names as plotly's layout; text is escaped."""
    named = [escape(name) for name in panel.ticks]
    ticks = {"tickvals": list(range(len(named))), "ticktext": named} if named else {}
    y_axis = {"title": {"text": escape(panel.y_title), "standoff": 4}, "nticks": 6}
    if panel.log:
        y_axis |= _logarithmic(panel)
    names = [_level_name(panel, level) for level in panel.levels if level.label]
    return {
        "xaxis": {**_AXIS, **ticks, "title": {"text": escape(panel.x_title), "standoff": 6}},
        "yaxis": {**_AXIS, **y_axis},
        "shapes": [
            *(_shade(*span) for span in panel.spans),
            *(_level_line(level) for level in panel.levels),
            *(_mark_line(mark.at) for mark in panel.marks),
        ],
        "annotations": [*names, *(_mark_name(mark) for mark in panel.marks if mark.label)],
    }


def _shade(start: float, end: float) -> dict[str, Any]:
    line = {"color": palette.SHADE, "width": 0.5}
    sides = {"x0": start, "x1": end, "y0": 0, "y1": 1}
    fill = {"fillcolor": palette.SHADE, "line": line, "layer": "below"}
    return {"type": "rect", "yref": "paper", **sides, **fill}


def _level_line(level: Level) -> dict[str, Any]:
    line = {"color": palette.QUIET, "width": 1.2, "dash": level.dash}
    return {
        "type": "line",
        "xref": "paper",
        "x0": 0,
        "x1": 1,
        "y0": level.value,
        "y1": level.value,
        "line": line,
    }


def _logarithmic(panel: Panel) -> dict[str, Any]:
    """Return what makes an ordinate logarithmic, with about as many ticks as another has."""
    values = np.concatenate([*(curve.y for curve in panel.curves), [v.value for v in panel.levels]])
    values = values[np.isfinite(values) & (values > 0)]
    low, high = (values.min(), values.max()) if len(values) else (1.0, 1.0)
    axis: dict[str, Any] = {"type": "log", "exponentformat": "none" if low > 1e-4 else "e"}
    decades = math.log10(high / low)
    return axis if decades < _FEW else axis | {"dtick": max(1, math.ceil(decades / _TICKS))}


def _mark_line(at: float) -> dict[str, Any]:
    line = {"color": palette.ALERT, "width": 1.2, "dash": "dot"}
    return {"type": "line", "yref": "paper", "x0": at, "x1": at, "y0": 0, "y1": 1, "line": line}


def _level_name(panel: Panel, level: Level) -> dict[str, Any]:
    y = math.log10(level.value) if panel.log else level.value  # as plotly wants it
    return _name(level.label, xref="paper", x=0.005, y=y, yanchor="bottom")


def _mark_name(mark: Mark) -> dict[str, Any]:
    anchor = "left" if mark.side == "right" else "right"
    return _name(mark.label, yref="paper", x=mark.at, y=1, yanchor="bottom", xanchor=anchor)


def _name(label: str, **where: Any) -> dict[str, Any]:
    return {
        "xanchor": "left",
        "text": escape(label),
        "showarrow": False,
        "font": {"size": 11, "color": palette.QUIET},
        "bgcolor": "rgba(255,255,255,0.75)",
        "borderpad": 1,
        **where,
    }
