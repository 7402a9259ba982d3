"""The plotly layout of a panel: axes, limits, ticks."""

from __future__ import annotations

from html import escape
from typing import Any

from nullmotion.plot import palette
from nullmotion.plot.view import Panel

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
    return {
        "xaxis": {**_AXIS, **ticks, "title": {"text": escape(panel.x_title), "standoff": 6}},
        "yaxis": {**_AXIS, "title": {"text": escape(panel.y_title), "standoff": 4}, "nticks": 6},
        "shapes": [_level_line(level.value) for level in panel.levels],
        "annotations": [
            _level_name(level.value, level.label) for level in panel.levels if level.label
        ],
    }


def _level_line(value: float) -> dict[str, Any]:
    line = {"color": palette.QUIET, "width": 1.2, "dash": "dot"}
    return {
        "type": "line",
        "xref": "paper",
        "x0": 0,
        "x1": 1,
        "y0": value,
        "y1": value,
        "line": line,
    }


def _level_name(value: float, label: str) -> dict[str, Any]:
    return {
        "xref": "paper",
        "x": 0.005,
        "xanchor": "left",
        "y": value,
        "yanchor": "bottom",
        "text": escape(label),
        "showarrow": False,
        "font": {"size": 11, "color": palette.QUIET},
        "bgcolor": "rgba(255,255,255,0.75)",
        "borderpad": 1,
    }
