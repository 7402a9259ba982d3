"""The charts of a comparison: one curve a case, or one curve a law over a varied value."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from nullmotion.plot import palette, quantities
from nullmotion.plot.attitude import pointing_errors, tolerance
from nullmotion.plot.events import marked
from nullmotion.plot.panels import NORMALISED, angles
from nullmotion.plot.parts import limited
from nullmotion.plot.quantities import (
    finite,
    motor_limits,
    of_attitude,
    rate_limits,
    steady_direction,
    torque_fractions,
    turns_wheels,
    wheel_tolerance,
)
from nullmotion.plot.view import Case, Curve, Level, Panel, Run
from nullmotion.plot.wheels import largest_wheel_error

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
    return momentum_norm(cases)


def sigma_min(cases: Sequence[Case]) -> Panel:
    """Least singular value."""

    def series(run: Run) -> np.ndarray:
        values = quantities.sigma_min(run)
        return np.full(len(run.t), np.nan) if values is None else values

    curves = overlay(cases, series)
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


def pointing_error(cases: Sequence[Case]) -> Panel:
    """Pointing error of each case."""
    levels = {level for _, case in shown(cases) for level in tolerance(case.trajectory)}
    curves = overlay(cases, pointing_errors)
    title, y_title = "Pointing error", "Error [deg]"
    return Panel("pointing_error", title, y_title, curves, tuple(levels), log=True)


def torque_missed(cases: Sequence[Case]) -> Panel:
    """Difference of the torque given and asked."""
    curves = overlay(cases, lambda run: np.linalg.norm(run.torque - run.hdot, axis=1))
    note = "Length of A·δ̇ − ḣ: what the array did not give, or gave beside it."
    return Panel("torque_missed", "Torque error", "Torque [N m]", curves, note=note)


def momentum_norm(cases: Sequence[Case]) -> Panel:
    """Norm of the array's momentum."""
    curves = overlay(cases, lambda run: np.linalg.norm(run.momentum, axis=1))
    return Panel("momentum", "Momentum of the array", "|h| [N m s]", curves)


def largest_motor_torque(cases: Sequence[Case]) -> Panel:
    """Largest torque of a gimbal motor at each time."""
    curves = overlay(cases, lambda run: np.max(np.abs(run.motor_torque), axis=1))
    limits = {limit for _, case in shown(cases) for limit in motor_limits(case.trajectory)}
    panel = Panel("motor_torque", "Largest gimbal motor torque", "max |torque| [N m]", curves)
    return limited(panel, sorted(limits), "N m")


def wheel_error(cases: Sequence[Case]) -> Panel:
    """Largest relative error of a wheel's speed at each time."""
    ran = [case.trajectory for _, case in shown(cases) if turns_wheels(case.trajectory)]
    curves = overlay(cases, largest_wheel_error) if ran else ()
    levels = {100.0 * v for v in map(wheel_tolerance, ran) if v is not None}
    lines = tuple(Level(v, f"tolerance {v:.3g} %") for v in sorted(levels))
    title, y_title = "Largest wheel speed error", "Share of design speed [%]"
    return Panel("wheel_error", title, y_title, curves, lines, log=True)


def largest_wheel_torque(cases: Sequence[Case]) -> Panel:
    """Largest torque of a wheel motor at each time."""
    ran = [case.trajectory for _, case in shown(cases) if turns_wheels(case.trajectory)]
    curves = overlay(cases, _largest_wheel_torque) if ran else ()
    limits = {v for run in ran for v in finite(run.setup.array.flywheels.torque_limit)}
    panel = Panel("wheel_torque", "Largest wheel motor torque", "max |torque| [N m]", curves)
    return limited(panel, sorted(limits), "N m") if curves else panel


def _largest_wheel_torque(run: Run) -> np.ndarray:
    if not turns_wheels(run):
        return np.full(len(run.t), np.nan)
    largest: np.ndarray = np.max(np.abs(run.wheel_motor_torque), axis=1)
    return largest


OVERLAYS = (momentum_along, sigma_min, off_axis, largest_rate)
ATTITUDE_OVERLAYS = (
    pointing_error,
    torque_missed,
    sigma_min,
    momentum_norm,
    largest_rate,
    largest_motor_torque,
    wheel_error,
    largest_wheel_torque,
)


def overlays(cases: Sequence[Case]) -> list[Panel]:
    """Return the overlaid charts of a comparison; empty when no case ran."""
    ran = [case.trajectory for _, case in shown(cases)]
    if not ran:
        return []
    made = ATTITUDE_OVERLAYS if of_attitude(ran[0]) else OVERLAYS
    panels = [panel for panel in (make(cases) for make in made) if panel.curves]
    return marked(panels, max(ran, key=lambda run: float(run.t[-1])))


def angle_panels(cases: Sequence[Case]) -> list[Panel]:
    """Return the gimbal angles of each case: small multiples."""
    made = []
    for i, case in shown(cases):
        panel = angles(case.trajectory)
        made.append(Panel(f"angles_{i}", case.label, panel.y_title, panel.curves))
    return made
