"""Attitude controllers on a rigid body without an array, against what they promise."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import pytest

from nullmotion import rotation, tree
from nullmotion.compile import compile_function
from nullmotion.errors import InputError, UnknownNameError
from nullmotion.spacecraft import AttitudeObservation, controllers, reference

FULL = np.array([[12.0, -1.5, 0.8], [-1.5, 9.0, 1.1], [0.8, 1.1, 14.0]])
IDENTITY = np.array([1.0, 0.0, 0.0, 0.0])
REST = np.zeros(3)
Target = Callable[[float], np.ndarray]  # time -> q_RN, omega_RN_R, alpha_RN_R


class Run(NamedTuple):
    t: np.ndarray
    q: np.ndarray  # attitude error q_BR
    omega: np.ndarray
    acceleration: np.ndarray

    @property
    def angle(self) -> np.ndarray:
        return 2.0 * np.arctan2(np.linalg.norm(self.q[:, 1:], axis=1), self.q[:, 0])

    @property
    def speed(self) -> np.ndarray:
        return np.linalg.norm(self.omega, axis=1)


def observed(q: Any, omega: Any, row: Any, inertia: Any, t: float = 0.0) -> AttitudeObservation:
    return AttitudeObservation(q, omega, row[:4], row[4:7], row[7:], inertia, np.zeros(3), t, 0.01)


def at(q: Any) -> Target:
    row = np.concatenate([q, np.zeros(6)])
    return lambda t: row


HOME = at(IDENTITY)


def fly(
    controller: Any,
    q: Any = IDENTITY,
    omega: Any = REST,
    target: Target = HOME,
    seconds: float = 60.0,
    dt: float = 0.1,
    inertia: np.ndarray = FULL,
) -> Run:
    """Fly by RK4, the controller continuous."""
    inverse = np.linalg.inv(inertia)

    def slope(t: float, y: np.ndarray) -> np.ndarray:
        seen = observed(y[:4], y[4:], target(t), inertia, t)
        torque, _ = controller.step(seen, controller.init())
        acceleration = inverse @ (torque - np.cross(y[4:], inertia @ y[4:]))
        return np.concatenate([0.5 * rotation.doubled_rate(y[:4], y[4:]), acceleration])

    y = np.concatenate([q, omega]).astype(float)
    rows = []
    for k in range(round(seconds / dt) + 1):
        t = k * dt
        a = slope(t, y)
        error = observed(y[:4], y[4:], target(t), inertia).q_BR
        rows.append(np.concatenate([[t], error, y[4:], a[4:]]))
        b = slope(t + 0.5 * dt, y + 0.5 * dt * a)
        c = slope(t + 0.5 * dt, y + 0.5 * dt * b)
        d = slope(t + dt, y + dt * c)
        y = y + dt / 6.0 * (a + 2.0 * (b + c) + d)
        y[:4] /= np.linalg.norm(y[:4])
    table = np.array(rows)
    return Run(table[:, 0], table[:, 1:5], table[:, 5:8], table[:, 8:])


def turned(axis: Any, degrees: float) -> np.ndarray:
    unit = np.asarray(axis, float) / np.linalg.norm(axis)
    half = 0.5 * np.radians(degrees)
    return np.concatenate([[np.cos(half)], np.sin(half) * unit])


def all_of_them() -> list[Any]:
    return [
        controllers.create("quaternion-feedback"),
        controllers.create("quaternion-feedback", kp=8.0, kw=12.0),
        controllers.create("quaternion-feedback", kp=(7, 5, 8), kw=(13, 9, 15)),
        controllers.create("tracking"),
        controllers.create("tracking", kp=8.0, kw=(12.0, 12.0, 14.0)),
        controllers.create("eigenaxis-slew", slew_rate_deg_s=5.0),
        controllers.create("eigenaxis-slew", slew_rate_deg_s=5, acceleration_deg_s2=0.8),
        controllers.create("eigenaxis-slew", slew_rate_deg_s=5.0, feed_forward=False),
    ]


@pytest.mark.parametrize("controller", all_of_them(), ids=repr)
@pytest.mark.sampled(2)
def test_target_is_reached_from_a_tumble(controller: Any) -> None:
    run = fly(
        controller, turned([1, -2, 0.5], 170.0), [0.1, 0.06, -0.15], at(turned([0, 1, 1], 50)), 80.0
    )
    assert run.angle[-1] < 1e-5
    assert run.speed[-1] < 1e-5


@pytest.mark.parametrize("controller", all_of_them()[::3], ids=repr)
@pytest.mark.sampled(1)
def test_both_signs_of_the_quaternion_go_the_shorter_way(controller: Any) -> None:
    start = turned([1, 0.3, -0.2], 150.0)
    one, other = (fly(controller, q, seconds=30.0) for q in (start, -start))
    np.testing.assert_array_equal(one.omega, other.omega)
    assert one.angle.max() == pytest.approx(np.radians(150.0))
    long_way = fly(controller, turned([1, 0.3, -0.2], 210.0), seconds=30.0)
    assert long_way.angle.max() == pytest.approx(np.radians(150.0))
    np.testing.assert_allclose(long_way.omega[1] @ one.omega[1], -(one.speed[1] ** 2), rtol=1e-4)


@pytest.mark.parametrize("name", ["quaternion-feedback", "tracking", "eigenaxis-slew"])
@pytest.mark.parametrize("damping", [0.5, 1.0])
@pytest.mark.sampled(2)
def test_a_small_error_answers_with_the_frequency_and_damping_asked(
    name: str, damping: float
) -> None:
    w, start = 0.8, 1e-4
    controller = controllers.create(name, natural_frequency_rad_s=w, damping=damping)
    axis = np.array([2.0, -1.0, 1.0]) / np.sqrt(6.0)
    run = fly(controller, turned(axis, np.degrees(start)), seconds=15.0, dt=0.05)
    angle = 2.0 * run.q[:, 1:] @ axis
    if damping == 1.0:
        exact = start * (1.0 + w * run.t) * np.exp(-w * run.t)
    else:
        turning = w * np.sqrt(1.0 - damping**2)
        share = damping * w / turning
        decay = np.exp(-damping * w * run.t)
        exact = start * decay * (np.cos(turning * run.t) + share * np.sin(turning * run.t))
    np.testing.assert_allclose(angle, exact, atol=1e-5 * start)


@pytest.mark.parametrize("acceleration", [None, 0.3, 2.0])
@pytest.mark.parametrize("damping", [0.7, 1.0])
@pytest.mark.parametrize("degrees", [20.0, 179.0])
@pytest.mark.sampled(2)
def test_eigenaxis_slew_keeps_axis_rate_and_acceleration(
    acceleration: float | None, damping: float, degrees: float
) -> None:
    axis = np.array([1.0, 2.0, -0.7]) / np.linalg.norm([1.0, 2.0, -0.7])
    limit = np.radians(4.0)
    controller = controllers.create(
        "eigenaxis-slew",
        damping=damping,
        slew_rate_deg_s=4.0,
        acceleration_deg_s2=acceleration,
    )
    run = fly(controller, turned(axis, degrees), seconds=90.0)
    assert run.speed.max() < limit * 1.0001
    if degrees > 80:
        assert run.speed.max() > 0.99 * limit
    across = np.eye(3) - np.outer(axis, axis)
    assert np.abs(run.omega @ across).max() < 1e-12
    assert np.abs(run.q[:, 1:] @ across).max() < 1e-12
    overshoot = -(run.q[:, 1:] @ axis).min()
    assert overshoot < (1e-9 if damping == 1.0 else 0.046 * np.sin(np.radians(degrees / 2)))
    assert run.angle[-1] < 1e-4
    if acceleration is not None:
        largest = np.linalg.norm(run.acceleration, axis=1).max()
        assert largest < np.radians(acceleration) * (1 + 1e-9)


def test_without_feed_forward_the_axis_drifts() -> None:
    axis = np.array([1.0, 2.0, -0.7]) / np.linalg.norm([1.0, 2.0, -0.7])
    controller = controllers.create("eigenaxis-slew", slew_rate_deg_s=4.0, feed_forward=False)
    run = fly(controller, turned(axis, 120.0), seconds=40.0)
    assert np.abs(np.cross(run.omega, axis)).max() > 1e-4


def moving(seconds: float, dt: float) -> Target:
    """Return a slew there and back about another axis, at the times that RK4 asks for."""
    first, second = turned([1, 1, -2], 40.0), turned([-1, 0.3, 0.2], 130.0)
    t = np.arange(0.0, 2.0 * seconds, 0.5 * dt)
    there = reference.eigenaxis_slew(first, second, seconds, t[t < seconds])
    back = reference.eigenaxis_slew(second, first, seconds, t[t >= seconds] - seconds)
    table = np.concatenate([there, back, back[-1:]])
    return lambda t: table[min(round(2.0 * t / dt), len(table) - 1)]


def test_tracking_stays_on_a_reference_that_it_starts_on() -> None:
    target = moving(20.0, 0.05)
    controller = controllers.create("tracking", natural_frequency_rad_s=0.5)
    run = fly(controller, target(0.0)[:4], REST, target, seconds=39.0, dt=0.05)
    assert run.speed.max() > 0.1
    assert run.angle.max() < 1e-6


def test_tracking_comes_to_a_reference_and_feedback_alone_lags() -> None:
    target, start = moving(30.0, 0.1), turned([0, 0, 1], -60.0)
    omega = np.array([0.05, -0.1, 0.02])
    found = fly(controllers.create("tracking"), start, omega, target, seconds=50.0)
    assert found.angle[0] > 0.5 and found.angle[-1] < 1e-6
    lagging = fly(controllers.create("quaternion-feedback"), start, omega, target, seconds=50.0)
    assert lagging.angle[-1] > 0.05


def test_tracking_error_obeys_its_own_equation() -> None:
    """The acceleration of the error depends on the error alone, whatever the reference does."""
    controller = controllers.create("tracking", kp=6.0, kw=10.0)
    rng = np.random.default_rng(1)
    error, rate = turned(rng.normal(size=3), 80.0), rng.normal(size=3)
    found = []
    for _ in range(5):
        row = np.concatenate([turned(rng.normal(size=3), 200.0), rng.normal(size=6)])
        C = rotation.matrix(error)
        omega = rate + C @ row[4:7]
        q = rotation.multiply(row[:4], error)
        torque, _ = controller.step(observed(q, omega, row, FULL), ())
        own = np.linalg.solve(FULL, torque - np.cross(omega, FULL @ omega))
        found.append(own - C @ row[7:] + np.cross(rate, C @ row[4:7]))
    expected = np.linalg.solve(FULL, -6.0 * error[1:] - 10.0 * rate)
    np.testing.assert_allclose(found, np.tile(expected, (5, 1)), atol=1e-12)


@pytest.mark.parametrize("controller", all_of_them(), ids=repr)
def test_compiled_code_agrees_with_floats(controller: Any, rng: np.random.Generator) -> None:
    """Gains of every shape may be inputs of a kernel."""

    def step(q: Any, omega: Any, row: Any, controller: Any) -> Any:
        return controller.step(observed(q, omega, row, FULL), controller.init())[0]

    run = compile_function(step, np.zeros(4), np.zeros(3), np.zeros(10), controller)
    q, rows = rng.normal(size=(50, 4)), rng.normal(size=(50, 10))
    q /= np.linalg.norm(q, axis=1, keepdims=True)
    rows[:, :4] /= np.linalg.norm(rows[:, :4], axis=1, keepdims=True)
    omega = rng.normal(size=(50, 3))
    found = run(q, omega, rows, np.tile(tree.flatten(controller), (50, 1)))
    for i in range(50):
        expected = step(q[i], omega[i], rows[i], controller)
        np.testing.assert_allclose(found[i], expected, rtol=1e-12, atol=1e-12)


WRONG = [
    ({"kp": 1.0}, "kw"),
    ({"kw": (1.0, 2.0, 3.0)}, "kp"),
    ({"kp": 1.0, "kw": 1.0, "natural_frequency_rad_s": 0.5}, "natural_frequency_rad_s"),
    ({"kp": 1.0, "kw": 1.0, "damping": 1.0}, "damping"),
    ({"kp": -1.0, "kw": 1.0}, "kp"),
    ({"kp": 1.0, "kw": (1.0, 0.0, 1.0)}, "kw"),
    ({"kp": (1.0, 2.0), "kw": 1.0}, "kp"),
    ({"kp": np.inf, "kw": 1.0}, "kp"),
    ({"natural_frequency_rad_s": 0.0}, "natural_frequency_rad_s"),
    ({"damping": np.nan}, "damping"),
    ({"damping": "much"}, "damping"),
]


@pytest.mark.parametrize("name", ["quaternion-feedback", "tracking"])
@pytest.mark.parametrize(("parameters", "key"), WRONG)
def test_gains_that_are_refused(name: str, parameters: dict[str, Any], key: str) -> None:
    with pytest.raises(InputError) as refused:
        controllers.create(name, **parameters)
    assert refused.value.key == f"controller.{key}"


@pytest.mark.parametrize("key", ["natural_frequency_rad_s", "slew_rate_deg_s", "damping"])
@pytest.mark.parametrize("value", [0.0, -1.0, np.nan, np.inf, True])
def test_slew_parameters_that_are_refused(key: str, value: Any) -> None:
    with pytest.raises(InputError) as refused:
        controllers.create("eigenaxis-slew", **{key: value})
    assert refused.value.key == f"controller.{key}"


def test_unknown_names() -> None:
    with pytest.raises(UnknownNameError, match="eigenaxis-slew"):
        controllers.create("eigenaxis")
    with pytest.raises(UnknownNameError, match="slew_rate_deg_s"):
        controllers.create("eigenaxis-slew", slew_rate=1.0)


def test_defaults_are_numbers_once_made() -> None:
    made = controllers.create("tracking")
    assert (made.natural_frequency_rad_s, made.damping) == (0.5, 1.0)
    assert controllers.create("tracking", natural_frequency_rad_s=2).damping == 1.0
    assert controllers.create("tracking", kp=[1, 2, 3], kw=4).kp == (1.0, 2.0, 3.0)
