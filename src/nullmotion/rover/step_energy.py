"""Energy and motor powers of a step.

    E     = integral of |T_r . w_R/G| + |T_g . w_G/B| dt                              (Eq 88)
    total = 1/2 N theta'^2 + 1/2 w . A w + h w_s - M g . cm/o

The rotor's motor keeps its speed against the gimbal and so does the work h dw_s; the gimbal's motor
exerts T . g. The two works, signed, are the change of the total. Eq 88's rotor term uses rotor
inertia times speed, which Table 2 gives as 112 N m s beside h = 115.
"""

from __future__ import annotations

from nullmotion.rover.step_dynamics import State, Value, along, cmg_rates, cmg_torque, com
from nullmotion.rover.step_model import StepModel


def total_energy(model: StepModel, state: State) -> Value:
    """Return kinetic and potential energy, up to the spinning rotor's own [J]."""
    r_s, r_g, r_o = along(model, state.delta, 1)
    A_s, A_g, A_o = model.A
    w_s, w_g, w_o = (
        state.theta_dot * r_s,
        state.theta_dot * r_g + state.delta_dot,
        state.theta_dot * r_o,
    )
    own = A_s * w_s**2 + A_g * w_g**2 + A_o * w_o**2
    c_f, c_p = com(model, state.theta)
    height = -(model.gravity[0] * c_f + model.gravity[2] * c_p)
    return (model.N * state.theta_dot**2 + own) / 2 + model.h * w_s + model.mass * height


def motor_powers(model: StepModel, state: State, theta_ddot: Value) -> tuple[Value, Value]:
    """Return the signed powers of gimbal and rotor motor [W]."""
    gimbal = cmg_torque(model, state, theta_ddot)[1] * state.delta_dot
    return gimbal, model.h * cmg_rates(model, state, theta_ddot)[0]


def used_power(model: StepModel, state: State, theta_ddot: Value) -> Value:
    """Return the integrand of Eq 88 [W]."""
    gimbal = cmg_torque(model, state, theta_ddot)[1] * state.delta_dot
    rotor = model.h_rotor * cmg_rates(model, state, theta_ddot)[0]
    return abs(gimbal) + abs(rotor)
