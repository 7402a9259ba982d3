"""The charts of a comparison: one curve a case, or one curve a law over a varied value."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from nullmotion.plot import palette
from nullmotion.plot.panels import NORMALISED, angles
from nullmotion.plot.quantities import rate_limits, steady_direction, torque_fractions
from nullmotion.plot.view import Case, Curve, Level, Panel, Run

Series = Callable[[Run], np.ndarray]


def shown(cases: Sequence[Case]) -> list[tuple[int, Case]]:
    """Return the cases that ran, each with its place, which fixes its colour and dash."""
    return [(i, case) for i, case in enumerate(cases) if case.trajectory is not None]


def overlay(cases: Sequence[Case], series: Series) -> tuple[Curve, ...]:
    """Return one curve a case."""
    return tuple(
        Curve(
            case.label,
            case.trajectory.t,
            series(case.trajectory),
            palette.colour(i),
            palette.dash(i),
        )
        for i, case in shown(cases)
    )


def momentum_along(cases: Sequence[Case]) -> Panel:
    """Momentum along the command; its norm where the command turns."""
    ran = [case.trajectory for _, case in shown(cases)]
    if ran and all(steady_direction(run) is not None for run in ran):
        curves = overlay(cases, lambda run: run.momentum @ steady_direction(run))
        return Panel("momentum", "Momentum along the command", "Momentum [N m s]", curves)
    curves = overlay(cases, lambda run: np.linalg.norm(run.momentum, axis=1))
    return Panel("momentum", "Momentum of the array", "|h| [N m s]", curves)


def sigma_min(cases: Sequence[Case]) -> Panel:
    """Least singular value."""
    curves = overlay(cases, lambda run: run.measures.get("sigma_min", np.full(len(run.t), np.nan)))
    note = f"Zero at a singular state; {NORMALISED}."
    return Panel("sigma_min", "Least singular value", "sigma_min [-]", curves, note=note)


def off_axis(cases: Sequence[Case]) -> Panel:
    """Torque across the command in percent of it."""
    curves = overlay(cases, lambda run: 100 * torque_fractions(run)[1])
    return Panel("off_axis", "Off-axis torque", "Share of command [%]", curves)


def largest_rate(cases: Sequence[Case]) -> Panel:
    """Largest gimbal rate at each time."""
    curves = overlay(cases, lambda run: np.degrees(np.max(np.abs(run.rates), axis=1)))
    limits = {limit for _, case in shown(cases) for limit in rate_limits(case.trajectory)}
    levels = tuple(Level(np.degrees(v), f"limit {np.degrees(v):.4g} deg/s") for v in sorted(limits))
    return Panel("largest_rate", "Largest gimbal rate", "max |rate| [deg/s]", curves, levels)


OVERLAYS = (momentum_along, sigma_min, off_axis, largest_rate)


def overlays(cases: Sequence[Case]) -> list[Panel]:
    """Return the overlaid charts of a comparison; empty when no case ran."""
    return [panel for panel in (make(cases) for make in OVERLAYS) if panel.curves]


def angle_panels(cases: Sequence[Case]) -> list[Panel]:
    """Return the gimbal angles of each case: small multiples."""
    made = []
    for i, case in shown(cases):
        panel = angles(case.trajectory)
        made.append(Panel(f"angles_{i}", case.label, panel.y_title, panel.curves))
    return made
