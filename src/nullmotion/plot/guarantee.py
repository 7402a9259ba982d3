"""What a constraint function guarantees: torque capability over the size and on a slice."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from nullmotion.guarantee import maps
from nullmotion.plot import palette, style

Step = tuple[float, float]  # radius, torque capability


def guarantee_figure(
    path: Path, constraint: Any, searched: Sequence[Step] = (), proven: Sequence[Step] = ()
) -> None:
    """Draw TC over |h| (least, greatest, what is proven) beside a slice of momentum space.

    Args:
        path: PNG, PDF or SVG file.
        constraint: The constraint function.
        searched: Radii and torque capabilities found by search.
        proven: Radii and torque capabilities with a certificate.
    """
    import matplotlib

    with matplotlib.rc_context(style.rc()):
        from matplotlib.figure import Figure

        size = (2 * style.PANEL_WIDTH_IN, 1.25 * style.PANEL_HEIGHT_IN)
        figure = Figure(figsize=size)
        left, right = figure.subplots(1, 2)
        _band(left, constraint, searched, proven)
        _slice(right, constraint)
        figure.savefig(path)


def _band(axes: Any, constraint: Any, searched: Sequence[Step], proven: Sequence[Step]) -> None:
    radii = np.linspace(0, constraint.reach, 400)
    low, high = maps.band(constraint, radii)
    seen = high > 0
    axes.fill_between(
        radii[seen], low[seen], high[seen], color=palette.colour(0), alpha=0.22, linewidth=0
    )
    axes.plot(radii[seen], low[seen], color=palette.colour(0), label="least over directions")
    axes.plot(
        radii[seen],
        high[seen],
        color=palette.colour(0),
        ls=style.LINE_STYLES["dash"],
        label="greatest",
        lw=0.9,
    )
    if proven:
        r, t = np.array(sorted(proven)).T
        axes.plot(r, t, "o", ms=4, color=palette.colour(1), label="proven inside |h|")
    if searched:
        r, t = np.array(sorted(searched)).T
        axes.plot(r, t, "x", ms=5, color=palette.INK, label="found by search")
    axes.set(
        xlabel="Momentum |h| / h0", ylabel="Torque capability / (h0 rate)", xlim=(0, None),
        ylim=(0, 1.4 * high.max()), title="At every direction",
    )  # fmt: skip
    axes.legend(loc="upper right")


def _slice(axes: Any, constraint: Any) -> None:
    coarse = maps.slice_map(constraint, "z", points=101)
    used = np.argwhere(coarse.to_numpy() > 0)
    reach = 1.1 * np.abs(coarse.coords[coarse.dims[0]].to_numpy()[used]).max()
    found = maps.slice_map(constraint, "z", reach=reach)
    values = np.where(found > 0, found, np.nan).T
    side = found.coords[found.dims[0]].to_numpy()
    colours = axes.pcolormesh(side, side, values, cmap="cividis", shading="auto", rasterized=True)
    levels = [v for v in (0.5, 1.0, 1.5, 2.0) if np.nanmin(values) < v < np.nanmax(values)]
    if levels:
        lines = axes.contour(side, side, values, levels, colors="white", linewidths=0.8)
        axes.clabel(lines, fmt="%g", fontsize=6.5)
    axes.set(xlabel="h_x / h0", ylabel="h_y / h0", aspect="equal")
    axes.set_title("At h_z = 0" if constraint.m == 3 else "In the plane")
    axes.grid(visible=False)
    axes.figure.colorbar(colours, ax=axes, shrink=0.85).outline.set_visible(False)
