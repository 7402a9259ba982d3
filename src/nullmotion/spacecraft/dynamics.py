"""The equations of motion of body and array, and one step of them.

    2 q_dot = q * [0, omega]
    J omega_dot = T_ext - omega x H - A delta_dot - sum_i (dh0_i/dt h_i/h0_i + I_i delta_ddot_i g_i)
    H = J omega + h + sum_i I_i delta_dot_i g_i

The gimbals' motion over the step is given (`Motion`), so only q, omega and the integral of
A delta_dot are integrated.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from nullmotion import linalg, rotation
from nullmotion.array.model import CmgArray
from nullmotion.compile.tape import unguarded
from nullmotion.spacecraft import faults
from nullmotion.spacecraft.body import Spacecraft
from nullmotion.spacecraft.disturbance import Desaturation, Disturbance
from nullmotion.spacecraft.motion import Motion
from nullmotion.spacecraft.servo import Servo


class Body(NamedTuple):
    """What is integrated: attitude, body rate, integral of A delta_dot."""

    q: Any
    omega: Any
    impulse: Any


class Slope(NamedTuple):
    """2 q_dot, J omega_dot and A delta_dot."""

    q: Any
    torque: Any
    impulse: Any


class Wheel(NamedTuple):
    """A reaction wheel over a step: its axis in B, momentum at the start and rate of momentum."""

    axis: Any
    momentum: Any
    rate: Any


class Vehicle(NamedTuple):
    """Everything that the equations of motion take."""

    spacecraft: Spacecraft
    array: CmgArray
    servo: Servo | None
    events: faults.Events
    disturbance: Disturbance | None
    desaturation: Desaturation | None
    start: Any  # time of the step's start [s]
    wheel: Wheel | None = None

    def slope(self, body: Body, delta: Any, motion: Motion, t: Any, since: Any) -> Slope:
        """Return the derivatives at a time t, ``since`` the start of the step."""
        craft, omega = self.spacecraft, body.omega
        array = faults.as_it_is(self.array, self.events, t)
        basis = array.torque_axes
        assert basis is not None
        rates = motion.rate_at(since)
        given = array.jacobian(delta) @ rates
        momentum = craft.inertia @ omega
        array_momentum = array.momentum(delta) @ basis
        reaction = given @ basis
        if craft.momentum_coupling:
            momentum = momentum + array_momentum
        if self.wheel is not None:
            reaction = reaction + self.wheel.rate * self.wheel.axis
            if craft.momentum_coupling:
                own = self.wheel.momentum + since * self.wheel.rate
                momentum = momentum + own * self.wheel.axis
        if faults.of_kind(self.events, "spin-down"):
            lost = faults.momentum_loss(self.array, self.events, t, delta, self.start)
            reaction = reaction + lost @ basis
        if self.servo is not None and self.servo.has("inertia"):
            momentum = momentum + (self.servo.inertia * rates) @ array.gimbal_axes
            if motion.acceleration is not None:
                spun_up = self.servo.inertia * motion.acceleration
                reaction = reaction + spun_up @ array.gimbal_axes
        torque = -linalg.cross(omega, momentum) - reaction
        if self.disturbance is not None:
            torque = torque + self.disturbance.torque(t, body.q, craft.inertia)
        if self.desaturation is not None:
            torque = torque + self.desaturation.torque(array_momentum)
        return Slope(rotation.doubled_rate(body.q, omega), torque, given)


Integrate = Callable[[Vehicle, Body, Any, Motion, Any, Any], Body]


def euler(v: Vehicle, b: Body, delta: Any, motion: Motion, t: Any, dt: Any) -> Body:
    """Explicit Euler, order 1."""
    a = v.slope(b, delta, motion, t, 0.0)
    return _moved(b, a, 0.5 * dt, dt * v.spacecraft.inverse_inertia, dt)


def semi_implicit_euler(v: Vehicle, b: Body, delta: Any, motion: Motion, t: Any, dt: Any) -> Body:
    """Semi-implicit Euler, order 1: omega first, then q with the new omega."""
    a = v.slope(b, delta, motion, t, 0.0)
    omega = b.omega + (dt * v.spacecraft.inverse_inertia) @ a.torque
    return Body(b.q + 0.5 * dt * rotation.doubled_rate(b.q, omega), omega, b.impulse + dt * a[2])


def rk4(v: Vehicle, b: Body, delta: Any, motion: Motion, t: Any, dt: Any) -> Body:
    """Classical Runge-Kutta, order 4."""
    half, inverse = 0.5 * dt, v.spacecraft.inverse_inertia
    whole_steps = half, dt * inverse, dt
    half_steps = 0.5 * half, half * inverse, half
    middle, end = motion.angle_at(delta, half), motion.angle_at(delta, dt)
    a = v.slope(b, delta, motion, t, 0.0)
    with unguarded():  # between two guarded angles
        c = v.slope(_moved(b, a, *half_steps), middle, motion, t + half, half)
        e = v.slope(_moved(b, c, *half_steps), middle, motion, t + half, half)
        g = v.slope(_moved(b, e, *whole_steps), end, motion, t + dt, dt)
    mean = Slope(*(p + 2.0 * (q + r) + s for p, q, r, s in zip(a, c, e, g, strict=True)))
    return _moved(b, mean, dt / 12.0, (dt / 6.0) * inverse, dt / 6.0)


def _moved(b: Body, slope: Slope, q_step: Any, omega_step: Any, impulse_step: Any) -> Body:
    return Body(
        b.q + q_step * slope.q,
        b.omega + omega_step @ slope.torque,
        b.impulse + impulse_step * slope.impulse,
    )


def dop853(v: Vehicle, b: Body, delta: Any, motion: Motion, t: Any, dt: Any) -> Body:
    """SciPy's adaptive Dormand-Prince of order 8 to 1e-12; on floats only."""
    from scipy.integrate import solve_ivp

    m = len(b.impulse)

    def flow(time: float, y: np.ndarray) -> np.ndarray:
        state, since = Body(y[:4], y[4:7], y[7:]), time - t
        s = v.slope(state, motion.angle_at(delta, since), motion, time, since)
        return np.concatenate([0.5 * s.q, v.spacecraft.inverse_inertia @ s.torque, s.impulse])

    start = np.concatenate([b.q, b.omega, b.impulse])
    end = solve_ivp(flow, (t, t + dt), start, "DOP853", rtol=1e-12, atol=1e-14).y[:, -1]
    return Body(end[:4], end[4:7], end[7 : 7 + m])


INTEGRATORS: dict[str, Integrate] = {
    "euler": euler,
    "semi-implicit-euler": semi_implicit_euler,
    "rk4": rk4,
    "dop853": dop853,
}
