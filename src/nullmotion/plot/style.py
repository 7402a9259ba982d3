"""House style of printed figures: sizes, fonts, lines."""

from __future__ import annotations

from typing import Any

from nullmotion.plot import palette

PANEL_WIDTH_IN = 3.55  # two panels fill a page of 7.1 in, the width of a two-column journal
PANEL_HEIGHT_IN = 2.35
DPI = 200

# lengths of strokes and gaps in line widths
LINE_STYLES: dict[str, Any] = {
    "solid": "-",
    "dash": (0, (4, 1.8)),
    "dot": (0, (1.2, 1.6)),
    "dashdot": (0, (5, 1.6, 1.2, 1.6)),
    "longdash": (0, (8, 2)),
}


def rc() -> dict[str, Any]:
    """Return matplotlib settings, for `matplotlib.rc_context`."""
    return {
        "font.family": "DejaVu Sans",
        "font.size": 8,
        "axes.titlesize": 9,
        "axes.titleweight": "bold",
        "axes.titlelocation": "left",
        "axes.labelsize": 8,
        "axes.edgecolor": palette.QUIET,
        "axes.labelcolor": palette.INK,
        "axes.grid": True,
        "axes.axisbelow": True,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "grid.color": palette.GRID,
        "grid.linewidth": 0.6,
        "xtick.labelsize": 7.5,
        "ytick.labelsize": 7.5,
        "xtick.color": palette.QUIET,
        "ytick.color": palette.QUIET,
        "legend.fontsize": 7,
        "legend.frameon": False,
        "legend.handlelength": 2.6,
        "lines.linewidth": 1.2,
        "lines.dash_capstyle": "butt",
        "savefig.dpi": DPI,
        "pdf.fonttype": 42,  # text stays text in the file
        "svg.fonttype": "none",
        "figure.constrained_layout.use": True,
    }
