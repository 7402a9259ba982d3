"""What is watched during a contact simulation, and added up after it."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from nullmotion import ops, rotation
from nullmotion.rover.contact_command import Law, Measured
from nullmotion.rover.contact_dynamics import energy, motion
from nullmotion.rover.contact_forces import GroundNumbers
from nullmotion.rover.contact_state import Machine, State


class Setting(NamedTuple):
    """What stays as it is between two events.

    Attributes:
        machine: The rover and gravity.
        ground: The ground.
        start: q_BN in the attitude from which angles count, (4,).
        edge: r, the edge of the step in body axes, (3,).
        numbers: The law's parameters, a record.
    """

    machine: Machine
    ground: GroundNumbers
    start: np.ndarray
    edge: np.ndarray
    numbers: Any


class Signals(NamedTuple):
    """Signals at one time, or over times in the first axis.

    Attributes:
        theta: Angle turned about the edge [rad].
        theta_dot: omega . r [rad/s].
        tilt: Angle of the turn that is left beside it [rad].
        delta_ddot: Gimbal acceleration [rad/s^2].
        gimbal_power: Power of the gimbal motor, signed [W].
        rotor_power: Power of the rotor motor, signed [W].
        used_power: Integrand of Eq 88 [W].
        energy: Kinetic and potential energy [J].
        dissipated: Power lost in the ground [W].
        stored: Energy in the ground's springs [J].
        sinkage: Of each spike; negative above the ground [m], (..., V).
        normal: What each spike carries, or would if it did [N], (..., V).
        sliding: What friction lacks to hold each spike; below 0 it holds [N], (..., V).
        force: Ground's force on each spike in ground axes [N], (..., V, 3).
    """

    theta: Any
    theta_dot: Any
    tilt: Any
    delta_ddot: Any
    gimbal_power: Any
    rotor_power: Any
    used_power: Any
    energy: Any
    dissipated: Any
    stored: Any
    sinkage: Any
    normal: Any
    sliding: Any
    force: Any

    @staticmethod
    def row(body: np.ndarray, ground: np.ndarray) -> np.ndarray:
        """Return signals in a row, from `Body` (8,) and `Touch` of each spike (11, V)."""
        sums = ground[[10, 9]].sum(axis=1)
        return np.concatenate([body, sums, ground[6:9].ravel(), ground[:3].T.ravel()])

    @classmethod
    def split(cls, rows: np.ndarray) -> Signals:
        """Return the signals in rows of numbers, (..., 10 + 6 V)."""
        V = (rows.shape[-1] - 10) // 6
        sinkage, normal, sliding, force = np.split(rows[..., 10:], [V, 2 * V, 3 * V], axis=-1)
        force = force.reshape(*force.shape[:-1], V, 3)
        return cls._make([*np.moveaxis(rows[..., :10], -1, 0), sinkage, normal, sliding, force])


def measured(state: State, setting: Setting) -> tuple[Measured, Any]:
    """Return what the law measures, and the tilt off the edge.

    The turn since the start is split into one about an axis square to r, the tilt, and one about r.
    """
    q = rotation.multiply(rotation.conjugate(setting.start), state.attitude)
    along = q[1:] @ setting.edge
    off = q[1:] - along * setting.edge
    theta = 2.0 * ops.atan2(along, q[0])
    tilt = 2.0 * ops.atan2(ops.sqrt(off @ off), ops.sqrt(q[0] * q[0] + along * along))
    theta_dot = state.rate @ setting.edge
    return Measured(theta, theta_dot, state.delta, state.delta_dot), tilt


class Body(NamedTuple):
    """The signals of the body: the first of `Signals`."""

    theta: Any
    theta_dot: Any
    tilt: Any
    delta_ddot: Any
    gimbal_power: Any
    rotor_power: Any
    used_power: Any
    energy: Any


def body_signals(state: State, told: Any, setting: Setting, push: Any, law: Law) -> Body:
    """Return the body's signals in a state under a law."""
    seen, tilt = measured(state, setting)
    delta_ddot = law(told, setting.numbers, seen)
    moved = motion(state, delta_ddot, setting.machine, push)
    gimbal, rotor = moved.gimbal_power, moved.rotor_power
    return Body(
        seen.theta,
        seen.theta_dot,
        tilt,
        delta_ddot,
        gimbal,
        rotor,
        ops.absolute(gimbal) + ops.absolute(setting.machine.rotor_share * rotor),
        energy(state, setting.machine),
    )
