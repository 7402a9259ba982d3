"""Where the commanded rate of momentum comes from: a table, a momentum target or a controller."""

from __future__ import annotations

from typing import Any

import numpy as np

from nullmotion import linalg, rotation
from nullmotion.array.model import CmgArray
from nullmotion.sim.setup import Setup
from nullmotion.sim.state import Parameters, RunState
from nullmotion.spacecraft import AttitudeObservation, faults
from nullmotion.spacecraft.motion import quantised


def measured_angles(s: RunState, p: Parameters) -> Any:
    """Return the gimbal angles that the law sees [rad]."""
    seen = s.delta + p.encoder_bias
    if p.servo is not None and p.servo.has("encoder_resolution"):
        return quantised(seen, p.servo.encoder_resolution)
    return seen


def known_array(t: Any, s: RunState, p: Parameters) -> CmgArray:
    """Return the array that the law knows."""
    return faults.as_known(p.array, p.events, t, measured_angles(s, p))


def command(setup: Setup, k: Any, row: Any, s: RunState, p: Parameters) -> RunState:
    """Return the state with the command of this law period."""
    if setup.spacecraft is not None:
        return _controlled(setup, k * p.dt, row, s, p)
    if setup.momentum_target is not None:
        momentum = known_array(k * p.dt, s, p).momentum(measured_angles(s, p))
        period = p.dt * float(setup.period_steps)
        return s._replace(hdot=(p.momentum_target - momentum) / period)
    return s._replace(hdot=row if setup.scheduled else p.hdot)


def _controlled(setup: Setup, t: Any, row: Any, s: RunState, p: Parameters) -> RunState:
    """Return the state with hdot = -T - omega x h, T the controller's torque on the vehicle."""
    assert p.controller is not None and p.spacecraft is not None
    reference = row if setup.reference is not None else None
    target = p.target if reference is None else reference[:4]
    q, omega, noise = _sensed(s, p)
    array = known_array(t, s, p)
    basis = array.torque_axes
    assert basis is not None
    momentum = array.momentum(measured_angles(s, p)) @ basis
    zero = np.zeros(3)
    seen = AttitudeObservation(
        q_BN=q,
        omega_BN_B=omega,
        q_RN=target,
        omega_RN_R=zero if reference is None else reference[4:7],
        alpha_RN_R=zero if reference is None else reference[7:],
        inertia=p.spacecraft.inertia,
        momentum=momentum,
        t=t,
        period=p.dt * float(setup.period_steps),
    )
    torque, controller = p.controller.step(seen, s.controller)
    hdot = basis @ (-torque - linalg.cross(omega, momentum))
    return s._replace(hdot=hdot, controller=controller, noise=noise, reference=target)


def _sensed(s: RunState, p: Parameters) -> tuple[Any, Any, Any]:
    """Return measured attitude and body rate, and the generator's next state."""
    sensors = p.sensors
    if sensors is None:
        return s.q, s.omega, s.noise
    if not sensors.noisy:
        return s.q, s.omega + sensors.gyro_bias, s.noise
    from nullmotion.spacecraft.random import normals

    drawn, noise = normals(s.noise, 6)
    omega = s.omega + sensors.gyro_bias + sensors.gyro_noise * drawn[:3]
    small = 0.5 * sensors.attitude_noise * drawn[3:]
    tilt = np.array([1.0, *small])
    return rotation.normalised(rotation.multiply(s.q, tilt)), omega, noise
