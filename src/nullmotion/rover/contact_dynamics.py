"""A free rigid body with one single-gimbal CMG, pushed by the ground.

    p' = v,   M v' = M g + sum_i F_i                       in ground axes N
    q' = 1/2 q * [0, omega]                                q_BN
    H  = J omega + I_G (omega + delta' g) + h s,           I_G = I_s s s^T + I_o o o^T + I_g g g^T
    H' + omega x H = sum_i c_i x (C_BN F_i)                in body axes B; F_i: `contact_forces`

with the spin axis s = s_0 cos(delta) + o_0 sin(delta), o = g x s and s' = delta' o; H' holds the
reaction h delta' o + I_g delta'' g and omega x H the base-rate torque omega x h s. J is the
chassis' inertia, I_G that of the CMG about its own axes (Elliott 2019, Eqs 72 and 75, there about
a pivot; 0 leaves it out). The mass centre of the CMG is the rover's. Ground axes: x up the slope,
z normal.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from nullmotion import linalg, ops, rotation
from nullmotion.rover.contact_state import Machine, State


class Motion(NamedTuple):
    """How the state changes, and what the motors do meanwhile.

    Attributes:
        change: Time derivative of the state.
        gimbal_power: T_g . omega_GB, what the gimbal motor puts in [W].
        rotor_power: h d(s . omega)/dt, what the rotor motor puts in to keep its speed [W].
    """

    change: State
    gimbal_power: Any
    rotor_power: Any


def motion(state: State, delta_ddot: Any, machine: Machine, push: Any) -> Motion:
    """Return how a state changes; on floats and symbols alike.

    Args:
        state: The state.
        delta_ddot: Gimbal acceleration [rad/s^2].
        machine: The rover.
        push: Force of the ground in N [N] and its torque about the mass centre in B [N m], (6,).
    """
    omega, delta_dot, h = state.rate, state.delta_dot, machine.momentum
    g, s, o = axes(machine, state.delta)
    I_s, I_g, I_o = machine.cmg_inertia
    I_G = I_s * np.outer(s, s) + I_o * np.outer(o, o) + I_g * np.outer(g, g)
    H = machine.inertia @ omega + I_G @ omega + I_g * delta_dot * g + h * s
    turned = (I_s - I_o) * delta_dot * (s * (o @ omega) + o * (s @ omega))  # I_G' omega
    reaction = turned + I_g * delta_ddot * g + h * delta_dot * o
    torque = push[3:] - linalg.cross(omega, H) - reaction
    omega_dot = linalg.solve(machine.inertia + I_G, torque)
    change = State(
        state.velocity,
        0.5 * rotation.doubled_rate(state.attitude, omega),
        machine.gravity + push[:3] / machine.mass,
        omega_dot,
        delta_dot,
        delta_ddot,
    )
    gyroscopic = (I_o - I_s) * (s @ omega) * (o @ omega) - h * (o @ omega)
    T_g = I_g * (delta_ddot + g @ omega_dot) + gyroscopic
    spun = s @ omega_dot + delta_dot * (o @ omega)  # rate of s . omega
    return Motion(change, T_g * delta_dot, h * spun)


def axes(machine: Machine, delta: Any) -> tuple[Any, Any, Any]:
    """Return gimbal axis g, spin axis s and output axis o = g x s in B."""
    g, s_0 = machine.gimbal_axis, machine.spin_axis
    o_0 = linalg.cross(g, s_0)
    cosine, sine = ops.cos(delta), ops.sin(delta)
    return g, cosine * s_0 + sine * o_0, cosine * o_0 - sine * s_0


def energy(state: State, machine: Machine) -> Any:
    """Return kinetic and potential energy, up to the spinning rotor's own [J]."""
    g, s, o = axes(machine, state.delta)
    I_s, I_g, I_o = machine.cmg_inertia
    omega, v = state.rate, state.velocity
    gimbal = g @ omega + state.delta_dot
    turning = omega @ machine.inertia @ omega + I_s * (s @ omega) * (s @ omega)
    turning = turning + I_o * (o @ omega) * (o @ omega) + I_g * gimbal * gimbal
    height = -(machine.gravity @ state.position)
    moving = machine.mass * (0.5 * (v @ v) + height)
    return 0.5 * turning + machine.momentum * (s @ omega) + moving
