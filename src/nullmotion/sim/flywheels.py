"""Wheels whose speed changes, as the stages of a run see them.

`RunState.spin` holds the wheel speeds, `due` gimbal rates and wheel accelerations in a row.
Arrays with constant wheel speeds have none of this.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from nullmotion import ops
from nullmotion.array.model import CmgArray
from nullmotion.law import Observation
from nullmotion.sim.setup import Setup
from nullmotion.sim.state import Parameters, Record, RunState
from nullmotion.spacecraft import faults, motion
from nullmotion.vscmg import dynamics, servo
from nullmotion.vscmg.hardware import torque_matrix

CUT = "torque-cut"  # status of a run in which a limit kept torque back
_CUT = 1e-6  # of the commanded torque: what is missing beyond it was cut
_FLOOR = 1e-9  # of the array's momentum in a second: what is missing below it is rounding


def turning(s: RunState) -> bool:
    """Return whether the wheels' speeds change in this run."""
    return not isinstance(s.spin, tuple)


def spun(array: CmgArray, s: RunState) -> CmgArray:
    """Return an array with the momenta of its wheels as they turn now."""
    if not turning(s):
        return array
    return array.altered(h0=array.flywheels.inertia * s.spin)


def started(setup: Setup, p: Parameters) -> dict[str, Any]:
    """Return what a run carries of its wheels at the start."""
    if p.wheel_speed is None:
        keys = ("spin", "spin_rate", "spin_torque", "cut", "rest", "moved", "torque_matrix")
        return dict.fromkeys(keys, ())
    zero = np.zeros(setup.array.n)
    found = {"spin": p.wheel_speed, "spin_rate": zero, "spin_torque": zero, "cut": 0.0}
    found |= {"rest": (), "moved": (), "torque_matrix": ()}
    if p.controller is not None and p.controller.knows_torque_matrix:
        found["torque_matrix"] = np.zeros((setup.array.m, 2 * setup.array.n))
    if p.spacecraft is not None and p.units is not None:
        found["rest"] = dynamics.rest_inertia(p.true_array, p.units, p.spacecraft.inertia, p.delta)
        found["moved"] = dynamics.State(
            p.spacecraft.q_BN, p.spacecraft.omega_BN_B, p.delta, zero, p.wheel_speed, 0.0
        )
    return found


def within_limits(
    array: CmgArray, rates: Any, accelerations: Any, speed: Any, period: Any
) -> tuple[Any, Any]:
    """Return gimbal rates and wheel accelerations that the hardware allows."""
    low, high = array.flywheels.bounds(speed, period)
    return array.limited(rates), ops.clip(accelerations, low, high)


def missing(matrix: Any, rates: Any, accelerations: Any, hdot: Any, momentum: Any) -> Any:
    """Return 1 where a command gives less than the torque asked for, else 0."""
    short = matrix @ np.concatenate([accelerations, rates]) - hdot
    allowed = (_CUT * _CUT) * (hdot @ hdot) + (_FLOOR * momentum) ** 2
    return ops.where(ops.less(allowed, short @ short), 1.0, 0.0)


def asked(
    s: RunState, p: Parameters, array: CmgArray, observation: Observation, command: Any
) -> RunState:
    """Return the state with a law's command queued, and whether all its torque can be given.

    Args:
        s: State.
        p: Parameters.
        array: The array that the law knows.
        observation: What it saw.
        command: Gimbal rates, or rates and wheel accelerations.
    """
    zero = np.zeros(array.n)
    rates, accelerations = command if p.law.turns_wheels else (command, zero)
    period = observation.period
    allowed = within_limits(array, rates, accelerations, s.spin, period)
    matrix = observation.torque_matrix
    if matrix is None:
        matrix = torque_matrix(array, observation.delta, s.spin)
    limited = missing(matrix, *allowed, s.hdot, sum(p.array.h0))
    return s._replace(
        asked=rates,
        queue=(np.concatenate(allowed), *s.queue[:-1]),
        limited=limited,
        cut=s.cut + limited,
    )


def history(setup: Setup, columns: Record) -> dict[str, Any]:
    """Return a record's columns about wheels as fields of a `Trajectory`; nothing of them else.

    Columns under their names in the record are taken out.
    """
    names = {
        "spin": "wheel_speed",
        "spin_rate": "wheel_acceleration",
        "spin_torque": "wheel_motor_torque",
        "limited": "limited",
        "work": "motor_work",
        "estimates": "estimates",
    }
    if not setup.variable_speed:
        return dict.fromkeys(names.values())
    found = {new: getattr(columns, old) for old, new in names.items()}
    return found | {key: found[key][:, 0] for key in ("limited", "motor_work")}


def drive(setup: Setup, k: Any, s: RunState, p: Parameters) -> RunState:
    """Return the state with the motion of gimbals and wheels over this step."""
    n, t, dt = setup.array.n, k * p.dt, p.dt
    array = spun(p.true_array, s)
    asked, acceleration = s.due[:n], s.due[n:]
    moved = motion.ideal(array, p.events, s.delta, asked, s.previous, t, dt)
    alive = faults.running(p.events, n, t)
    low, high = array.flywheels.bounds(s.spin, dt)
    acceleration = ops.clip(acceleration, low, high) * alive
    if p.spacecraft is None:
        given = array.flywheels.inertia * acceleration
        return s._replace(
            rates=moved.rate, speed=moved.rate, spin_rate=acceleration, spin_torque=given
        )
    assert p.units is not None
    plant = dynamics.Plant(p.true_array, p.units, s.rest)
    now = dynamics.State(s.q, s.omega, s.delta, s.speed, s.spin, s.work)
    outside = _outside(p, s, t)
    a = dynamics.axes(p.true_array, s.delta)
    wheel = p.true_array.flywheels.inertia
    if p.units.drive == "rate":
        end = dynamics.rate_driven(plant, now, moved.rate, acceleration, outside, dt)
        after = dynamics.axes(p.true_array, end.delta)
        gained = (after.s @ end.omega + end.speed) - (a.s @ s.omega + s.spin)
        motors = servo.Torques(
            -plant.gimbal_torque(a, s.omega, wheel * (s.spin + a.s @ s.omega)),
            wheel * gained / dt,
        )
    else:
        free = faults.stuck(p.events, n, t)
        motors = servo.torques(plant, now, a, moved.rate, acceleration, free * alive, dt)
        net = servo.with_friction(plant, now, motors, dt)
        end = dynamics.torque_driven(plant, now, net.gimbal, net.wheel, outside, dt)
    return s._replace(
        rates=(end.delta - s.delta) / dt,
        motor=motors.gimbal,
        spin_rate=(end.speed - s.spin) / dt,
        spin_torque=motors.wheel,
        moved=end,
    )


def _outside(p: Parameters, s: RunState, t: Any) -> Any:
    """Return the torque from outside in B as a function of time since the step's start and q."""
    zero = np.zeros(3)
    momentum = spun(p.true_array, s).momentum(s.delta) @ p.true_array.torque_axes

    def torque(since: Any, q: Any) -> Any:
        found = zero
        if p.disturbance is not None:
            assert p.spacecraft is not None
            found = found + p.disturbance.torque(t + since, q, p.spacecraft.inertia)
        if p.desaturation is not None:
            found = found + p.desaturation.torque(momentum)
        return found

    return torque


def advanced(s: RunState, p: Parameters) -> dict[str, Any]:
    """Return what a step changes of the state."""
    found = {"previous": s.rates}
    array = spun(p.true_array, s)
    given = array.jacobian(s.delta) @ s.rates
    given = given + array.wheel_axes(s.delta) @ (array.flywheels.inertia * s.spin_rate)
    if p.spacecraft is None:
        found |= {"delta": s.delta + p.dt * s.rates, "spin": s.spin + p.dt * s.spin_rate}
        end = array.altered(h0=array.flywheels.inertia * found["spin"]).momentum(found["delta"])
        return found | {"impulse": s.impulse + end - array.momentum(s.delta)}
    end = s.moved
    return found | {
        "q": end.q,
        "omega": end.omega,
        "delta": end.delta,
        "speed": end.rates,
        "spin": end.speed,
        "work": end.work,
        "impulse": s.impulse + p.dt * given,
    }
