"""Motors of torque-driven VSCMGs: torques that follow a command, limits, friction."""

from __future__ import annotations

from typing import Any, NamedTuple

from nullmotion import ops
from nullmotion.vscmg.dynamics import Axes, Plant, State


class Torques(NamedTuple):
    """Torques on gimbals and wheels [N m], (n,) each."""

    gimbal: Any
    wheel: Any


def torques(
    plant: Plant, s: State, a: Axes, rates: Any, acceleration: Any, free: Any, dt: Any
) -> Torques:
    """Return the motors' torques over a step.

        u_g = J_g w (command - delta_dot) - omega_t ((J_s - J_t) omega_s + I Omega)
        u_w = I (command + delta_dot omega_t)

    with w the gimbal loop's bandwidth: the known gyroscopic torques are fed forward; what
    friction takes is left to the loop. Both within their limits.

    Args:
        plant: Body and units.
        s: State at the start of the step.
        a: The units' axes there.
        rates: Commanded gimbal rates [rad/s], (n,).
        acceleration: Commanded wheel accelerations [rad/s^2], (n,).
        free: 1 for a unit whose motors work, 0 for one whose gimbal is held or wheel is dead.
        dt: Step [s]: the loop is no faster than one step.
    """
    units, wheels = plant.units, plant.array.flywheels
    momentum = wheels.inertia * (s.speed + a.s @ s.omega)
    loop = ops.minimum(units.gimbal_bandwidth, 1.0 / dt)
    gimbal = units.gimbal_inertia * loop * (rates - s.rates)
    gimbal = gimbal - plant.gimbal_torque(a, s.omega, momentum)
    gimbal = ops.clip(gimbal, -units.gimbal_torque_limit, units.gimbal_torque_limit)
    wheel = wheels.inertia * (acceleration + s.rates * (a.t @ s.omega))
    most = wheels.greatest(s.speed)
    return Torques(gimbal, free * ops.clip(wheel, -most, most))


def with_friction(plant: Plant, s: State, motors: Torques, dt: Any) -> Torques:
    """Return the torques on gimbals and wheels: the motors' less what bearings take.

    Coulomb friction, and viscous; over one step it stops a rotor at most.
    """
    u, wheel = plant.units, plant.array.flywheels.inertia
    gimbal = _drag(u.gimbal_friction, u.gimbal_drag, s.rates, u.gimbal_inertia / dt)
    spin = _drag(u.wheel_friction, u.wheel_drag, s.speed, wheel / dt)
    return Torques(motors.gimbal - gimbal, motors.wheel - spin)


def _drag(friction: Any, drag: Any, rate: Any, stop: Any) -> Any:
    """Return the torque of a bearing; `stop` times the rate is what would stop the rotor."""
    full = friction + drag * ops.absolute(rate)
    return ops.copysign(ops.minimum(full, stop * ops.absolute(rate)), rate)
