"""Equations of a step about an edge, on floats, arrays and CasADi's symbols alike.

Body and CMG turn about r with theta; the gimbal turns in the body with delta. In the gimbal's
axes s, g, o the CMG's angular velocity is w and its momentum K:

    w = (theta' r.s, theta' r.g + delta', theta' r.o)      K = (A_s w_s + h, A_g w_g, A_o w_o)
    T = dK/dt + w x K                                       what drives the CMG      (Eq 75)
    N theta'' + T.r = M (cm/o x g).r                        motion about the edge    (Eqs 72-74)
    tau_off = -T.f                                          off-axis torque          (Eq 79)
    tau_DTa = B.f + M (cm/a x (a - g)).f                    dynamic threshold        (Eqs 80, 83)

B is the rate of the body's own momentum, a the acceleration of the mass centre, f points forward.
T holds the base-rate torque h theta' (r x s). tau_DTa - tau_off is the edge's length times the
load on spike b, tau_off - tau_DTb that on spike a. Without A, T = h (delta' o + theta' r x s).
Signs: theta is positive forward, delta about g, o = g x s. SI and radians.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from nullmotion.rover.step_model import StepModel

Value = Any  # a float, an array or a symbol


class State(NamedTuple):
    """Where body and gimbal are: angles [rad], rates [rad/s], gimbal acceleration [rad/s^2]."""

    theta: Value
    theta_dot: Value
    delta: Value
    delta_dot: Value
    delta_ddot: Value


class Thresholds(NamedTuple):
    """Off-axis torque and the dynamic thresholds at both spikes [N m]."""

    tau_off: Value
    tau_DTa: Value
    tau_DTb: Value

    @property
    def spare(self) -> tuple[Value, Value]:
        """What is left before spike b, and spike a, lifts off [N m]: the rows of C in Eq 84."""
        return self.tau_DTa - self.tau_off, self.tau_off - self.tau_DTb


def along(model: StepModel, delta: Value, axis: int) -> tuple[Value, Value, float]:
    """Return the components of s, g, o along axis 0, 1, 2: f, r, p turned with the body."""
    c, s = _turn(delta)
    s0, o0 = model.s0[axis], model.o0[axis]
    return c * s0 + s * o0, model.g[axis], c * o0 - s * s0


def dot(a: tuple[Value, ...], b: tuple[Value, ...]) -> Value:
    """Return the inner product of two triples."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def authority(model: StepModel, delta: Value) -> Value:
    """Return o . r, by which the CMG drives the step."""
    return along(model, delta, 1)[2]


def cmg_rates(model: StepModel, state: State, theta_ddot: Value) -> tuple[Value, Value, Value]:
    """Return dw/dt along s, g, o [rad/s^2]."""
    r_s, r_g, r_o = along(model, state.delta, 1)
    turning = state.theta_dot * state.delta_dot
    return (
        theta_ddot * r_s + turning * r_o,
        theta_ddot * r_g + state.delta_ddot,
        theta_ddot * r_o - turning * r_s,
    )


def cmg_torque(model: StepModel, state: State, theta_ddot: Value) -> tuple[Value, Value, Value]:
    """Return T, what the body exerts on the CMG, along s, g, o [N m] (Eq 75)."""
    r_s, r_g, r_o = along(model, state.delta, 1)
    A_s, A_g, A_o = model.A
    w_s, w_g, w_o = (
        state.theta_dot * r_s,
        state.theta_dot * r_g + state.delta_dot,
        state.theta_dot * r_o,
    )
    K_s, K_g, K_o = A_s * w_s + model.h, A_g * w_g, A_o * w_o
    dw_s, dw_g, dw_o = cmg_rates(model, state, theta_ddot)
    return (
        A_s * dw_s + w_o * K_g - w_g * K_o,
        A_g * dw_g + w_s * K_o - w_o * K_s,
        A_o * dw_o + w_g * K_s - w_s * K_g,
    )


def com(model: StepModel, theta: Value) -> tuple[Value, Value]:
    """Return cm/o along f and p [m]."""
    c, s = _turn(theta)
    x, _, z = model.com
    return c * x + s * z, c * z - s * x


def gravity_torque(model: StepModel, theta: Value) -> Value:
    """Return M (cm/o x g) . r [N m]: -M g d sin(alpha + incline - theta) straight uphill."""
    c_f, c_p = com(model, theta)
    return model.mass * (c_p * model.gravity[0] - c_f * model.gravity[2])


def inertia(model: StepModel, delta: Value) -> Value:
    """Return the inertia about the edge with the CMG [kg m^2]."""
    r_s, r_g, r_o = along(model, delta, 1)
    A_s, A_g, A_o = model.A
    return model.N + A_s * r_s**2 + A_g * r_g**2 + A_o * r_o**2


def acceleration(model: StepModel, state: State) -> Value:
    """Return theta'' of a step that only the edge holds [rad/s^2] (Eqs 72-74)."""
    T = cmg_torque(model, state, 0.0)
    driven = dot(T, along(model, state.delta, 1))
    return (gravity_torque(model, state.theta) - driven) / inertia(model, state.delta)


def thresholds(model: StepModel, state: State, theta_ddot: Value) -> Thresholds:
    """Return off-axis torque and dynamic thresholds (Eqs 79, 80, 83) [N m]."""
    c, s = _turn(state.theta)
    T = cmg_torque(model, state, theta_ddot)
    x, z = (
        sum(t * a for t, a in zip(T, along(model, state.delta, axis), strict=True))
        for axis in (0, 2)
    )
    J_x, J_z = model.coupling
    square = state.theta_dot**2
    B = c * (theta_ddot * J_x + square * J_z) + s * (theta_ddot * J_z - square * J_x)
    c_f, c_p = com(model, state.theta)
    lift = -theta_ddot * c_f - square * c_p - model.gravity[2]
    fixed = B + model.mass * c_p * model.gravity[1]
    arms = (model.com[1] + model.half_edge, model.com[1] - model.half_edge)
    tau_DTa, tau_DTb = (fixed + model.mass * arm * lift for arm in arms)
    return Thresholds(-(c * x + s * z), tau_DTa, tau_DTb)


def _turn(angle: Value) -> tuple[Value, Value]:
    """Return cosine and sine; NumPy's functions warn on CasADi's symbols."""
    if isinstance(angle, float):
        return math.cos(angle), math.sin(angle)
    if hasattr(angle, "cos"):
        return angle.cos(), angle.sin()
    return np.cos(angle), np.sin(angle)
