"""The charts of one run."""

from __future__ import annotations

import numpy as np

from nullmotion.plot import palette
from nullmotion.plot.quantities import (
    axis_names,
    cmg_names,
    rate_limits,
    stop_level,
    torque_fractions,
)
from nullmotion.plot.view import Curve, Level, Panel, Run, bundle

NEAR_LIMIT = 0.2  # share of the rate limit from which its line leaves room for the curves
NORMALISED = "for A divided by the mean momentum of the working CMGs"


def torque(run: Run) -> Panel:
    """Torque asked and given, per axis."""
    curves = []
    for i, name in enumerate(axis_names(run)):
        hue = palette.colour(i)
        curves.append(Curve(f"{name} given", run.t, run.torque[:, i], hue))
        curves.append(Curve(f"{name} asked", run.t, run.hdot[:, i], hue, "dash", 1.2))
    note = "Rate of the array's momentum, A·δ̇; the vehicle gets its negative."
    return Panel("torque", "Torque asked and given", "Torque [N m]", tuple(curves), note=note)


def torque_error(run: Run) -> Panel:
    """Torque missing along the command and appearing across it, in percent of the command."""
    along, across = torque_fractions(run)
    curves = (
        Curve("across (off-axis)", run.t, 100 * across, palette.colour(1)),
        Curve("along, missing", run.t, 100 * (1 - along), palette.colour(0), "dash"),
    )
    return Panel("torque_error", "Torque error", "Share of command [%]", curves)


def momentum(run: Run) -> Panel:
    """Momentum of the array: components and norm."""
    curves = bundle(run.t, run.momentum, axis_names(run))
    norm = np.linalg.norm(run.momentum, axis=1)
    whole = Curve("norm", run.t, norm, palette.INK, width=2.4)
    return Panel("momentum", "Momentum of the array", "Momentum [N m s]", (*curves, whole))


def momentum_norm(run: Run) -> Panel:
    """Norm of the array's momentum alone."""
    norm = np.linalg.norm(run.momentum, axis=1)
    curve = Curve("norm", run.t, norm, palette.colour(0))
    return Panel("momentum_norm", "Total momentum", "|h| [N m s]", (curve,))


def rates(run: Run) -> Panel:
    """Gimbal rates with their limits; a limit far off is said, not drawn."""
    low, high = np.nanmin(run.rates, initial=0.0), np.nanmax(run.rates, initial=0.0)
    levels, far = [], []
    for limit in rate_limits(run):
        words = f"limit {np.degrees(limit):.4g} deg/s"
        if max(high, -low) < NEAR_LIMIT * limit:
            far.append(words)
            continue
        levels.append(Level(np.degrees(limit), words))
        if low < -NEAR_LIMIT * limit:
            levels.append(Level(-np.degrees(limit), ""))
    curves = bundle(run.t, np.degrees(run.rates), cmg_names(run))
    note = f"Far below the {', '.join(far)}." if far else ""
    return Panel("rates", "Gimbal rates", "Rate [deg/s]", curves, tuple(levels), note)


def angles(run: Run) -> Panel:
    """Gimbal angles."""
    curves = bundle(run.t, np.degrees(run.delta), cmg_names(run))
    return Panel("angles", "Gimbal angles", "Angle [deg]", curves)


def measures(run: Run) -> Panel:
    """Distance from singularity: least singular value and manipulability."""
    names = [name for name in ("sigma_min", "sqrt_det_AAT") if name in run.measures]
    columns = np.stack([run.measures[name] for name in names], axis=1) if names else None
    curves = () if columns is None else bundle(run.t, columns, names)
    title = "Singularity measures"
    return Panel(
        "measures", title, "Measure [-]", curves, note=f"Zero at a singular state; {NORMALISED}."
    )


def residual(run: Run) -> Panel:
    """Effective residual momentum of each CMG (Mao 2019, Eq 28)."""
    eram = getattr(run, "eram", None)
    curves = () if eram is None else bundle(run.t, np.asarray(eram, float), cmg_names(run))
    note = "How much each CMG can still turn towards the command: 1 is most, 0 nothing left."
    title = "Effective residual momentum"
    return Panel("residual", title, "eram [-]", curves, note=note)


def state(run: Run) -> Panel:
    """Momentum state and its parts, with the threshold at which the run stops."""
    labels = {"momentum_state": "momentum state", "residual_momentum": "sum of eram"}
    names = [name for name in labels if name in run.measures]
    curves = tuple(
        Curve(labels[name], run.t, run.measures[name], palette.colour(i), palette.dash(i))
        for i, name in enumerate(names)
    )
    level = stop_level(run, "momentum_state")
    levels = () if level is None else (Level(level, f"stops below {level:.4g}"),)
    note = "Sum of the effective residual momenta plus sigma_min: near 0 the momentum is used up."
    return Panel("state", "Momentum state", "State [-]", curves, levels, note)


RUN_PANELS = (torque, torque_error, momentum, rates, angles, measures, residual, state)
LITERATURE_PANELS = (torque, momentum_norm, rates, angles, residual, measures)


def run_panels(run: Run) -> list[Panel]:
    """Return all charts of a run that have something to show."""
    return [panel for panel in (make(run) for make in RUN_PANELS) if panel.curves]
