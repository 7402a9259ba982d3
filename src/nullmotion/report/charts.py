"""Panels as plotly figures: plain dicts, numbers as base64 in one table that figures share."""

from __future__ import annotations

import base64
import json
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from nullmotion.plot.view import Curve, Panel
from nullmotion.report.layout import layout
from nullmotion.report.markup import Markup, join, tag
from nullmotion.report.thin import thinned

MOST_POINTS = 4000
MOST_BYTES = 2_500_000  # of curves in one page, before base64; plotly.js itself is 4.8 MB
LEAST_POINTS = 400
_BYTES_PER_POINT = 12  # abscissa in double, ordinate in single precision


@dataclass
class Charts:
    """Collects a page's charts; `script` gives the data block that draws them.

    Args:
        most: Points a curve may have.
    """

    most: int = MOST_POINTS
    arrays: list[str] = field(default_factory=list)
    figures: dict[str, dict[str, Any]] = field(default_factory=dict)
    thinned: bool = False
    _known: dict[bytes, int] = field(default_factory=dict)

    @classmethod
    def for_curves(cls, curves: int) -> Charts:
        """Return a collection whose pages keep their size with this many curves."""
        fits = MOST_BYTES // (max(curves, 1) * _BYTES_PER_POINT)
        return cls(most=max(LEAST_POINTS, min(MOST_POINTS, fits)))

    def add(self, panel: Panel, group: str = "", legend: str = "", small: bool = False) -> Markup:
        """Add a chart and return the element in which it will be drawn.

        Args:
            panel: What to draw.
            group: Charts of one group share zoom and cursor; empty for a chart by itself.
            legend: Name of the legend it shares (`shared_legend`); by default it has
                its own, with values at the cursor.
            small: Small multiple: less height.
        """
        self.figures[panel.key] = {
            "group": group,
            "legend": legend,
            "title": panel.title,
            "traces": [self._trace(curve) for curve in panel.curves],
            "layout": layout(panel),
        }
        return tag(
            "figure",
            tag("figcaption", tag("h3", panel.title), panel.note and tag("p", panel.note)),
            "" if legend else tag("div", class_="legend", data_legend=panel.key),
            tag(
                "div",
                class_="plot",
                id=f"plot-{panel.key}",
                data_chart=panel.key,
                role="img",
                aria_label=f"Chart: {panel.title}. {panel.y_title} over {panel.x_title}.",
            ),
            class_="chart small" if small else "chart",
        )

    def _trace(self, curve: Curve) -> dict[str, Any]:
        x, y = thinned(np.asarray(curve.x, float), np.asarray(curve.y, float), self.most)
        self.thinned |= len(y) < len(curve.y)
        return {
            "name": curve.label,
            "x": self._array(x.astype("<f8")),
            "y": self._array(y.astype("<f4")),
            "mode": "lines+markers" if curve.marker else "lines",
            "line": {
                "color": curve.colour,
                "dash": curve.dash,
                "width": curve.width,
                "simplify": False,
            },
        }

    def _array(self, values: np.ndarray) -> int:
        """Return the place of an array in the page's table; equal arrays are kept once."""
        raw = values.tobytes()
        if raw not in self._known:
            self._known[raw] = len(self.arrays)
            self.arrays.append(f"{values.dtype.str[1:]}:{base64.b64encode(raw).decode()}")
        return self._known[raw]

    def script(self) -> Markup:
        """Return the data block of the page."""
        data = {"arrays": self.arrays, "figures": self.figures}
        return Markup(f'<script type="application/json" id="charts">{embedded(data)}</script>')


def embedded(data: object) -> str:
    """Return JSON that may stand inside a script element."""
    written = json.dumps(data, separators=(",", ":"), allow_nan=False)
    return written.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")


def grid(charts: Sequence[Markup], small: bool = False) -> Markup:
    """Return charts side by side as far as the window is wide."""
    return tag("div", join(*charts), class_="charts small" if small else "charts")


def shared_legend(name: str) -> Markup:
    """Return the place of a legend that switches a curve in all charts that name it."""
    return tag("div", class_="legend", data_common_legend=name)
