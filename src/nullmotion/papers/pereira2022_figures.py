"""Figures 7 to 9 and 11 to 18 of Pereira 2022."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from nullmotion.array import layouts
from nullmotion.papers.pereira2022_cases import Flight
from nullmotion.papers.pereira2022_text import HOME, SINGULAR
from nullmotion.plot import palette, style
from nullmotion.plot.parts import bundle, limited
from nullmotion.plot.view import Curve, Panel

TORQUE = {11: "N = 1, no term", 12: "N = 1, term", 13: "N = 5, term"}
RATES = {14: "N = 1, no term", 15: "N = 1, term", 16: "N = 5, term"}
PATHS = {17: "N = 1, no term", 18: "N = 5, no term"}
COUNT = 3 + len(TORQUE) + len(RATES) + len(PATHS)
_RATE = 1.5  # [rad/s], Eq 25


def draw(folder: Path, flights: Mapping[str, Flight]) -> Iterator[Path]:
    """Draw all figures, one after another."""
    from nullmotion.plot.draw import save

    folder.mkdir(parents=True, exist_ok=True)
    lines, cube = singular_lines_within(np.full(3, -np.pi), np.full(3, np.pi)), "Figure 7"
    yield _in_space(folder / "figure_07.png", f"{cube}: singular lines", partial(_cube, lines))
    for number, delta, title in ((8, HOME, "regular"), (9, SINGULAR, "singular")):
        name = f"Figure {number}: torque envelope, {title} state"
        yield save([envelope(delta)], folder / f"figure_{number:02d}.png", columns=1, title=name)
    for number, case in TORQUE.items():
        name = f"Figure {number}: control torque and torque, {case}"
        yield save(torques(flights[case]), folder / f"figure_{number}.png", title=name)
    for number, case in RATES.items():
        name = f"Figure {number}: gimbal rates, {case}"
        yield save([rates(flights[case])], folder / f"figure_{number}.png", columns=1, title=name)
    for number, case in PATHS.items():
        flight = flights[case]
        name = f"Figure {number}: gimbal trajectory, {case}"
        yield _in_space(folder / f"figure_{number}.png", name, partial(_path, flight))


def singular_lines_within(low: np.ndarray, high: np.ndarray) -> list[tuple[np.ndarray, bool]]:
    """Return the ends (2, 3) of the triangle's singular lines in a box, and whether each is 3h.

    gamma_1 = gamma_3 - pi/3 + k_beta pi, gamma_2 = gamma_3 + pi/3 + k_gamma pi (Eq 21);
    3h where both k are odd.
    """
    turns = int(np.ceil(np.max(high - low) / np.pi)) + 1
    found = []
    for k_beta in range(-turns, turns + 1):
        for k_gamma in range(-turns, turns + 1):
            shift = np.array([(k_beta - 1 / 3) * np.pi, (k_gamma + 1 / 3) * np.pi, 0.0])
            first, last = np.max(low - shift), np.min(high - shift)
            if last - first > 1e-9:
                ends = np.array([shift + first, shift + last])
                found.append((ends, bool(k_beta % 2 and k_gamma % 2)))
    return found


def envelope(delta: tuple[float, ...]) -> Panel:
    """Torques of all gimbal rates within their limits: the sum of one segment a CMG."""
    J = layouts.create("triangle", h0=1.0).jacobian(np.array(delta))
    angles = np.linspace(0.0, 2 * np.pi, 721)
    directions = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    farthest = np.array([_RATE * J @ np.sign(d @ J) for d in directions])
    curve = Curve("envelope", farthest[:, 0], farthest[:, 1], palette.colour(0))
    return Panel("envelope", "Torque", "y [N m]", (curve,), x_title="x [N m]")


def torques(flight: Flight) -> list[Panel]:
    """Commanded and given rate of momentum about x and y."""
    found = []
    for i, axis in enumerate("xy"):
        pair = (("control torque", flight.run.hdot), ("torque", flight.run.torque))
        curves = tuple(
            Curve(label, flight.t, values[:-1, i], palette.colour(j), palette.dash(j))
            for j, (label, values) in enumerate(pair)
        )
        found.append(Panel(axis, f"About {axis}", "Rate of momentum [N m]", curves))
    return found


def rates(flight: Flight) -> Panel:
    """Gimbal rates within their limit."""
    curves = bundle(flight.t, flight.rates, ("1", "2", "3"))
    return limited(Panel("rates", "Gimbal rates", "Rate [rad/s]", curves), [_RATE], "rad/s")


def _cube(lines: list[tuple[np.ndarray, bool]], axes: Any) -> None:
    for ends, outer in lines:
        label = "3h" if outer else "1h"
        colour, dash = (palette.ALERT, "dash") if outer else (palette.colour(0), "solid")
        known = axes.get_legend_handles_labels()[1]
        axes.plot(
            *ends.T, color=colour, label=None if label in known else label,
            linewidth=1.0, linestyle=style.LINE_STYLES[dash],
        )  # fmt: skip


def _path(flight: Flight, axes: Any) -> None:
    delta = flight.run.delta
    room = 0.5 * np.ones(3)
    _cube(singular_lines_within(delta.min(axis=0) - room, delta.max(axis=0) + room), axes)
    axes.plot(*delta.T, color=palette.INK, linewidth=1.4, label="gimbals")
    axes.plot(*delta[:1].T, "o", color=palette.INK, markersize=3)


def _in_space(path: Path, title: str, fill: Callable[[Any], None]) -> Path:
    """Write a figure in gimbal space."""
    import matplotlib
    from matplotlib.figure import Figure

    part = path.with_name(f".{path.stem}.{os.getpid()}.part{path.suffix}")
    with matplotlib.rc_context(style.rc()):
        figure = Figure(figsize=(style.PANEL_WIDTH_IN * 1.4, style.PANEL_WIDTH_IN * 1.3))
        axes: Any = figure.add_subplot(projection="3d")
        fill(axes)
        axes.set_box_aspect(None, zoom=0.88)  # room for the label of the third axis
        axes.set(xlabel="γ₁ [rad]", ylabel="γ₂ [rad]", zlabel="γ₃ [rad]")
        axes.legend(loc="upper right")
        figure.suptitle(title, fontsize=10, fontweight="bold", x=0.01, ha="left")
        try:
            figure.savefig(part)
            part.replace(path)
        finally:
            part.unlink(missing_ok=True)
    return path
