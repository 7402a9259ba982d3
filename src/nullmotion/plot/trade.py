"""The trade between momentum and gimbal rate that `nullmotion size` finds."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np

from nullmotion.plot import palette, style

_SIZE_IN = (6.4, 4.3)
_ROOM = 1.12  # beyond the outermost point
_LINES = 9  # of equal torque, about
_LABEL = {"fontsize": 6.5, "color": palette.QUIET}


def trade_figure(sizing: Any, path: str | Path) -> Path:
    """Draw momentum over gimbal rate: a curve for each layout, its design, the certified array.

    Args:
        sizing: What `nullmotion.sizing.size` returns.
        path: File to write; its suffix says png, pdf or svg.

    Returns:
        The path.
    """
    import matplotlib
    from matplotlib.figure import Figure

    target = Path(path)
    part = target.with_name(f".{target.stem}.{os.getpid()}.part{target.suffix}")
    with matplotlib.rc_context(style.rc()):
        figure = Figure(figsize=_SIZE_IN, layout="constrained")
        axes = figure.subplots()
        rows = [row for row in sizing.rows if row.status == "sized"]
        for i, row in enumerate(rows):
            _layout(axes, row, i)
        _finish(axes, rows, sizing.requirement.title)
        try:
            figure.savefig(part)
            os.replace(part, target)
        finally:
            part.unlink(missing_ok=True)
    return target


def _layout(axes: Any, row: Any, i: int) -> None:
    """Draw one layout."""
    colour, line = palette.colour(i), style.LINE_STYLES[palette.dash(i)]
    rate, h0 = (np.array(row.curve[key]) for key in ("gimbal_rate_deg_s", "h0_Nms"))
    name = row.layout if row.skew_deg is None else f"{row.layout} {row.skew_deg:.3g} deg"
    good = np.isfinite(h0)
    axes.plot(rate[good], h0[good], color=colour, linestyle=line, label=f"{name}, {row.law}")
    dot: dict[str, Any] = {"color": colour, "linestyle": "none", "zorder": 4}
    axes.plot(row.gimbal_rate_deg_s, row.h0_Nms, marker="o", markersize=6, **dot)
    proof = row.certified
    if proof is not None:
        both = [row.h0_Nms, proof.h0_Nms]
        stem = {"color": colour, "linewidth": 0.8, "linestyle": (0, (1, 1.5))}
        axes.plot([row.gimbal_rate_deg_s] * 2, both, **stem)
        face = "white" if not proof.proven else colour
        axes.plot(proof.gimbal_rate_deg_s, proof.h0_Nms, "D", mfc=face, markersize=5, **dot)


def _finish(axes: Any, rows: list[Any], title: str) -> None:
    """Name everything; draw the lines of equal torque behind it."""
    from matplotlib.lines import Line2D
    from matplotlib.ticker import FuncFormatter

    axes.set_xscale("log")
    axes.set_yscale("log")
    if rows:
        _limits(axes, rows)
        _torques(axes)
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.set_xticks(_ticks(axes.get_xlim()))
    axes.set_yticks(_ticks(axes.get_ylim()))
    axes.minorticks_off()
    axes.set_xlabel("Largest gimbal rate [deg/s]")
    axes.set_ylabel("Momentum of each CMG [N m s]")
    axes.set_title(title)
    handles, _ = axes.get_legend_handles_labels()
    mark: dict[str, Any] = {"color": palette.QUIET, "linestyle": "none"}
    handles.append(Line2D([], [], marker="o", label="design: flown (sampled)", **mark))
    if any(row.certified is not None for row in rows):
        handles.append(Line2D([], [], marker="D", label="certified, same gimbal rate", **mark))
    axes.legend(handles=handles, loc="upper right", frameon=True, framealpha=0.9, edgecolor="none")


def _limits(axes: Any, rows: list[Any]) -> None:
    """Fit the axes to curves and marks, not to the far ends of the curves."""
    x = np.concatenate([row.curve["gimbal_rate_deg_s"] for row in rows])
    y = np.concatenate([row.curve["h0_Nms"] for row in rows])
    marks = [m for row in rows for m in (row.h0_Nms, row.certified and row.certified.h0_Nms) if m]
    low = min(np.nanmin(y), *marks)
    high = min(np.max(y[np.isfinite(y)]), 2.5 * max(marks))
    axes.set_xlim(x.min() / _ROOM, x.max() * _ROOM)
    axes.set_ylim(low / _ROOM, max(high, *marks) * _ROOM)


def _torques(axes: Any) -> None:
    """Draw lines of equal torque, h0 times rate, with their value at the lower or right edge."""
    (x0, x1), (y0, y1) = axes.get_xlim(), axes.get_ylim()
    many = _ticks((np.radians(x0) * y0, np.radians(x1) * np.sqrt(y0 * y1)))
    for torque in many[:: max(1, -(-len(many) // _LINES))]:
        x = np.array([x0, x1])
        axes.plot(x, torque / np.radians(x), color=palette.GRID, linewidth=0.8, zorder=1)
        edge = np.degrees(torque / y0)
        at = (edge, y0) if edge < x1 else (x1, torque / np.radians(x1))
        place = {"xytext": (-2, 2), "textcoords": "offset points", "ha": "right", "va": "bottom"}
        axes.annotate(f"{torque:g} N m", at, **place, **_LABEL, zorder=1)


def _ticks(limits: tuple[float, float]) -> list[float]:
    """Return 1, 2 and 5 times powers of ten within limits; more of them within a decade."""
    low, high = limits
    powers = range(int(np.floor(np.log10(low))), int(np.ceil(np.log10(high))) + 1)
    steps = ("1", "1.5", "2", "3", "4", "5", "7") if high < 10.0 * low else ("1", "2", "5")
    values = [float(f"{k}e{p}") for p in powers for k in steps]
    return [v for v in values if low <= v <= high]
