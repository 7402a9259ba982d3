"""The charts of which the figures of Papakonstantinou et al. 2021 are made."""

from __future__ import annotations

import numpy as np

from nullmotion.papers.papakonstantinou2021_flight import Flight
from nullmotion.plot import palette
from nullmotion.plot.parts import bundle, limited
from nullmotion.plot.view import Curve, Panel

_ANGLES, _AXES = ("yaw", "pitch", "roll"), ("x", "y", "z")


def attitude(run: Flight) -> Panel:
    """Yaw, pitch and roll."""
    curves = bundle(run.t, run.attitude_deg, _ANGLES)
    return Panel("attitude", "Attitude angle", "Angle [deg]", curves)


def body_rate(run: Flight) -> Panel:
    """Rate of the body."""
    assert run.run.omega_BN_B is not None
    curves = bundle(run.t, np.degrees(run.run.omega_BN_B), _AXES)
    return Panel("body_rate", "Angular velocity", "Rate [deg/s]", curves)


def momentum(run: Flight) -> Panel:
    """Momentum of the array."""
    curves = bundle(run.t, run.run.momentum, _AXES)
    return Panel("momentum", "CMG momentum", "Momentum [N m s]", curves)


def attitude_error(run: Flight) -> Panel:
    """Yaw, pitch and roll of the error quaternion."""
    curves = bundle(run.t, run.attitude_error_deg, _ANGLES)
    return Panel("attitude_error", "Attitude error", "Angle [deg]", curves)


def angles(run: Flight) -> Panel:
    """Gimbal angles."""
    curves = bundle(run.t, np.degrees(run.run.delta), _cmgs(run))
    return Panel("angles", "Gimbal angles", "Angle [deg]", curves)


def rates(run: Flight) -> Panel:
    """Gimbal rates within their limit."""
    curves = bundle(run.t, np.degrees(_held(run.run.rates)), _cmgs(run))
    limit = float(np.degrees(np.min(run.run.setup.array.rate_limit)))
    return limited(Panel("rates", "Gimbal rates", "Rate [deg/s]", curves), [limit], "deg/s")


def torque(run: Flight) -> Panel:
    """Torque of the array on the vehicle."""
    curves = bundle(run.t, _held(-run.run.torque), _AXES)
    return Panel("torque", "CMG torque", "On the vehicle [N m]", curves)


def null_motion(run: Flight) -> Panel:
    """The term of Eq 22 that the plan adds, before the rate limit."""
    curves = bundle(run.t, np.degrees(_held(run.null_motion)), _cmgs(run))
    return Panel("null_motion", "Null-motion term", "Rate [deg/s]", curves)


def momentum_error(run: Flight) -> Panel:
    """What is missing of the momentum asked for."""
    curves = bundle(run.t, run.momentum_error, _AXES)
    return Panel("momentum_error", "Momentum error", "h_c - h [N m s]", curves)


def manipulability(run: Flight) -> Panel:
    """The index of the cost with its threshold."""
    curve = Curve("w", run.t, run.manipulability, palette.colour(0))
    return index("manipulability", "Manipulability index", run, (curve,))


def index(key: str, title: str, run: Flight, curves: tuple[Curve, ...]) -> Panel:
    """Return curves of the index with its threshold."""
    formula = "det(A A^T)" if run.cost.index == "det" else "sqrt(det(A A^T))"
    ends, level = run.t[[0, -1]], np.full(2, run.cost.manipulability_threshold)
    threshold = Curve("threshold", ends, level, palette.QUIET, "longdash", 1.2)
    return Panel(key, title, f"w = {formula} [-]", (*curves, threshold))


def _held(values: np.ndarray) -> np.ndarray:
    """Return what acts from each instant on, that of the last step at the end of the run too."""
    return np.concatenate([values[:-1], values[-2:-1]])


def _cmgs(run: Flight) -> list[str]:
    return [str(i + 1) for i in range(run.run.delta.shape[1])]
