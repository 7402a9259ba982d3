"""Attitude runs: kernel against Python, batches, sensors, desaturation, what is refused."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import product
from typing import Any, ClassVar

import numpy as np
import pytest
from scipy import stats
from scipy.spatial.transform import Rotation

import nullmotion as nm
from nullmotion import metrics
from nullmotion.errors import InputError
from nullmotion.sim import Setup, Stop, run, run_batch
from nullmotion.spacecraft import (
    Controller,
    Desaturation,
    Disturbance,
    Event,
    Orbit,
    Sensors,
    Servo,
    Spacecraft,
    controllers,
)

SLOW = pytest.mark.slow
INERTIA = np.array([[12.0, -1.5, 0.8], [-1.5, 9.0, 1.1], [0.8, 1.1, 14.0]])
TARGET = np.array([0.8, 0.4, -0.3, 0.33])
METRICS = tuple(
    metrics.get(name)()
    for name in ("pointing_error_deg", "settling_time_s", "motor_power_W", "rate_step_rad_s")
)


def slew(**more: Any) -> Setup:
    """Return a slew of 74 deg by a pyramid."""
    base = {
        "array": nm.layouts.pyramid(rate_limit=1.0),
        "law": nm.laws.create("sr"),
        "delta": np.radians([10.0, -20.0, 30.0, 5.0]),
        "hdot": np.zeros(3),
        "dt": 0.01,
        "spacecraft": Spacecraft(INERTIA),
        "controller": controllers.create("quaternion-feedback", kp=4.0, kw=12.0),
        "target": TARGET,
    }
    return Setup(**{**base, **more})


FAULTS = (
    Event("slow", 0, 0.4, 0.2, rate_limit=0.1),
    Event("spin-down", 1, 0.3, 0.2, time_constant=0.5, final_fraction=0.3),
    Event("stuck", 2, 0.6, 0.2),
)
SERVO = {
    "time_constant": 0.05,
    "rate_limit": 0.8,
    "acceleration_limit": 15.0,
    "torque_limit": 0.3,
    "friction": 0.002,
    "inertia": 0.05,
}
OUTSIDE = Disturbance(
    np.array([0.02, -0.01, 0.03]), np.array([0.05, 0.04, -0.06]), 0.8, 0.6, Orbit(0.05, 0.7, 0.4)
)


def flown(
    servo: bool,
    encoder: bool,
    events: bool,
    sensors: bool,
    disturbance: bool,
    desaturation: bool,
    late: bool,
    **more: Any,
) -> Setup:
    """Return a slew of 1.6 s with some of everything."""
    values = (SERVO if servo else {}) | ({"encoder_resolution": 1e-4} if encoder else {})
    noisy = Sensors(1e-3, [0.002, -0.001, 0.003], 5e-4, seed=3)
    return slew(
        dt=0.02,
        steps=80,
        servo=Servo(**values) if values else None,
        events=FAULTS if events else (),
        sensors=noisy if sensors else None,
        disturbance=OUTSIDE if disturbance else None,
        desaturation=Desaturation(0.3, 0.8, 0.1) if desaturation else None,
        period_steps=5 if late else 1,
        delay_steps=3 if late else 0,
        metrics=METRICS,
        **more,
    )


# all pairs of on and off of seven things in eight runs
PAIRS = [(a, b, a ^ b, c, a ^ c, b ^ c, a ^ b ^ c) for a, b, c in product((False, True), repeat=3)]
# all quadruples but a few: a fraction of all 128 of resolution IV
MOST = [
    (a, b, c, d, e, a ^ b ^ c ^ d, a ^ b ^ d ^ e)
    for a, b, c, d, e in product((False, True), repeat=5)
]


def agree(what: Setup) -> None:
    a, b = run(what, backend="kernel"), run(what, backend="python")
    names = ("delta", "rates", "rates_asked", "hdot", "momentum_wanted", "impulse", "q_BN")
    names += ("omega_BN_B", "reference", "speed", "motor_torque")
    for name in names:
        x, y = getattr(a, name), getattr(b, name)
        assert x.shape == y.shape and np.isfinite(y[:-1]).all()
        np.testing.assert_allclose(x, y, rtol=1e-9, atol=1e-9, err_msg=name)
    assert a.metrics.keys() == b.metrics.keys()
    for name, value in b.metrics.items():
        assert a.metrics[name] == pytest.approx(value, rel=1e-9, abs=1e-9, nan_ok=True), name


@pytest.mark.parametrize(
    "on",
    [*PAIRS[3::4], *[pytest.param(x, marks=SLOW) for x in MOST if x not in PAIRS[3::4]]],
    ids=lambda x: "".join("-+"[v] for v in x),
)
def test_kernel_and_python_agree(on: tuple[bool, ...]) -> None:
    agree(flown(*on))


@pytest.mark.parametrize("integrator", ["semi-implicit-euler", pytest.param("euler", marks=SLOW)])
def test_kernel_and_python_agree_with_every_integrator(integrator: Any) -> None:
    agree(flown(*[True] * 7, integrator=integrator))


def test_end_stops_and_plant_errors_agree() -> None:
    array = nm.layouts.pyramid(rate_limit=1.0, angle_limits=np.radians([-31.0, 31.0]))
    plant = nm.layouts.pyramid(h0=[1.02, 0.97, 1.01, 0.99], angle_limits=np.radians([-31.0, 31.0]))
    what = flown(*[True] * 7, array=array, plant=plant, encoder_bias=np.full(4, 0.01))
    agree(what)
    assert np.degrees(run(what).delta).max() == pytest.approx(31.0, abs=1e-9)


def test_batch_of_attitudes_equals_single_runs(rng: Any) -> None:
    """Bit for bit: lanes, threads and blocks change nothing."""
    runs = 21
    target, q_BN = rng.normal(size=(runs, 4)), rng.normal(size=(runs, 4))
    omega, delta = rng.normal(scale=0.03, size=(runs, 3)), rng.uniform(-1, 1, (runs, 4))
    base = flown(True, False, True, True, True, True, True)
    batch = run_batch(
        base, target=target, q_BN=q_BN, omega_BN_B=omega, delta=delta, threads=2, history=1
    )
    assert batch.final_q_BN is not None and batch.final_omega_BN_B is not None
    assert batch.final_q_BN.shape == (runs, 4) and batch.final_omega_BN_B.shape == (runs, 3)
    for i in (9, 20):
        craft = Spacecraft(INERTIA, q_BN[i], omega[i])
        one = run(replace(base, spacecraft=craft, target=target[i], delta=delta[i]))
        assert one.q_BN is not None and one.omega_BN_B is not None
        np.testing.assert_array_equal(batch.history.delta[i], one.delta)
        np.testing.assert_array_equal(batch.history.q_BN[i], one.q_BN)
        np.testing.assert_array_equal(batch.final_q_BN[i], one.q_BN[-1])
        np.testing.assert_array_equal(batch.final_omega_BN_B[i], one.omega_BN_B[-1])
        np.testing.assert_allclose(batch.final_momentum[i], one.momentum[-1], rtol=0, atol=1e-14)
        for name, values in batch.metrics.items():
            assert values[i] == pytest.approx(one.metrics[name], rel=1e-14, abs=0, nan_ok=True)
    assert len({tuple(q) for q in batch.final_q_BN}) == runs


@pytest.mark.slow
def test_batch_of_setups_varies_everything() -> None:
    """Inertia, servo, faults, noise may differ from run to run, and be ideal in some."""
    base, setups = flown(*[True] * 7), []
    for i in range(4):
        values = {k: v * (1 + 0.1 * i) for k, v in SERVO.items()}
        setups.append(
            replace(
                base,
                spacecraft=Spacecraft(INERTIA * (1 + 0.2 * i)),
                controller=controllers.create("quaternion-feedback", kp=4.0 + i, kw=12.0),
                servo=Servo() if i == 1 else Servo(**values, encoder_resolution=1e-4 * i),
                events=tuple(replace(e, at=0.1 + 0.1 * i) for e in FAULTS),
                sensors=Sensors(1e-3 * i, [0.002, -0.001, 0.003], 5e-4, seed=i),
            )
        )
    batch = run_batch(setups[0], setups=setups)
    for i in (1, 3):
        alone = run(setups[i])
        assert alone.q_BN is not None
        np.testing.assert_allclose(batch.final_q_BN[i], alone.q_BN[-1], rtol=0, atol=1e-12)
        np.testing.assert_allclose(batch.final_gimbal_rad[i], alone.delta[-1], rtol=0, atol=1e-12)


def test_batch_refuses_what_changes_the_meaning_of_a_step() -> None:
    base = slew(steps=10, metrics=METRICS)
    with pytest.raises(InputError, match="same structure"):
        run_batch(base, setups=[base, replace(base, dt=0.02)])
    with pytest.raises(InputError, match="no such value"):
        run_batch(Setup(base.array, base.law, base.delta, np.ones(3)), q_BN=np.ones((2, 4)))


def test_attitude_of_a_run() -> None:
    """Pointing error and Euler angles as SciPy has them; a quaternion stays one."""
    result = run(slew(steps=4000, spacecraft=Spacecraft(INERTIA, [0.5, -0.5, 0.1, 0.7])))
    assert result.q_BN is not None and result.pointing_error is not None
    np.testing.assert_allclose(np.linalg.norm(result.q_BN, axis=1), 1.0, atol=1e-15)
    attitude = Rotation.from_quat(np.roll(result.q_BN, -1, axis=1))
    target = Rotation.from_quat(np.roll(TARGET, -1))
    off = (target.inv() * attitude).magnitude()
    np.testing.assert_allclose(result.pointing_error, off, atol=1e-7)
    final = result.summary()["final_euler_321_deg"]
    np.testing.assert_allclose(final, attitude[-1].as_euler("ZYX", degrees=True), atol=1e-9)
    assert result.pointing_error[-1] < 0.01 < 1.0 < result.pointing_error[0]


@dataclass(frozen=True)
class Parked(nm.Law):
    """No gimbal turns."""

    name: ClassVar[str] = "test-parked"

    def step(self, array: Any, obs: Any, state: Any) -> Any:
        return np.zeros(array.n), state


BIAS = np.array([0.02, -0.01, 0.03])


@pytest.mark.parametrize(
    ("kp", "kw", "sigma", "mean"),
    [(1e-12, 1.0, 2e-3, BIAS), (1.0, 1e-12, 0.5 * 3e-3, np.zeros(3))],
    ids=["gyro", "attitude"],
)
def test_noise_of_the_sensors(kp: float, kw: float, sigma: float, mean: Any) -> None:
    """At rest, hdot = kp q_v + kw omega shows what is measured: normal, independent, unbiased.

    With the pyramid's momenta at zero angles, which cancel. The bounds are 4.5 to 5 standard
    deviations.
    """
    what = slew(
        law=Parked(),
        delta=np.zeros(4),
        steps=20000,
        target=np.array([1.0, 0.0, 0.0, 0.0]),
        spacecraft=Spacecraft(np.full(3, 1e12)),
        controller=controllers.create("quaternion-feedback", kp=kp, kw=kw),
        sensors=Sensors(2e-3, BIAS, 3e-3, seed=1),
    )
    seen = run(what).hdot
    error = 1.0 / np.sqrt(len(seen))
    np.testing.assert_allclose(seen.mean(axis=0), mean, rtol=0, atol=4.5 * sigma * error)
    np.testing.assert_allclose(seen.std(axis=0), sigma, rtol=4.5 * np.sqrt(0.5) * error)
    scaled = (seen - mean) / sigma
    assert stats.kstest(scaled.ravel(), "norm").pvalue > 1e-4
    neighbours = np.concatenate([scaled[1:], scaled[:-1]], axis=1)
    assert np.abs(np.corrcoef(neighbours.T) - np.eye(6)).max() < 5.0 * error


def test_a_seed_makes_the_noise() -> None:
    def final(seed: int) -> Any:
        noisy = Sensors(1e-3, attitude_noise=1e-3, seed=seed)
        return run(slew(steps=20, sensors=noisy), backend="python").delta[-1]

    np.testing.assert_array_equal(final(1), final(1))
    assert (final(1) != final(2)).any()


@pytest.mark.parametrize("limit", [0.02, pytest.param(np.inf, marks=SLOW)])
def test_desaturation_takes_the_momentum_off(limit: float) -> None:
    """A full array is emptied while the attitude is held.

    Under a torque T from outside the body stands still with kp theta / 2 = T: theta = 2 T / kp.
    """
    delta, threshold = np.radians([60.0, 80.0, 50.0, 70.0]), 0.05
    still = np.array([1.0, 0.0, 0.0, 0.0])
    more = {"delta": delta, "steps": 15000, "target": still, "dt": 0.02}
    with_it = run(slew(desaturation=Desaturation(limit, 0.05, threshold), **more))
    without = run(slew(**more))
    h, kept = (np.linalg.norm(r.momentum, axis=1) for r in (with_it, without))
    assert h[0] > 2.0 and kept[-1] > 2.0
    assert h[-1] < threshold and np.diff(h[500:]).max() < 1e-5
    greatest = min(limit, 0.05 * h[0])
    assert with_it.pointing_error is not None
    assert with_it.pointing_error.max() < 1.05 * 2.0 * greatest / 4.0
    assert with_it.pointing_error[-1] < 1e-6
    if np.isfinite(limit):  # until the gain asks for less than the limit it falls by the limit
        slope = (h[500] - h[4000]) / 70.0
        assert slope == pytest.approx(limit, rel=0.02)


def test_desaturation_stops_at_its_threshold() -> None:
    spare = Desaturation(0.05, 0.1, 0.8)
    still = np.array([1.0, 0.0, 0.0, 0.0])
    delta = np.radians([60.0, 80.0, 50.0, 70.0])
    result = run(slew(delta=delta, target=still, steps=10000, desaturation=spare))
    h = np.linalg.norm(result.momentum, axis=1)
    assert h[-1] == pytest.approx(0.8, abs=0.01)


@dataclass(frozen=True)
class Tell(Controller):
    """A torque that is the rate and acceleration of the reference."""

    name: ClassVar[str] = "test-tell"

    def step(self, obs: Any, state: Any) -> Any:
        return obs.omega_RN_R + 10.0 * obs.alpha_RN_R, state


@pytest.mark.parametrize("backend", ["kernel", "python"])
def test_a_reference_is_held_at_rest_after_its_last_row(backend: Any) -> None:
    rows = np.random.default_rng(3).normal(size=(4, 10))
    what = slew(
        law=Parked(),
        delta=np.zeros(4),
        steps=30,
        period_steps=5,
        target=None,
        reference=rows,
        controller=Tell(),
        spacecraft=Spacecraft(np.full(3, 1e12)),
    )
    result = run(what, backend=backend)
    index = np.minimum(np.arange(31) // 5, 3)
    np.testing.assert_allclose(result.reference, rows[index, :4])
    moving = (np.arange(31) < 20)[:, None]
    torque = np.where(moving, rows[index, 4:7] + 10.0 * rows[index, 7:], 0.0)
    np.testing.assert_allclose(result.hdot, -torque, atol=1e-12)


def test_a_run_stops_when_the_attitude_is_reached() -> None:
    stop = Stop(metrics.get("pointing_error_deg")(), 1.0)
    result = run(slew(steps=3000, stop=(stop,), metrics=METRICS))
    assert result.pointing_error is not None
    assert result.stop_reason == "pointing_error_deg below 1"
    degrees = np.degrees(result.pointing_error)
    assert degrees[-1] < 1.0 < degrees[-2]
    assert result.metrics["final_pointing_error_deg"] == pytest.approx(degrees[-1], rel=1e-9)


@pytest.mark.parametrize(
    ("key", "values"),
    [
        ("inertia", {"inertia": [1.0, 1.0, 3.0]}),
        ("inertia", {"inertia": [1.0, 1.0, -1.0]}),
        ("inertia", {"inertia": np.array([[2.0, 0.1, 0], [0, 2.0, 0], [0, 0, 2.0]])}),
        ("inertia", {"inertia": np.ones(4)}),
        ("q_BN", {"inertia": np.ones(3), "q_BN": np.zeros(4)}),
        ("q_BN", {"inertia": np.ones(3), "q_BN": np.ones(3)}),
        ("omega_BN_B", {"inertia": np.ones(3), "omega_BN_B": [0.0, np.nan, 0.0]}),
    ],
)
def test_a_spacecraft_refuses(key: str, values: dict[str, Any]) -> None:
    with pytest.raises(InputError, match=key):
        Spacecraft(**values)


@pytest.mark.parametrize(
    ("key", "make"),
    [
        ("servo.rate_limit", lambda: Servo(rate_limit=0.0)),
        ("servo.time_constant", lambda: Servo(time_constant=[-0.1, 0.1])),
        ("servo.inertia", lambda: Servo(torque_limit=0.1)),
        ("servo.inertia", lambda: Servo(friction=0.1, inertia=[0.1, 0.0])),
        ("servo.friction", lambda: slew(servo=Servo(friction=[0.1, 0.2], inertia=0.1))),
        ("sensors.gyro_noise", lambda: Sensors(gyro_noise=-1.0)),
        ("sensors.seed", lambda: Sensors(seed=1.5)),
        ("desaturation.torque_limit", lambda: Desaturation(0.0)),
        ("disturbance.frequency", lambda: Disturbance(frequency=-1.0)),
        ("controller", lambda: slew(controller=None)),
        ("target", lambda: slew(target=None)),
        ("array", lambda: slew(array=nm.layouts.planar(n=4), hdot=np.zeros(2))),
        ("a metric that needs no spacecraft", lambda: slew(spacecraft=None, metrics=METRICS)),
    ],
)
def test_what_is_refused(key: str, make: Any) -> None:
    with pytest.raises(InputError, match=key):
        make()
