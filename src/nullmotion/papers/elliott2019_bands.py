"""Figures 20, 21, 26 to 28 and 41 of Elliott 2019: over the size of the momentum, and slices."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from nullmotion.papers.elliott2019_runs import SINGULAR, Run
from nullmotion.papers.elliott2019_spheres import Band, Function
from nullmotion.plot import palette

SIZE = "Momentum |H| [h]"
CAPABILITY = "Torque capability TC [-]"
_EVERY = 15  # steps between points of a run's line
_POINTS = 321  # along each side of a slice
_SHADE = "#c3cad2"  # of a predicted band
_SAFE, _PARTLY, _NOT = "#8cc9b5", "#4a525c", "#e8b3a8"
_ABOVE = 1.5  # TC to which zones are drawn


def guarantee(figure: Any, band: Band, capability: Function) -> None:
    """Draw TC over |H| and on the slices through the origin."""
    grid = figure.subplots(2, 2)
    first, *others = grid.flat
    used = band.high > 0
    first.fill_between(
        band.sizes[used], band.low[used], band.high[used], color=_PARTLY, linewidth=0.6
    )
    first.set(title="A) All momenta", xlabel=SIZE, ylabel=CAPABILITY, xlim=(0, None))
    first.set_ylim(0, 1.4)
    side = np.linspace(-2.0, 2.0, _POINTS)
    across, up = np.meshgrid(side, side)
    for axis, axes in enumerate(others):
        kept = [i for i in range(3) if i != axis]
        h = np.zeros((_POINTS, _POINTS, 3))
        h[..., kept[0]], h[..., kept[1]] = across, up
        values = capability(h.reshape(-1, 3)).reshape(_POINTS, _POINTS)
        shown = _slice(axes, side, values)
        x, y = (f"$H_{'xyz'[i]}$ [h]" for i in kept)
        axes.set(title=f"B) $H_{'xyz'[axis]}$ = 0", xlabel=x, ylabel=y)
    bar = figure.colorbar(shown, ax=list(grid.flat), shrink=0.6, pad=0.02)
    bar.set_label(CAPABILITY)
    bar.outline.set_visible(False)


def _slice(axes: Any, side: np.ndarray, values: np.ndarray) -> Any:
    inside = np.where(values > 0, values, np.nan)
    shown = axes.pcolormesh(side, side, inside, cmap="cividis", vmin=0, vmax=4 / 3, rasterized=True)
    lines = axes.contour(side, side, values, (0.5, 1.0), colors="white", linewidths=0.8)
    axes.clabel(lines, fmt="%g", fontsize=6.5)
    axes.set_aspect("equal")
    axes.grid(visible=False)
    return shown


def zones(figure: Any, band: Band) -> None:
    """Draw which torques can be had at which sizes of the momentum."""
    axes, r = figure.subplots(), band.sizes
    top = np.full_like(r, _ABOVE)
    for low, high, colour, label in (
        (0.0 * r, band.low, _SAFE, "all momenta, all torque directions"),
        (band.low, band.high, _PARTLY, "some momenta, all torque directions"),
        (band.high, top, _NOT, "some torque directions, or none"),
    ):
        axes.fill_between(r, low, high, color=colour, linewidth=0, label=label)
    axes.set(xlim=(0, 3), ylim=(0, _ABOVE), xlabel=SIZE)
    axes.set_ylabel(r"Torque / (h $\dot\delta_{max}$) [-]")
    axes.legend(loc="upper right", frameon=True, framealpha=0.9, edgecolor="none")
    axes.grid(visible=False)


def constrained(figure: Any, band: Band, run: Run) -> None:
    """Draw the constraint law's TC inside what is predicted."""
    axes = figure.subplots()
    _predicted(axes, band, "predicted")
    _trace(axes, run, run.capability, palette.colour(0), "50 trajectories")
    axes.set(xlabel=SIZE, ylabel=CAPABILITY, xlim=(0, 3), ylim=(0, None))
    _legend(axes, "upper right")


def gradients(figure: Any, band: Band, runs: Mapping[float, Run], cb: Run) -> None:
    """Draw the local gradient's TC for every gain, and the constraint's, on what is predicted."""
    least = min(float(run.capability.min()) for run in runs.values())
    for axes, run in zip(figure.subplots(3, 2).flat, (*runs.values(), cb), strict=True):
        colour = palette.colour(0 if run is cb else 1)
        _predicted(axes, band, "CB, predicted")
        _trace(axes, run, run.capability, colour, f"{run.label[:2]}, 50 trajectories")
        axes.axhline(0.0, color=palette.QUIET, linewidth=0.8)
        axes.set(title=_gain(run), xlabel=SIZE, ylabel=CAPABILITY)
        axes.set(xlim=(0, 3), ylim=(min(1.08 * least, -0.1), 1.45))
        _legend(axes, "lower right")


def measures(figure: Any, band: Band, runs: Mapping[float, Run], cb: Run) -> None:
    """Draw det(J J^T) of the local gradient for every gain, and det J_t of the constraint."""
    *grid, last = figure.subplots(3, 2).flat
    for axes, run in zip(grid, runs.values(), strict=True):
        _trace(axes, run, run.measure, palette.colour(1), "")
        note = f"{run.singular_ends} of {len(run.ends)} end singular (< {SINGULAR:g})"
        axes.text(0.97, 0.95, note, ha="right", va="top", transform=axes.transAxes, fontsize=7)
        axes.set(title=_gain(run), xlabel=SIZE, ylabel=r"$\Omega$ = det(J J$^T$) [-]")
        axes.set(xlim=(0, 3), ylim=(-0.08, 2.9))
    _predicted(last, band, "predicted")
    _trace(last, cb, cb.measure, palette.colour(0), "50 trajectories")
    last.set(title="CB", xlabel=SIZE, ylabel="|det J$_t$| [-]", xlim=(0, 3), ylim=(-0.03, 1.35))
    _legend(last, "upper right")


def _gain(run: Run) -> str:
    return f"{run.label} rad/s" if "k" in run.label else run.label


def _predicted(axes: Any, band: Band, label: str) -> None:
    used = band.high > 0
    limits = band.sizes[used], band.low[used], band.high[used]
    axes.fill_between(*limits, color=_SHADE, linewidth=0, label=label or None)


def _trace(axes: Any, run: Run, values: np.ndarray, colour: str, label: str) -> None:
    """Draw a line for each trajectory, its first and last point included."""
    x, y = [], []
    for first, end in zip(run.edges[:-1], run.edges[1:], strict=True):
        steps = np.append(np.arange(first, end - 1, _EVERY), end - 1)
        x += [run.sizes[steps], [np.nan]]
        y += [values[steps], [np.nan]]
    line = np.concatenate(x), np.concatenate(y)
    axes.plot(*line, color=colour, linewidth=0.45, alpha=0.75, label=label or None, rasterized=True)


def _legend(axes: Any, place: str) -> None:
    for handle in axes.legend(loc=place).get_lines():
        handle.set_linewidth(1.4)
