"""The charts that a run has when it turns a spacecraft."""

from __future__ import annotations

import numpy as np

from nullmotion import rotation
from nullmotion.plot import palette
from nullmotion.plot.parts import bundle, limited, with_norm
from nullmotion.plot.quantities import cmg_names, motor_limits, tolerance_deg
from nullmotion.plot.view import Curve, Level, Panel, Run

LEAST_DEG = 1e-7  # pointing errors below are nobody's and would only stretch the axis
_ANGLES = ("yaw", "pitch", "roll")
_STEEP = 85.0  # pitch [deg] from which yaw and roll say little


def pointing_errors(run: Run) -> np.ndarray:
    """Return the pointing error for a logarithmic axis [deg], (k,)."""
    degrees: np.ndarray = np.degrees(run.pointing_error)
    return np.maximum(degrees, LEAST_DEG)


def tolerance(run: Run) -> tuple[Level, ...]:
    """Return the line of the pointing error that counts as settled."""
    allowed = tolerance_deg(run)
    return () if allowed is None else (Level(allowed, f"tolerance {allowed:.4g} deg"),)


def pointing_error(run: Run) -> Panel:
    """Angle between the attitude and the one asked for."""
    values = pointing_errors(run)
    note = f"Errors below {LEAST_DEG:g} deg are drawn there." if (values == LEAST_DEG).any() else ""
    curve = Curve("pointing error", run.t, values, palette.colour(0), width=2.0)
    title, y_title = "Pointing error", "Error [deg]"
    return Panel("pointing_error", title, y_title, (curve,), tolerance(run), note, log=True)


def euler_angles(run: Run) -> Panel:
    """Yaw, pitch and roll with those asked for."""
    angles, asked = _euler_deg(run.q_BN), _euler_deg(run.reference)
    curves = []
    for i, name in enumerate(_ANGLES):
        hue = palette.colour(i)
        curves.append(Curve(name, run.t, _broken(angles[i]), hue))
        curves.append(Curve(f"{name} asked", run.t, _broken(asked[i]), hue, "dash", 1.2))
    note = "Euler angles 3-2-1 of the body in the inertial frame."
    if np.nanmax(np.abs(angles[1]), initial=0.0) > _STEEP:
        note += " Near a pitch of 90 deg yaw and roll jump; the attitude does not."
    return Panel("attitude", "Attitude", "Angle [deg]", tuple(curves), note=note)


def body_rate(run: Run) -> Panel:
    """Rate of the body, in its own axes."""
    curves = with_norm(run.t, np.degrees(run.omega_BN_B), "xyz")
    return Panel("body_rate", "Body rate", "Rate [deg/s]", curves)


def inertial_momentum(run: Run) -> Panel:
    """Angular momentum of spacecraft and array; no curves where nothing from outside changes it."""
    outside = run.setup.disturbance is not None or run.setup.desaturation is not None
    curves = with_norm(run.t, run.inertial_momentum, "xyz") if outside else ()
    note = "Of spacecraft and array, in the inertial frame: only torques from outside change it."
    title = "Total angular momentum"
    return Panel("inertial_momentum", title, "Momentum [N m s]", curves, note=note)


def motor_torque(run: Run) -> Panel:
    """Torque of each gimbal motor with its limit."""
    curves = bundle(run.t, run.motor_torque, cmg_names(run))
    panel = Panel("motor_torque", "Gimbal motor torque", "Torque [N m]", curves)
    return limited(panel, motor_limits(run), "N m")


def motor_power(run: Run) -> Panel:
    """Mechanical power of all gimbal motors."""
    power = np.abs(run.motor_torque * run.rates).sum(axis=1)
    curve = Curve("all motors", run.t, power, palette.colour(0))
    note = "Mechanical, of all motors; what a motor takes back is not counted against it."
    return Panel("motor_power", "Gimbal motor power", "Power [W]", (curve,), note=note)


def _euler_deg(q: np.ndarray) -> np.ndarray:
    """Return yaw, pitch and roll [deg], (3, k)."""
    return np.degrees(np.asarray(rotation.euler_321(q.T)))


def _broken(angle: np.ndarray) -> np.ndarray:
    """Return an angle with a gap where it goes over from 180 to -180 deg."""
    return np.where(np.abs(np.diff(angle, prepend=angle[0])) > 180.0, np.nan, angle)
