"""The charts of one run."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from nullmotion.plot import attitude, palette, wheels
from nullmotion.plot.events import marked
from nullmotion.plot.parts import bundle, limited, with_norm
from nullmotion.plot.quantities import (
    SINGULAR,
    axis_names,
    cmg_names,
    of_attitude,
    rate_limits,
    stop_level,
    torque_fractions,
    turns_wheels,
)
from nullmotion.plot.view import Curve, Level, Panel, Run

NORMALISED = "for A divided by the mean momentum of the working CMGs"


def torque(run: Run) -> Panel:
    """Torque asked and given, per axis."""
    curves = []
    for i, name in enumerate(axis_names(run)):
        hue = palette.colour(i)
        curves.append(Curve(f"{name} given", run.t, run.torque[:, i], hue))
        curves.append(Curve(f"{name} asked", run.t, run.hdot[:, i], hue, "dash", 1.2))
    given = "A·δ̇ + C_W·I·Ω̇" if turns_wheels(run) else "A·δ̇"
    note = f"Rate of the array's momentum, {given}; the vehicle gets its negative."
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
    curves = with_norm(run.t, run.momentum, axis_names(run))
    return Panel("momentum", "Momentum of the array", "Momentum [N m s]", curves)


def momentum_norm(run: Run) -> Panel:
    """Norm of the array's momentum alone."""
    norm = np.linalg.norm(run.momentum, axis=1)
    curve = Curve("norm", run.t, norm, palette.colour(0))
    return Panel("momentum_norm", "Total momentum", "|h| [N m s]", (curve,))


def rates(run: Run) -> Panel:
    """Gimbal rates with their limits; a limit far off is said, not drawn."""
    curves = bundle(run.t, np.degrees(run.rates), cmg_names(run))
    limits = [np.degrees(limit) for limit in rate_limits(run)]
    return limited(Panel("rates", "Gimbal rates", "Rate [deg/s]", curves), limits, "deg/s")


def angles(run: Run) -> Panel:
    """Gimbal angles."""
    curves = bundle(run.t, np.degrees(run.delta), cmg_names(run))
    return Panel("angles", "Gimbal angles", "Angle [deg]", curves)


def measures(run: Run) -> Panel:
    """Distance from singularity: least singular value and manipulability."""
    columns = {n: run.measures[n] for n in ("sigma_min", "sqrt_det_AAT") if n in run.measures}
    note = f"Zero at a singular state; {NORMALISED}."
    curves = bundle(run.t, np.stack([*columns.values()], 1), [*columns]) if columns else ()
    levels = (Level(SINGULAR, f"singular below {SINGULAR:g}"),) * of_attitude(run)
    return Panel("measures", "Singularity measures", "Measure [-]", curves, levels, note)


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
ATTITUDE_PANELS = (
    attitude.pointing_error,
    attitude.euler_angles,
    attitude.body_rate,
    torque,
    rates,
    angles,
    measures,
    momentum,
    attitude.inertial_momentum,
    attitude.motor_torque,
    attitude.motor_power,
)
WHEEL_PANELS = (
    attitude.pointing_error,
    wheels.wheel_speeds,
    wheels.wheel_torques,
    rates,
    attitude.body_rate,
    torque,
    attitude.euler_angles,
    angles,
    wheels.wheel_errors,
    measures,
    momentum,
    attitude.inertial_momentum,
    attitude.motor_torque,
    wheels.lyapunov,
)
WHEELS_ALONE = (wheels.wheel_speeds, wheels.wheel_torques)  # without a spacecraft
LITERATURE_PANELS = (torque, momentum_norm, rates, angles, residual, measures)
ATTITUDE_FIGURE = (*ATTITUDE_PANELS[:7], attitude.motor_torque)
WHEEL_FIGURE = WHEEL_PANELS[:8]


def run_panels(run: Run) -> list[Panel]:
    """Return all charts of a run that have something to show."""
    if not turns_wheels(run):
        return _shown(ATTITUDE_PANELS if of_attitude(run) else RUN_PANELS, run)
    made = _shown(WHEEL_PANELS if of_attitude(run) else (*WHEELS_ALONE, *RUN_PANELS), run)
    return made + marked(wheels.learned(run), run)


def figure_panels(run: Run) -> list[Panel]:
    """Return the charts that the field shows of a run: of its attitude, or of its torque."""
    if turns_wheels(run):
        return _shown(
            WHEEL_FIGURE if of_attitude(run) else (*WHEELS_ALONE, *LITERATURE_PANELS), run
        )
    return _shown(ATTITUDE_FIGURE if of_attitude(run) else LITERATURE_PANELS, run)


def _shown(made: Sequence[Callable[[Run], Panel]], run: Run) -> list[Panel]:
    panels = marked([panel for panel in (make(run) for make in made) if panel.curves], run)
    return wheels.shaded(panels, run)
