"""Every registered attitude controller, as created by default, held to what all must do."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest

from nullmotion import rotation, tree
from nullmotion.compile import compile_function
from nullmotion.spacecraft import AttitudeObservation, Controller, controllers

INERTIA = np.array([[12.0, -1.5, 0.8], [-1.5, 9.0, 1.1], [0.8, 1.1, 14.0]])
ORDER = ("q_BN", "omega_BN_B", "q_RN", "omega_RN_R", "alpha_RN_R", "momentum")

every = pytest.mark.parametrize("name", controllers.names())


@cache
def compiled(name: str) -> Any:
    """Return a controller as a kernel; its parameters and the inertia are inputs."""
    controller = controllers.create(name)
    like = (np.zeros(4), np.zeros(3), np.zeros(4), np.zeros(3), np.zeros(3), np.zeros(3))

    def torque(*given: Any) -> Any:
        *seen, inertia, controller, state = given
        observation = AttitudeObservation(
            **dict(zip(ORDER, seen, strict=True)), inertia=inertia, t=0.0, period=0.01
        )
        return controller.step(observation, state)[0]

    return compile_function(torque, *like, INERTIA, controller, controller.init())


def torques(name: str, **seen: Any) -> np.ndarray:
    """Return torques (N, 3) at N observations, by the kernel."""
    controller, count = controllers.create(name), len(seen["q_BN"])
    full = {"q_RN": np.tile([1.0, 0.0, 0.0, 0.0], (count, 1))} | seen
    columns = [full.get(key, np.zeros((count, 3))) for key in ORDER]

    def tiled(record: Any) -> np.ndarray:
        return np.tile(np.array(tree.flatten(record), float), (count, 1))

    inertia = np.tile(INERTIA, (count, 1, 1))
    return compiled(name)(*columns, inertia, tiled(controller), tiled(controller.init()))


def plainly(name: str, **seen: Any) -> np.ndarray:
    controller, count = controllers.create(name), len(seen["q_BN"])
    found = []
    for i in range(count):
        now = {key: value[i] for key, value in seen.items()}
        zeros = {key: np.zeros(3) for key in ORDER if key not in now}
        observation = AttitudeObservation(**zeros, **now, inertia=INERTIA, t=0.0, period=0.01)
        found.append(controller.step(observation, controller.init())[0])
    return np.array(found)


def attitudes(count: int) -> np.ndarray:
    """Return attitudes of every size of angle, half turns, and those close to no turn."""
    rng = np.random.default_rng(4)
    axis = rng.normal(size=(count, 3))
    axis[: count // 4] = np.eye(3)[rng.integers(0, 3, count // 4)]
    axis /= np.linalg.norm(axis, axis=1, keepdims=True)
    half = np.concatenate(
        [
            rng.uniform(0, np.pi, count // 2),
            10.0 ** rng.uniform(-200, -1, count // 4),
            0.5 * np.pi
            + rng.choice([-1, 1], count // 4) * 10.0 ** rng.uniform(-15, -1, count // 4),
        ]
    )
    half = rng.permutation(half)
    q = np.concatenate([np.cos(half)[:, None], np.sin(half)[:, None] * axis], axis=1)
    return np.concatenate([q, np.eye(4), -np.eye(4)])


def random_observations(count: int) -> dict[str, np.ndarray]:
    q, rng = attitudes(count), np.random.default_rng(6)
    vectors = {
        key: rng.normal(size=(len(q), 3)) * 10.0 ** rng.uniform(-3, 1, (len(q), 1))
        for key in ORDER
        if not key.startswith("q")
    }
    return {"q_BN": q, "q_RN": rng.permutation(q)} | vectors


@every
def test_compiled_equals_plain(name: str) -> None:
    seen = random_observations(80)
    error = rotation.multiply(rotation.conjugate(seen["q_RN"].T), seen["q_BN"].T)[0]
    seen = {key: value[np.abs(error) > 1e-9] for key, value in seen.items()}  # sign is rounding
    found, expected = torques(name, **seen), plainly(name, **seen)
    scale = np.linalg.norm(expected, axis=1, keepdims=True)
    assert np.all(np.abs(found - expected) < 1e-12 * scale + 1e-13)


@every
def test_finite_for_any_attitude(name: str) -> None:
    assert np.isfinite(torques(name, **random_observations(4000))).all()
    q = attitudes(4000)
    assert np.isfinite(torques(name, q_BN=q)).all()
    assert np.isfinite(plainly(name, q_BN=q[-8:], q_RN=np.tile([1.0, 0, 0, 0], (8, 1)))).all()


@every
def test_q_and_minus_q_are_the_same_attitude(name: str) -> None:
    seen = random_observations(4000)
    error = rotation.multiply(rotation.conjugate(seen["q_RN"].T), seen["q_BN"].T)[0]
    seen = {key: value[error != 0.0] for key, value in seen.items()}
    expected = torques(name, **seen)
    for key in ("q_BN", "q_RN"):
        np.testing.assert_array_equal(torques(name, **seen | {key: -seen[key]}), expected)


@every
def test_no_torque_at_the_target_at_rest(name: str) -> None:
    exact = np.concatenate([np.eye(4), -np.eye(4)])
    assert np.all(torques(name, q_BN=exact, q_RN=exact) == 0.0)
    q = attitudes(1000)
    assert np.abs(torques(name, q_BN=q, q_RN=q)).max() < 1e-13


@every
def test_torque_turns_back_and_slows_down(name: str) -> None:
    """At rest against the error, at the target against the rate."""
    q = attitudes(2000)
    q = q[(np.linalg.norm(q[:, 1:], axis=1) > 1e-100) & (q[:, 0] != 0.0)]
    error = q[:, 1:] * np.sign(q[:, :1])
    error /= np.linalg.norm(error, axis=1, keepdims=True)
    assert np.all(np.sum(error * torques(name, q_BN=q), axis=1) < 0.0)
    omega = np.random.default_rng(2).normal(size=(500, 3))
    at_target = np.tile([1.0, 0.0, 0.0, 0.0], (500, 1))
    assert np.all(np.sum(omega * torques(name, q_BN=at_target, omega_BN_B=omega), axis=1) < 0.0)


@every
def test_a_following_controller_needs_no_feedback_on_its_reference(name: str) -> None:
    """Its torque on the reference is Euler's equation; the others take no notice of its motion.

    One that finds the inertia out while it flies gives no torque there at its first sample.
    """
    seen = random_observations(500)
    if not controllers.get(name).follows_profile:
        still = {k: v for k, v in seen.items() if k not in ("omega_RN_R", "alpha_RN_R")}
        np.testing.assert_array_equal(torques(name, **seen), torques(name, **still))
        return
    seen |= {"q_BN": seen["q_RN"], "omega_BN_B": seen["omega_RN_R"]}
    if controllers.get(name).learns_inertia:  # at first it does not know what the motion takes
        assert np.abs(torques(name, **seen)).max() < 1e-12
        return
    omega, alpha = seen["omega_RN_R"], seen["alpha_RN_R"]
    expected = alpha @ INERTIA + np.cross(omega, omega @ INERTIA)
    np.testing.assert_allclose(torques(name, **seen), expected, rtol=1e-9, atol=1e-9)


@every
def test_parameters_and_state_are_floats(name: str) -> None:
    controller = controllers.create(name)
    assert isinstance(controller, Controller) and controller.full_name and controller.citation
    for leaf in tree.flatten((controller, controller.init())):
        assert isinstance(leaf, float)
