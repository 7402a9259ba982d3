"""The plant of VSCMGs against each body's Newton-Euler equations, integrated by SciPy.

Hub, gimbal frames and wheels are single rigid bodies here, by Kane's method: with the speeds
u = (omega, delta_dot, Omega), a body of inertia I that turns at w = P u has the acceleration
P u_dot + b, and sum P^T (I (P u_dot + b) + w x I w) = P_hub^T L + (0, u_g, u_w). Nothing is
written in momenta, and the attitude is a matrix.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

import nullmotion as nm
from nullmotion import rotation
from nullmotion.array.wheels import Wheels
from nullmotion.vscmg import Units, dynamics

PARTS, HOLD = 6, 0.1  # commands one after another, and how long each is held [s]
ANGLES, RATES = np.array([0.3, -1.0, 2.0]), np.array([0.4, -0.3, 0.2])
SPEED, OMEGA = np.array([150.0, -90.0, 120.0]), np.array([0.3, -0.2, 0.4])
FORCE, GROWTH = np.array([0.3, -0.2, 0.1]), np.array([-0.1, 0.2, 0.4])  # torque in N and its rate
START = Rotation.from_rotvec([0.4, -0.7, 0.2])  # turns the axes of N into those of B


class Craft(NamedTuple):
    """A hub and n units of a frame and a round wheel."""

    hub: np.ndarray
    gimbal_axes: np.ndarray
    spin_axes: np.ndarray  # at gimbal angles 0
    frames: np.ndarray  # inertias about s, t and g, (n, 3)
    wheels: np.ndarray  # spin inertias, (n,)
    across: np.ndarray  # inertias of the wheels about t and g, (n,)

    @property
    def n(self) -> int:
        return len(self.wheels)


class Point(NamedTuple):
    """C_BN, body rate, gimbal angles, gimbal rates, wheel speeds."""

    attitude: np.ndarray
    omega: np.ndarray
    delta: np.ndarray
    rates: np.ndarray
    speed: np.ndarray

    def flat(self) -> np.ndarray:
        return np.concatenate([np.ravel(part) for part in self])

    @staticmethod
    def of(y: np.ndarray) -> Point:
        return Point(y[:9].reshape(3, 3), y[9:12], *np.split(y[12:], 3))


class Body(NamedTuple):
    """Inertia in B, angular velocity, its derivatives by the speeds, what is left of its own."""

    inertia: np.ndarray
    turning: np.ndarray
    partial: np.ndarray
    left: np.ndarray


def cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    (x, y, z), (u, v, w) = a.tolist(), b.tolist()  # NumPy's own takes ten times as long
    return np.array([y * w - z * v, z * u - x * w, x * v - y * u])


def bodies(craft: Craft, at: Point) -> Iterator[Body]:
    """Yield hub, frames and wheels."""
    to_hub = np.concatenate([np.eye(3), np.zeros((3, 2 * craft.n))], axis=1)
    yield Body(craft.hub, at.omega, to_hub, np.zeros(3))
    for i, g in enumerate(craft.gimbal_axes):
        spin = craft.spin_axes[i]
        s = np.cos(at.delta[i]) * spin + np.sin(at.delta[i]) * cross(g, spin)
        axes = np.array([s, cross(g, s), g])
        turning, to_frame = at.omega + at.rates[i] * g, to_hub.copy()
        to_frame[:, 3 + i] = g
        left = cross(at.omega, at.rates[i] * g)  # g stands still in B
        yield Body(axes.T @ np.diag(craft.frames[i]) @ axes, turning, to_frame, left)
        left = left + cross(turning, at.speed[i] * s)  # s stands still in the frame
        turning, to_wheel = turning + at.speed[i] * s, to_frame.copy()
        to_wheel[:, 3 + craft.n + i] = s
        wheel = np.diag([craft.wheels[i], craft.across[i], craft.across[i]])
        yield Body(axes.T @ wheel @ axes, turning, to_wheel, left)


def system(craft: Craft, at: Point, outside: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return mass matrix and forces for u_dot, without the motors' torques."""
    size = 3 + 2 * craft.n
    mass, force = np.zeros((size, size)), np.zeros(size)
    force[:3] = outside
    for body in bodies(craft, at):
        mass += body.partial.T @ body.inertia @ body.partial
        gyroscopic = cross(body.turning, body.inertia @ body.turning)
        force -= body.partial.T @ (body.inertia @ body.left + gyroscopic)
    return mass, force


def drawn() -> Craft:
    """Return three units that have nothing in common, on axes of no order."""
    rng = np.random.default_rng(20140301)
    gimbal = np.linalg.qr(rng.normal(size=(3, 3)))[0] + 0.3 * rng.normal(size=(3, 3))
    spin = np.cross(gimbal, rng.normal(size=(3, 3)))
    gimbal, spin = (v / np.linalg.norm(v, axis=1)[:, None] for v in (gimbal, spin))
    frames = [[0.008, 0.005, 0.012], [0.004, 0.009, 0.006], [0.007, 0.006, 0.015]]
    hub = np.array([[1.3, -0.1, 0.05], [-0.1, 0.9, 0.08], [0.05, 0.08, 1.5]])
    wheels, across = np.array([0.004, 0.005, 0.006]), np.array([0.0022, 0.003, 0.0032])
    return Craft(hub, gimbal, spin, np.array(frames), wheels, across)


CRAFT = drawn()
UNITS = CRAFT.frames.T + np.stack([CRAFT.wheels, CRAFT.across, CRAFT.across])  # J_s, J_t, J_g
BEGIN = Point(START.as_matrix().T, OMEGA, ANGLES, RATES, SPEED)


def outside_in_N(t: float) -> np.ndarray:
    return FORCE + GROWTH * t


Acceleration = Callable[[float, Point], np.ndarray]  # u_dot


def held(at: Point, span: tuple[float, float], acceleration: Acceleration) -> Point:
    """Return the state after a time with one command."""

    def flow(t: float, y: np.ndarray) -> np.ndarray:
        at = Point.of(y)
        x, z, w = at.omega
        attitude = -np.array([[0, -w, z], [w, 0, -x], [-z, x, 0]]) @ at.attitude
        moved = acceleration(t, at)
        return np.concatenate([attitude.ravel(), moved[:3], at.rates, moved[3:]])

    how = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-13, "first_step": span[1] - span[0]}
    return Point.of(solve_ivp(flow, span, at.flat(), **how).y[:, -1])


def commands(part: int) -> tuple[np.ndarray, np.ndarray]:
    """Return two commands for gimbals and wheels, of the order of 1."""
    return np.sin(1.7 * part + np.array([0.3, 1.4, 2.7])), np.cos(1.1 * part + np.arange(3))


def torques(part: int) -> tuple[np.ndarray, np.ndarray]:
    gimbals, wheels = commands(part)
    return 0.1 * gimbals, 0.05 * wheels


def kept_rates(part: int) -> tuple[np.ndarray, np.ndarray]:
    """Return gimbal rates and wheel accelerations."""
    gimbals, wheels = commands(part)
    return 1.5 * gimbals, 10.0 * wheels


def part_of_time(part: int) -> tuple[float, float]:
    return HOLD * part, HOLD * (part + 1)


def under_torques() -> Point:
    at = BEGIN
    for part in range(PARTS):
        motors = np.concatenate([np.zeros(3), *torques(part)])

        def acceleration(t: float, at: Point, motors: np.ndarray = motors) -> np.ndarray:
            mass, force = system(CRAFT, at, at.attitude @ outside_in_N(t))
            return np.linalg.solve(mass, force + motors)

        at = held(at, part_of_time(part), acceleration)
    return at


def at_kept_rates() -> Point:
    """Gimbal rates jump at the start of each part: impulses on the gimbals, none on the whole."""
    at = BEGIN
    for part in range(PARTS):
        rates, spin_up = kept_rates(part)
        mass, _ = system(CRAFT, at, np.zeros(3))
        jump = -np.linalg.solve(mass[:3, :3], mass[:3, 3:6] @ (rates - at.rates))
        at = at._replace(omega=at.omega + jump, rates=rates)
        servos = np.concatenate([np.zeros(3), spin_up])

        def acceleration(t: float, at: Point, servos: np.ndarray = servos) -> np.ndarray:
            mass, force = system(CRAFT, at, at.attitude @ outside_in_N(t))
            moved = np.linalg.solve(mass[:3, :3], force[:3] - mass[:3, 3:] @ servos)
            return np.concatenate([moved, servos])

        at = held(at, part_of_time(part), acceleration)
    return at


def published(at: Point, outside: np.ndarray, spin_up: np.ndarray) -> np.ndarray:
    """Return omega_dot by Kim et al., Eq 7, without C_G I_G delta_ddot."""
    C_G, C_0 = CRAFT.gimbal_axes.T, CRAFT.spin_axes.T
    c, d = np.cos(at.delta), np.sin(at.delta)
    C_W = c * C_0 + d * np.cross(C_G, C_0, axis=0)
    C_T = np.cross(C_G, C_W, axis=0)
    along, across, I_G = UNITS
    I_W = CRAFT.wheels
    J = CRAFT.hub + C_W * along @ C_W.T + C_T * across @ C_T.T + C_G * I_G @ C_G.T
    mixed = C_W * ((along - across) * at.rates) @ C_T.T
    J_dot = mixed + mixed.T
    w_G, w_W, w_T = C_G.T @ at.omega, C_W.T @ at.omega, C_T.T @ at.omega
    known = (
        J_dot @ at.omega
        + np.cross(at.omega, J @ at.omega)
        - C_G @ (I_W * w_T * at.speed)
        + C_W @ (I_W * spin_up + I_G * w_T * at.rates)
        + C_T @ (I_W * at.speed * at.rates + I_W * w_G * at.speed - I_G * w_W * at.rates)
    )
    moved: np.ndarray = np.linalg.solve(J, outside - known)
    return moved


def at_kept_rates_as_published() -> Point:
    at = BEGIN
    for part in range(PARTS):
        rates, spin_up = kept_rates(part)

        def acceleration(t: float, at: Point, a: np.ndarray = spin_up) -> np.ndarray:
            moved = published(at, at.attitude @ outside_in_N(t), a)
            return np.concatenate([moved, np.zeros(3), a])

        at = held(at._replace(rates=rates), part_of_time(part), acceleration)
    return at


Step = Callable[..., dynamics.State]
Commands = Callable[[int], tuple[np.ndarray, np.ndarray]]


def ours(step: Step, command: Commands, dt: float, **how: Any) -> Point:
    """Fly with our plant from the same start."""
    array = nm.CmgArray(CRAFT.gimbal_axes, CRAFT.spin_axes, wheels=Wheels(CRAFT.wheels))
    units = Units(*UNITS, inertia_includes_units=False, **how).for_n(3)
    plant = dynamics.Plant(array, units, dynamics.rest_inertia(array, units, CRAFT.hub, ANGLES))
    q, every = np.roll(START.as_quat(), 1), round(HOLD / dt)
    state = dynamics.State(q, OMEGA, ANGLES, RATES, SPEED, 0.0)
    for k in range(PARTS * every):

        def outside(since: Any, q: Any, t: float = k * dt) -> Any:
            return rotation.matrix(q) @ outside_in_N(t + since)

        state = step(plant, state, *command(k // every), outside, dt)
    attitude = Rotation.from_quat(np.roll(state.q, -1)).as_matrix().T
    return Point(attitude, state.omega, state.delta, state.rates, state.speed)


FINE, COARSE = (0.005, 0.0025, 0.00125), (0.05, 0.025, 0.0125)  # wheels on free gimbals swing
CASES = {
    "torques": (FINE, under_torques, dynamics.torque_driven, torques, {"drive": "torque"}),
    "rates": (COARSE, at_kept_rates, dynamics.rate_driven, kept_rates, {}),
    "published": (
        COARSE,
        at_kept_rates_as_published,
        dynamics.rate_driven,
        kept_rates,
        {"terms": "published"},
    ),
}


@pytest.mark.parametrize("case", CASES)
def test_errors_fall_as_the_fourth_power_of_the_step(case: str) -> None:
    steps, reference, step, command, how = CASES[case]
    truth = reference()
    assert min(np.abs(a - b).max() for a, b in zip(truth, BEGIN, strict=True)) > 0.1
    ends = [ours(step, command, dt, **how) for dt in steps]
    errors = [np.abs(end.flat() - truth.flat()).max() for end in ends]
    order = np.log2(np.divide(errors[:-1], errors[1:]))
    np.testing.assert_allclose(order, 4.0, rtol=0, atol=0.1)
    assert errors[-1] < 1e-9


def test_the_published_terms_are_another_motion() -> None:
    """By the gimbals' acceleration torque, which only `all` holds."""
    ends = [flown().omega for flown in (at_kept_rates, at_kept_rates_as_published)]
    assert np.abs(ends[0] - ends[1]).max() > 1e-2
