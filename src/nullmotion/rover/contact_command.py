"""What moves the gimbal in the contact simulation: the tracking controller, or a history.

    delta_c' = (M (cm/o x g).r - N (k_p e + k_d e' + theta_r'')) / (h o.r)            (Eq 87)
    delta''  = k_g (delta_c' - delta')                      rate and acceleration within limits

with e = theta_r - theta: `tracking`, with theta measured on the rover that moves freely. A history
is followed as delta'' = delta_r'' + k_g (delta_r' - delta') + (k_g/2)^2 (delta_r - delta). Once the
rover has landed the gimbal is braked to rest.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from nullmotion import ops
from nullmotion.rover import step_dynamics
from nullmotion.rover.step_model import StepModel

_LEAST = 1e-3  # |o.r| below which Eq 87 asks for more than any gimbal gives


class Measured(NamedTuple):
    """What the law measures: angle about the edge and gimbal [rad], and their rates [rad/s]."""

    theta: Any
    theta_dot: Any
    delta: Any
    delta_dot: Any


class Told(NamedTuple):
    """What the law is told at a time: whether to act (1 or 0), plan or history."""

    acts: Any
    theta: Any
    theta_dot: Any
    theta_ddot: Any
    delta: Any
    delta_dot: Any
    delta_ddot: Any


class Numbers(NamedTuple):
    """Parameters of the laws: model of the step, gains, limits of the gimbal."""

    model: StepModel
    k_p: float
    k_d: float
    k_g: float
    rate_limit: float
    acceleration_limit: float


Law = Callable[[Any, Any, Measured], Any]  # what it is told, its numbers -> delta'' [rad/s^2]


def tracking(told: Any, numbers: Numbers, measured: Measured) -> Any:
    """Return delta'' of the tracking controller [rad/s^2]."""
    wanted, p, m = Told(*told), numbers, measured
    e, e_dot = wanted.theta - m.theta, wanted.theta_dot - m.theta_dot
    torque = step_dynamics.gravity_torque(p.model, m.theta)
    torque = torque - p.model.N * (p.k_p * e + p.k_d * e_dot + wanted.theta_ddot)
    drive = step_dynamics.authority(p.model, m.delta)
    drive = ops.copysign(ops.maximum(ops.absolute(drive), _LEAST), drive)
    rate = torque / (p.model.h * drive)
    rate = wanted.acts * ops.clip(rate, -p.rate_limit, p.rate_limit)
    a = p.acceleration_limit
    return ops.clip(p.k_g * (rate - m.delta_dot), -a, a)


def history(told: Any, numbers: Numbers, measured: Measured) -> Any:
    """Return delta'' that follows a history [rad/s^2]."""
    wanted, p, m = Told(*told), numbers, measured
    w = 0.5 * p.k_g
    follow = wanted.delta_ddot + p.k_g * (wanted.delta_dot - m.delta_dot)
    follow = follow + w * w * (wanted.delta - m.delta)
    brake = -p.k_g * m.delta_dot
    a = p.acceleration_limit
    return ops.clip(wanted.acts * follow + (1.0 - wanted.acts) * brake, -a, a)
