"""The equations of motion of a rigid body with n VSCMGs, in momenta.

Of unit i: axes s, t, g, inertias J_s, J_t, J_g, wheel I (spin part of J_s), delta_dot, Omega;
omega_s = s . omega and so on. Momenta of the whole, of a unit about its gimbal axis and of a
wheel about its spin axis:

    H   = J_0 omega + sum_i [J_s s s^T + J_t t t^T + J_g g g^T] omega + J_g delta_dot g + I Omega s
          + bias (of wheels that have failed and spin on)
    p_g = J_g (delta_dot + omega_g),     p_w = I (Omega + omega_s)

    H_dot = L in inertial space,     p_w_dot = u_w,
    p_g_dot = omega_t ((J_s - I - J_t) omega_s + p_w) + u_g

(Schaub & Junkins, Analytical Mechanics of Space Systems, 4.4, rearranged; L from outside, u the
torques on units and wheels.) Rates follow from momenta by a 3 x 3 solution, without any
derivative of omega. Rate-driven units have delta_dot and Omega given, H is integrated alone.
Kim et al. (2014), Eq 7, leave out the torque -J_g delta_ddot g: then H without J_g delta_dot g
changes by -omega x J_g delta_dot g.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from nullmotion import linalg, rotation
from nullmotion.array.model import CmgArray
from nullmotion.vscmg.hardware import Units, rest_inertia
from nullmotion.vscmg.unit_axes import Axes, axes, outer_sum

__all__ = ["Plant", "State", "axes", "rate_driven", "rest_inertia", "torque_driven"]


class Plant(NamedTuple):
    """What does not change over a step: geometry and inertias."""

    array: CmgArray
    units: Units
    rest: Any  # inertia without the units, (3, 3)

    def inertia(self, a: Axes) -> Any:
        """Return the inertia of everything on board [kg m^2], (3, 3)."""
        u = self.units
        moving = outer_sum(u.spin_inertia, a.s) + outer_sum(u.transverse_inertia, a.t)
        return self.rest + moving + outer_sum(u.gimbal_inertia, a.g)

    def momentum(self, a: Axes, omega: Any, rates: Any, speed: Any) -> Any:
        """Return H in B [N m s], (3,)."""
        return self.inertia(a) @ omega + self.internal(a, rates, speed)

    def internal(self, a: Axes, rates: Any, speed: Any) -> Any:
        """Return what units and wheels hold by turning against the body, and the bias [N m s]."""
        spinning = (self.array.flywheels.inertia * speed) @ a.s
        return spinning + (self.units.gimbal_inertia * rates) @ a.g + self.array.momentum_bias

    def body_rate(self, a: Axes, momentum: Any, rates: Any, speed: Any) -> Any:
        """Return omega from H, gimbal rates and wheel speeds [rad/s], (3,)."""
        return linalg.solve(self.inertia(a), momentum - self.internal(a, rates, speed))

    def body_rate_of_momenta(self, a: Axes, momentum: Any, gimbal: Any, wheel: Any) -> Any:
        """Return omega from H, p_g and p_w [rad/s], (3,)."""
        u = self.units
        held = outer_sum(u.spin_inertia - self.array.flywheels.inertia, a.s)
        matrix = self.rest + held + outer_sum(u.transverse_inertia, a.t)
        turning = gimbal @ a.g + wheel @ a.s + self.array.momentum_bias
        return linalg.solve(matrix, momentum - turning)

    def gimbal_torque(self, a: Axes, omega: Any, wheel: Any) -> Any:
        """Return omega_t ((J_s - I - J_t) omega_s + p_w), gyroscopic, on the gimbals [N m]."""
        u = self.units
        sideways = u.spin_inertia - self.array.flywheels.inertia - u.transverse_inertia
        return (a.t @ omega) * (sideways * (a.s @ omega) + wheel)

    def energy(self, a: Axes, omega: Any, rates: Any, speed: Any) -> Any:
        """Return the kinetic energy [J]."""
        u, wheel = self.units, self.array.flywheels.inertia
        along, about = a.s @ omega, a.g @ omega + rates
        moving = (u.spin_inertia - wheel) @ (along * along) + wheel @ ((along + speed) ** 2)
        moving = moving + u.transverse_inertia @ (a.t @ omega) ** 2
        return 0.5 * (omega @ (self.rest @ omega) + moving + u.gimbal_inertia @ (about * about))


def total_momentum(
    array: CmgArray, units: Units, rest: Any, delta: Any, omega: Any, rates: Any, speed: Any
) -> np.ndarray:
    """Return H in B over a history [N m s], (k, 3).

    Args:
        array: The array with its flywheels.
        units: The units' inertias.
        rest: Inertia without the units [kg m^2], (3, 3).
        delta: Gimbal angles [rad], (k, n).
        omega: Body rates [rad/s], (k, 3).
        rates: Gimbal rates [rad/s], (k, n).
        speed: Wheel speeds [rad/s], (k, n).
    """
    found = omega @ rest + array.momentum_bias
    u, wheels = units, array.flywheels
    for i in range(array.n):
        s0, t0, g = array.spin_axes[i], array.transverse_axes[i], array.gimbal_axes[i]
        c, d = np.cos(delta[:, i])[:, None], np.sin(delta[:, i])[:, None]
        s, t = c * s0 + d * t0, c * t0 - d * s0
        along = u.spin_inertia[i] * np.sum(s * omega, axis=1) + wheels.inertia[i] * speed[:, i]
        about = u.gimbal_inertia[i] * (omega @ g + rates[:, i])
        across = u.transverse_inertia[i] * np.sum(t * omega, axis=1)
        found = found + along[:, None] * s + across[:, None] * t + about[:, None] * g
    return found


class State(NamedTuple):
    """What moves: attitude, body rate, gimbal angles and rates, wheel speeds, work so far."""

    q: Any
    omega: Any
    delta: Any
    rates: Any
    speed: Any
    work: Any


def in_N(q: Any, v: Any) -> Any:
    """Return a vector of B in N."""
    return rotation.matrix(q).T @ v


def _weighted(slopes: list[Any], dt: Any) -> list[Any]:
    a, b, c, d = slopes
    return [(dt / 6.0) * (w + 2.0 * (x + y) + z) for w, x, y, z in zip(a, b, c, d, strict=True)]


def runge_kutta(slope: Any, start: list[Any], dt: Any) -> list[Any]:
    """Return a state, a list of parts, after a step of the classical Runge-Kutta method.

    Args:
        slope: Derivatives from the time since the step's start and the parts.
        start: The parts.
        dt: Step [s].
    """
    half = 0.5 * dt

    def after(h: Any, k: list[Any]) -> list[Any]:
        return [x + h * y for x, y in zip(start, k, strict=True)]

    a = slope(0.0, start)
    b = slope(half, after(half, a))
    c = slope(half, after(half, b))
    d = slope(dt, after(dt, c))
    return [x + y for x, y in zip(start, _weighted([a, b, c, d], dt), strict=True)]


def rate_driven(
    plant: Plant, s: State, rates: Any, acceleration: Any, outside: Any, dt: Any
) -> State:
    """Return the state after a step with given gimbal rates and wheel accelerations.

    Args:
        plant: Body and units.
        s: State at the start; `s.rates` are the rates before this step: a jump of the gimbal
            rates turns the body, as a torque that ends at once does.
        rates: Gimbal rates over the step [rad/s], (n,).
        acceleration: Wheel accelerations [rad/s^2], (n,).
        outside: Torque from outside in B, of the time since the start and the attitude.
        dt: Step [s].
    """
    full = plant.units.terms == "all"
    nothing = np.zeros(plant.array.n)

    def carried(at: Any) -> Any:
        return at if full else nothing

    start = plant.momentum(axes(plant.array, s.delta), s.omega, carried(s.rates), s.speed)

    def rate_at(since: Any, q: Any, momentum: Any) -> Any:
        a = axes(plant.array, s.delta + since * rates)
        h = rotation.matrix(q) @ momentum
        return plant.body_rate(a, h, carried(rates), s.speed + since * acceleration)

    def slope(since: Any, parts: list[Any]) -> list[Any]:
        q, momentum = parts
        omega = rate_at(since, q, momentum)
        torque = outside(since, q)
        if not full:
            turning = (plant.units.gimbal_inertia * rates) @ plant.array.gimbal_axes
            torque = torque - linalg.cross(omega, turning)
        return [0.5 * rotation.doubled_rate(q, omega), in_N(q, torque)]

    q, momentum = runge_kutta(slope, [s.q, in_N(s.q, start)], dt)
    q = rotation.normalised(q)
    speed = s.speed + dt * acceleration
    return State(q, rate_at(dt, q, momentum), s.delta + dt * rates, rates, speed, s.work)


def torque_driven(
    plant: Plant, s: State, gimbal_torque: Any, wheel_torque: Any, outside: Any, dt: Any
) -> State:
    """Return the state after a step under given torques on gimbals and wheels.

    Args:
        plant: Body and units.
        s: State at the start.
        gimbal_torque: u_g [N m], (n,), held over the step.
        wheel_torque: u_w [N m], (n,).
        outside: Torque from outside in B, of the time since the start and the attitude.
        dt: Step [s].
    """
    wheels, units = plant.array.flywheels.inertia, plant.units
    a = axes(plant.array, s.delta)
    total = in_N(s.q, plant.momentum(a, s.omega, s.rates, s.speed))
    gimbal = units.gimbal_inertia * (s.rates + a.g @ s.omega)
    wheel = wheels * (s.speed + a.s @ s.omega)

    def motion(parts: list[Any]) -> tuple[Axes, Any, Any, Any]:
        q, momentum, delta, p_g, p_w, _ = parts
        at = axes(plant.array, delta)
        omega = plant.body_rate_of_momenta(at, rotation.matrix(q) @ momentum, p_g, p_w)
        return at, omega, p_g / units.gimbal_inertia - at.g @ omega, p_w / wheels - at.s @ omega

    def slope(since: Any, parts: list[Any]) -> list[Any]:
        q, p_w = parts[0], parts[4]
        at, omega, rates, speed = motion(parts)
        return [
            0.5 * rotation.doubled_rate(q, omega),
            in_N(q, outside(since, q)),
            rates,
            plant.gimbal_torque(at, omega, p_w) + gimbal_torque,
            wheel_torque,
            gimbal_torque @ rates + wheel_torque @ speed,
        ]

    end = runge_kutta(slope, [s.q, total, s.delta, gimbal, wheel, s.work], dt)
    end[0] = rotation.normalised(end[0])
    _, omega, rates, speed = motion(end)
    return State(end[0], omega, end[2], rates, speed, end[5])
