"""The plant of a run: how gimbals and body move over a step."""

from __future__ import annotations

from typing import Any

import numpy as np

from nullmotion import rotation
from nullmotion.sim import flywheels
from nullmotion.sim.setup import Setup
from nullmotion.sim.state import Parameters, RunState
from nullmotion.spacecraft import dynamics, faults, motion
from nullmotion.spacecraft.motion import Motion


def drive(setup: Setup, k: Any, s: RunState, p: Parameters) -> RunState:
    """Return the state with the gimbals' motion over this step."""
    if flywheels.turning(s):
        return flywheels.drive(setup, k, s, p)
    t, delta = k * p.dt, s.delta
    array = faults.as_it_is(p.true_array, p.events, t)
    turning = _turning(array, s)
    if p.servo is None:
        moved = motion.ideal(array, p.events, delta, s.due, s.previous, t, p.dt)
        return s._replace(rates=moved.rate, speed=moved.rate, motor=-turning)
    reading: Any = ()
    if p.servo.has("encoder_resolution"):
        reading = s.reading, motion.quantised(delta, p.servo.encoder_resolution)
    moved = motion.driven(
        p.servo, array, p.events, delta, s.due, s.speed, reading, turning, t, p.dt
    )
    return s._replace(
        rates=moved.mean(p.dt),
        acceleration=moved.acceleration,
        motor=moved.torque,
        reading=reading[1] if reading else s.reading,
    )


def _turning(array: Any, s: RunState) -> Any:
    """Return omega . c_i for each CMG (c_i: column of A), the gyroscopic torque on its gimbal."""
    if isinstance(s.omega, tuple):
        return np.zeros(array.n)
    return (array.torque_axes @ s.omega) @ array.jacobian(s.delta)


def motion_of(s: RunState, p: Parameters) -> Motion:
    """Return the motion that `drive` found."""
    if p.servo is None:
        return Motion(s.rates, None, s.rates, s.motor)
    start = s.speed
    if p.true_array.has_angle_limits:  # a gimbal that meets its end stop loses rate at once
        start = s.rates - 0.5 * p.dt * s.acceleration
    return Motion(start, s.acceleration, start + p.dt * s.acceleration, s.motor)


def advanced(setup: Setup, k: Any, s: RunState, p: Parameters) -> dict[str, Any]:
    """Return what a step changes of the state."""
    if flywheels.turning(s):
        return flywheels.advanced(s, p)
    moved, t = motion_of(s, p), k * p.dt
    found = {"delta": moved.angle_at(s.delta, p.dt), "previous": s.rates}
    if p.servo is not None:
        found["speed"] = moved.end_rate
    if setup.spacecraft is None or p.spacecraft is None:
        return found | {"impulse": s.impulse + _impulse(setup, s, p, moved, t)}
    vehicle = dynamics.Vehicle(
        p.spacecraft,
        p.true_array,
        p.servo,
        p.events,
        p.disturbance,
        p.desaturation,
        t,
        _wheel(s, p),
    )
    step = dynamics.INTEGRATORS[setup.integrator]
    start = dynamics.Body(s.q, _struck(s, p, moved), s.impulse)
    body = step(vehicle, start, s.delta, moved, t, p.dt)
    if p.reaction_wheel is not None:
        found["wheel"] = s.wheel + p.dt * s.wheel_rate
    return found | {
        "q": rotation.normalised(body.q),
        "omega": body.omega,
        "impulse": body.impulse,
    }


def _wheel(s: RunState, p: Parameters) -> dynamics.Wheel | None:
    wheel = p.reaction_wheel
    return None if wheel is None else dynamics.Wheel(wheel.axis, s.wheel, s.wheel_rate)


def _struck(s: RunState, p: Parameters, moved: Motion) -> Any:
    """Return the body rate after gimbals met their end stops, which pass their momentum on."""
    servo, array = p.servo, p.true_array
    if servo is None or p.spacecraft is None:
        return s.omega
    if not (array.has_angle_limits and servo.has("inertia")):
        return s.omega
    given = (servo.inertia * (s.speed - moved.rate)) @ array.gimbal_axes
    return s.omega + p.spacecraft.inverse_inertia @ given


def _impulse(setup: Setup, s: RunState, p: Parameters, moved: Motion, t: Any) -> Any:
    """Return the integral of A delta_dot over the step by the run's integrator [N m s]."""

    def given(since: Any) -> Any:
        array = faults.as_it_is(p.true_array, p.events, t + since)
        return array.jacobian(moved.angle_at(s.delta, since)) @ moved.rate_at(since)

    if setup.integrator == "euler":
        return p.dt * given(0.0)
    if setup.integrator == "semi-implicit-euler":
        return p.dt * given(p.dt)
    return (p.dt / 6.0) * (given(0.0) + 4.0 * given(0.5 * p.dt) + given(p.dt))
