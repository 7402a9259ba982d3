"""Where the commanded rate of momentum comes from: a table, a momentum target or a controller."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from nullmotion import linalg, rotation
from nullmotion.array.model import CmgArray
from nullmotion.sim import flywheels, preview
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
    return faults.as_known(flywheels.spun(p.array, s), p.events, t, measured_angles(s, p))


def command(setup: Setup, k: Any, row: Any, s: RunState, p: Parameters) -> RunState:
    """Return the state with the command of this law period, and what is foreseen of it."""
    count = preview.wanted(setup)
    if setup.spacecraft is not None:
        return _controlled(setup, k, row, s, p, count)
    if setup.momentum_target is not None:
        momentum = known_array(k * p.dt, s, p).momentum(measured_angles(s, p))
        period = p.dt * float(setup.period_steps)
        s = s._replace(hdot=(p.momentum_target - momentum) / period)
    else:
        s = s._replace(hdot=row if setup.scheduled else p.hdot)
    return s._replace(preview=_scheduled(setup, k, s.hdot, count)) if count else s


def _scheduled(setup: Setup, k: Any, hdot: Any, count: int) -> np.ndarray:
    """Return hdot at this and the coming samples without a controller, (count, m)."""
    if setup.scheduled:
        return preview.rows(setup, k, count)
    found = np.tile(hdot, (count, 1))
    if setup.momentum_target is not None:  # reached with the next sample
        found[1:] = 0.0
    return found


class _Motion(NamedTuple):
    """What the controller is told of the vehicle, and its own state."""

    q: Any
    omega: Any
    momentum: Any
    controller: Any
    array: Any = None
    delta: Any = None
    rates: Any = None
    limited: Any = 0.0


def _controlled(setup: Setup, k: Any, row: Any, s: RunState, p: Parameters, count: int) -> RunState:
    """Return the state with the command of the controller, shared out to array and wheel."""
    t, wheel = k * p.dt, p.reaction_wheel
    q, omega, noise = _sensed(s, p)
    array = known_array(t, s, p)
    basis = array.torque_axes
    assert basis is not None
    momentum = array.momentum(measured_angles(s, p)) @ basis
    if wheel is not None:
        momentum = momentum + s.wheel * wheel.axis
    now = _Motion(q, omega, momentum, s.controller)
    if flywheels.turning(s):
        seen = measured_angles(s, p)
        now = now._replace(array=array, delta=seen, rates=s.rates, limited=s.limited)
    hdot, controller, target = _feedback(setup, t, row, now, p)
    found = {"hdot": basis @ hdot, "controller": controller, "noise": noise, "reference": target}
    if wheel is not None:
        period = p.dt * float(setup.period_steps)
        found["wheel_rate"] = wheel.limited(wheel.axis @ hdot, s.wheel, period)
    if not isinstance(s.torque_matrix, tuple):
        assert p.controller is not None
        matrix = p.controller.torque_matrix(_seen(setup, t, row, now, p), controller)
        found["torque_matrix"] = basis @ matrix
    if count:
        found["preview"] = _foreseen(setup, k, now, p, count) @ basis.T
    return s._replace(**found)


def _feedback(setup: Setup, t: Any, row: Any, now: _Motion, p: Parameters) -> tuple[Any, Any, Any]:
    """Return hdot = -T - omega x h, T the controller's torque on the vehicle; state; reference."""
    assert p.controller is not None
    seen = _seen(setup, t, row, now, p)
    torque, controller = p.controller.step(seen, now.controller)
    return -torque - linalg.cross(now.omega, now.momentum), controller, seen.q_RN


def _seen(setup: Setup, t: Any, row: Any, now: _Motion, p: Parameters) -> AttitudeObservation:
    """Return what the controller sees."""
    assert p.spacecraft is not None
    reference = row if setup.reference is not None else None
    target = p.target if reference is None else reference[:4]
    zero = np.zeros(3)
    return AttitudeObservation(
        q_BN=now.q,
        omega_BN_B=now.omega,
        q_RN=target,
        omega_RN_R=zero if reference is None else reference[4:7],
        alpha_RN_R=zero if reference is None else reference[7:],
        inertia=p.spacecraft.inertia,
        momentum=now.momentum,
        t=t,
        period=p.dt * float(setup.period_steps),
        array=now.array,
        delta=now.delta,
        rates=now.rates,
        limited=now.limited,
    )


def _foreseen(setup: Setup, k: Any, now: _Motion, p: Parameters, count: int) -> np.ndarray:
    """Return hdot in B at this and the coming samples (`preview`), (count, 3)."""
    assert p.spacecraft is not None
    rows = preview.rows(setup, k, count)
    period, found = setup.period, []
    for i in range(count):
        hdot, controller, _ = _feedback(setup, k * p.dt + i * period, rows[i], now, p)
        found.append(hdot)
        q, omega = preview.moved(p.spacecraft, now.q, now.omega, now.momentum, hdot, period)
        now = _Motion(q, omega, now.momentum + period * hdot, controller)
    return np.array(found)


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
