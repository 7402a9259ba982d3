"""The adaptive controller: its regressors against the equations of motion, and how it learns."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from nullmotion import InputError, layouts
from nullmotion.array.wheels import Wheels
from nullmotion.spacecraft import AttitudeObservation, controllers
from nullmotion.spacecraft.controllers.adaptive import Adaptive
from nullmotion.vscmg import Units
from nullmotion.vscmg.dynamics import Plant, State, axes, rate_driven
from nullmotion.vscmg.hardware import rest_inertia

WHEEL = np.array([7e-4, 5e-4, 9e-4, 6e-4, 8e-4])
BODY = np.array([[0.061, 0.004, -0.003], [0.004, 0.070, 0.006], [-0.003, 0.006, 0.0764]])
LAYOUTS = [("pyramid", {}), ("box90", {}), ("roof", {}), ("pyramid", {"n": 5})]
every_layout = pytest.mark.parametrize(("layout", "parameters"), LAYOUTS)


def array_of(layout: str, parameters: dict[str, Any]) -> Any:
    shape = layouts.get(layout)(**parameters)
    n = len(shape.axes()[0])
    return shape.array(h0=WHEEL[:n] * 200.0, wheels=Wheels(WHEEL[:n]))


def units_of(n: int) -> Units:
    rng = np.random.default_rng(4)
    spin, across, gimbal = rng.uniform(2e-3, 4e-3, (3, n))
    return Units(spin, across, gimbal, terms="published")


class Motion(NamedTuple):
    """A body with VSCMGs that turn as told, under a reference that does, too."""

    array: Any
    plant: Plant
    start: State
    rates: np.ndarray
    acceleration: np.ndarray
    q_RN: np.ndarray
    omega_R: np.ndarray
    alpha_R: np.ndarray

    def state(self, t: float) -> State:
        """Return the state a short time before or after the start."""
        quiet = lambda since, q: np.zeros(3)  # noqa: E731
        return rate_driven(self.plant, self.start, self.rates, self.acceleration, quiet, t)

    def observation(self, t: float, limited: float = 0.0, period: float = 0.01) -> Any:
        s = self.state(t)
        turned = Rotation.from_rotvec(self.omega_R * t + 0.5 * self.alpha_R * t * t)
        q = Rotation.from_quat([*self.q_RN[1:], self.q_RN[0]]) * turned
        x, y, z, w = q.as_quat()
        array = self.array.altered(h0=self.array.flywheels.inertia * s.speed)
        return AttitudeObservation(
            q_BN=s.q,
            omega_BN_B=s.omega,
            q_RN=np.array([w, x, y, z]),
            omega_RN_R=self.omega_R + self.alpha_R * t,
            alpha_RN_R=self.alpha_R,
            inertia=np.eye(3),
            momentum=array.momentum(s.delta) @ array.torque_axes,
            t=t,
            period=period,
            array=array,
            delta=s.delta,
            rates=self.rates,
            limited=limited,
        )


def motion(layout: str, parameters: dict[str, Any], seed: int) -> Motion:
    rng, array = np.random.default_rng(seed), array_of(layout, parameters)
    n, q = array.n, rng.normal(size=(2, 4))
    q /= np.linalg.norm(q, axis=1, keepdims=True)
    units, delta = units_of(n), rng.uniform(-np.pi, np.pi, n)
    rest = rest_inertia(array, replace(units, inertia_includes_units=False), BODY, delta)
    omega, speed = rng.normal(size=3), rng.uniform(-250.0, 250.0, n)
    rates, acceleration = rng.normal(size=n) * 3.0, rng.normal(size=n) * 20.0
    start = State(q[0], omega, delta, rates, speed, 0.0)
    turn = rng.normal(size=3)  # rate and acceleration along one axis: its angle is their integral
    plant = Plant(array, units, rest)
    return Motion(array, plant, start, rates, acceleration, q[1], 0.7 * turn, 0.3 * turn)


def true_estimates(m: Motion, controller: Adaptive) -> Any:
    """Return the estimates of one who knows: J less its turning part, J_s - J_t, J_g."""
    u, a = m.plant.units, axes(m.array, m.start.delta)
    whole = m.plant.inertia(a)
    turning = u.spin_inertia - u.transverse_inertia
    rest = whole - sum(d * np.outer(s, s) for d, s in zip(turning, a.s, strict=True))
    six = [rest[0, 0], rest[1, 1], rest[2, 2], rest[0, 1], rest[0, 2], rest[1, 2]]
    return controller.init(m.array)._replace(
        theta1=np.array([*six, *turning]),
        theta2=np.concatenate([u.gimbal_inertia, turning]),
        begun=1.0,
    )


def r_of(m: Motion, controller: Adaptive, t: float) -> np.ndarray:
    """Return r = omega - C omega_R + alpha e by SciPy's rotations."""
    o = m.observation(t)
    body, wanted = (Rotation.from_quat([*q[1:], q[0]]) for q in (o.q_BN, o.q_RN))
    e = (wanted.inv() * body).as_quat(canonical=True)[:3]
    return o.omega_BN_B - body.inv().apply(wanted.apply(o.omega_RN_R)) + controller.alpha * e


def slope(f: Any, h: float = 2e-4) -> Any:
    """Return f'(0) by differences of fourth order."""
    return (8.0 * (f(h) - f(-h)) - (f(2.0 * h) - f(-2.0 * h))) / (12.0 * h)


@pytest.mark.parametrize("seed", range(6))
@every_layout
def test_the_error_dynamics_are_those_of_the_equations_of_motion(
    layout: str, parameters: dict[str, Any], seed: int
) -> None:
    """Eq 21: J r_dot = Y_1 theta_1 - Q [accelerations, rates] - omega x h - J_dot r / 2.

    J_dot and r_dot from the integrated motion by differences.
    """
    controller = Adaptive(k=0.3, alpha=0.7, kp=0.4, Gamma1=0.0, Gamma2=0.0)
    m = motion(layout, parameters, seed)
    now, known = m.observation(0.0), true_estimates(m, controller)
    torque, _ = controller.step(now, known)
    Q = controller.torque_matrix(now, known)
    r = r_of(m, controller, 0.0)
    body, wanted = (Rotation.from_quat([*q[1:], q[0]]) for q in (now.q_BN, now.q_RN))
    e = (wanted.inv() * body).as_quat(canonical=True)[:3]
    feedforward = -torque - controller.k * r - controller.kp * e

    def inertia(t: float) -> Any:
        return m.plant.inertia(axes(m.array, m.start.delta + t * m.rates))

    r_dot = slope(lambda t: r_of(m, controller, t))
    moved = Q @ np.concatenate([m.acceleration, m.rates])
    turning = np.cross(now.omega_BN_B, now.momentum)
    given = feedforward - moved - turning - 0.5 * slope(inertia) @ r
    np.testing.assert_allclose(inertia(0.0) @ r_dot, given, rtol=0, atol=2e-7)


@every_layout
def test_what_is_learned_follows_the_gradient_of_the_torque(
    layout: str, parameters: dict[str, Any]
) -> None:
    """theta_dot = Gamma Y^T r, with Y from the torque and from Q by differences of theta."""
    controller = Adaptive(k=0.3, alpha=0.7, kp=0.4, Gamma1=0.02, Gamma2=0.05, Gamma3=0.1)
    m = motion(layout, parameters, 3)
    now, period = m.observation(0.0, period=0.004), 0.004
    known, n = true_estimates(m, controller), m.array.n
    r = r_of(m, controller, 0.0)
    learned = controller.step(now, known)[1]
    still = replace(controller, Gamma1=0.0, Gamma2=0.0, Gamma3=0.0)

    def torque(theta1: Any) -> Any:
        return -still.step(now, known._replace(theta1=theta1))[0]

    def moved(theta2: Any) -> Any:
        Q = still.torque_matrix(now, known._replace(theta2=theta2))
        return -Q @ np.concatenate([m.acceleration, m.rates])

    for gain, theta, new, f in (
        (0.02, known.theta1, learned.theta1, torque),
        (0.05, known.theta2, learned.theta2, moved),
    ):
        Y = np.stack([f(theta + d) - f(theta) for d in np.eye(len(theta))], axis=1)
        np.testing.assert_allclose(new - theta, period * gain * Y.T @ r, rtol=1e-8, atol=1e-12)
    np.testing.assert_allclose(learned.torque, period * 0.1 * r)
    assert learned.theta1.shape == (6 + n,) and learned.theta2.shape == (2 * n,)


def test_the_wheels_columns_of_Q_are_known() -> None:
    m, controller = motion("pyramid", {}, 1), Adaptive()
    for estimates in (controller.init(m.array), true_estimates(m, controller)):
        Q = controller.torque_matrix(m.observation(0.0), estimates)
        s = axes(m.array, m.start.delta).s
        np.testing.assert_allclose(Q[:, :4], (s * WHEEL[:4, None]).T, atol=1e-18)
    blank = controller.torque_matrix(m.observation(0.0), controller.init(m.array))
    jacobian = np.cross(m.array.gimbal_axes, s) * (WHEEL[:4] * m.start.speed)[:, None]
    np.testing.assert_allclose(blank[:, 4:], jacobian.T, atol=1e-15)


def test_the_first_sample_and_a_cut_period_teach_nothing() -> None:
    controller = Adaptive(Gamma3=0.1)
    m = motion("pyramid", {}, 2)
    blank = controller.init(m.array)
    first = controller.step(m.observation(0.0), blank)[1]
    assert first.begun == 1.0
    assert not first.theta1.any() and not first.theta2.any() and not first.torque.any()
    known = true_estimates(m, controller)
    cut = controller.step(m.observation(0.0, limited=1.0), known)[1]
    for before, after in zip(known, cut, strict=True):
        np.testing.assert_array_equal(before, after)
    free = controller.step(m.observation(0.0), known)[1]
    assert np.all(free.theta1 != known.theta1) and np.all(free.torque != 0.0)


def test_estimates_stay_within_their_bounds() -> None:
    m = motion("pyramid", {}, 5)
    loud = Adaptive(Gamma1=1e6, Gamma2=1e6, inertia_bound=0.3, unit_inertia_bound=0.02)
    state = loud.step(m.observation(0.0), loud.init(m.array))[1]
    for t in (0.0, 0.01, 0.02):
        state = loud.step(m.observation(t), state)[1]
        assert np.abs(state.theta1).max() == 0.3 and np.abs(state.theta2).max() == 0.02
        assert np.abs(state.theta1).min() <= 0.3


def test_with_the_truth_the_reference_needs_no_feedback() -> None:
    """On the reference the torque is Euler's for the inertia at these gimbal angles."""
    m, controller = motion("box90", {}, 7), Adaptive(alpha=0.9)
    s = m.start
    at = replace(
        m.observation(0.0),
        q_RN=s.q,
        omega_RN_R=s.omega,
        alpha_RN_R=np.array([0.3, -0.2, 0.5]),
    )
    torque, _ = controller.step(at, true_estimates(m, controller))
    J = m.plant.inertia(axes(m.array, s.delta))
    expected = J @ at.alpha_RN_R + np.cross(s.omega, J @ s.omega)
    np.testing.assert_allclose(torque, expected, rtol=1e-10)


def test_an_outside_torque_is_taken_off() -> None:
    m, controller = motion("roof", {}, 8), Adaptive(Gamma3=0.5)
    known = true_estimates(m, controller)
    frozen = m.observation(0.0, limited=1.0)
    outside = np.array([1e-3, -2e-3, 5e-4])
    with_it = controller.step(frozen, known._replace(torque=outside))[0]
    np.testing.assert_allclose(controller.step(frozen, known)[0] - with_it, outside, atol=1e-15)


def test_without_an_array_it_learns_the_inertia_of_the_body() -> None:
    """A rigid body that tracks a turn about changing axes comes to know its inertia's action."""
    controller = controllers.create("adaptive", k=2.0, alpha=1.0, kp=1.0, Gamma1=30.0)
    inertia, dt = np.array([[1.2, 0.1, 0.0], [0.1, 0.9, -0.2], [0.0, -0.2, 1.5]]), 0.01
    state, omega, q = controller.init(), np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0])
    q_R, errors, inverse = q.copy(), [], np.linalg.inv(inertia)
    for k in range(4000):
        t = k * dt
        w, phase = np.array([0.7, 1.1, 1.6]), np.array([0.0, 1.0, 2.0])
        omega_R, alpha_R = 0.5 * np.sin(w * t + phase), 0.5 * w * np.cos(w * t + phase)
        seen = AttitudeObservation(q, omega, q_R, omega_R, alpha_R, np.eye(3), np.zeros(3), t, dt)
        torque, state = controller.step(seen, state)
        errors.append(np.linalg.norm(seen.q_BR[1:]))
        omega = omega + dt * inverse @ (torque - np.cross(omega, inertia @ omega))
        q, q_R = (turned(v, rate, dt) for v, rate in ((q, omega), (q_R, omega_R)))
    learned = np.array(state.theta1)
    true = [1.2, 0.9, 1.5, 0.1, 0.0, -0.2]
    np.testing.assert_allclose(learned, true, atol=0.08)
    assert max(errors[-500:]) < 0.1 * max(errors)


def turned(q: np.ndarray, omega: np.ndarray, dt: float) -> np.ndarray:
    x, y, z, w = (Rotation.from_quat([*q[1:], q[0]]) * Rotation.from_rotvec(omega * dt)).as_quat()
    return np.array([w, x, y, z])


@pytest.mark.parametrize(
    ("key", "value"),
    [("k", 0.0), ("alpha", -1.0), ("kp", 0.0), ("Gamma1", -1e-3), ("Gamma2", np.inf),
     ("Gamma3", -1.0), ("inertia_bound", 0.0), ("unit_inertia_bound", -1.0)],
)  # fmt: skip
def test_gains_that_cannot_be_are_refused(key: str, value: float) -> None:
    with pytest.raises(InputError, match=f"controller.{key}"):
        controllers.create("adaptive", **{key: value})


def test_it_says_what_it_is() -> None:
    assert Adaptive.learns_inertia and Adaptive.knows_torque_matrix and Adaptive.follows_profile
    others = [controllers.get(name) for name in controllers.names() if name != "adaptive"]
    assert not any(other.learns_inertia or other.knows_torque_matrix for other in others)
