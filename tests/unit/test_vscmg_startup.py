"""Startups from rest: who converges, under limits, tumbles, torques and unknown inertias."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

import nullmotion as nm
from nullmotion.array.wheels import Wheels
from nullmotion.metrics import get
from nullmotion.scenario import build
from nullmotion.sim import Setup, run
from nullmotion.sim.batch import run_batch
from nullmotion.spacecraft import Disturbance, Event, Spacecraft
from nullmotion.vscmg import Units

SPEED, INERTIA = 200.0, 6.95e-4
WITHIN = 2.0 * np.arcsin(0.01)  # |e| < 0.01
METRICS = (
    get("settling_time_s")(tolerance=WITHIN),
    get("pointing_error_deg")(),
    get("wheel_settling_s")(),
)


def base(**changes: object) -> Setup:
    """Return the library's startup for 300 s, measured by what the issue asks."""
    setup = build.setup(nm.load_scenario("vscmg-startup", values={"simulation.duration_s": 300.0}))
    return dataclasses.replace(setup, metrics=METRICS, **changes)


def quaternions(rng: np.random.Generator, count: int) -> np.ndarray:
    q = rng.normal(size=(count, 4))
    return q / np.linalg.norm(q, axis=1, keepdims=True)


def fly(setups: list[Setup]):
    return run_batch(setups[0], setups=setups)


def assert_started(found, speed: float = SPEED) -> None:
    assert not found.status["non-finite"].any()
    assert np.abs(found.final_wheel_speed - speed).max() < 0.02 * speed
    assert np.isfinite(found["settling_time_s"]).all()
    assert found["final_pointing_error_deg"].max() < np.degrees(WITHIN)


def drawn_inertia(rng: np.random.Generator, spread: float) -> np.ndarray:
    """Return principal moments with each varied, among those that a body can have."""
    while True:
        moments = np.array([0.061, 0.061, 0.0764]) * rng.uniform(1 - spread, 1 + spread, 3)
        if 2 * moments.max() < moments.sum():
            return np.diag(moments)


@pytest.mark.parametrize("drive", ["rate", "torque"])
def test_startup_within_the_limits(drive):
    found = run(base(units=dataclasses.replace(base().units, drive=drive)))
    limits = found.setup.array
    assert limits.flywheels.torque_limit[0] == 5e-3 and limits.rate_limit[0] == pytest.approx(5.0)
    assert np.abs(found.wheel_speed[-1] - SPEED).max() < 0.02 * SPEED
    assert np.degrees(found.pointing_error[-1]) < np.degrees(WITHIN)
    assert np.nanmax(np.abs(found.rates_asked)) <= 5.0 * (1 + 1e-9)
    if drive == "torque":
        assert np.nanmax(np.abs(found.wheel_motor_torque)) <= 5e-3 * (1 + 1e-12)
    else:
        spun_up = INERTIA * found.wheel_acceleration[:-1]
        assert np.abs(spun_up).max() <= 5e-3 * (1 + 1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("drive", ["rate", "torque"])
def test_a_hundred_unknown_inertias(drive):
    rng = np.random.default_rng(20)
    start = base(units=dataclasses.replace(base().units, drive=drive))
    setups = []
    for _ in range(100):
        own = [getattr(start.units, f"{key}_inertia") for key in ("spin", "transverse", "gimbal")]
        size = rng.uniform(0.5, 1.5, 4)
        spin, transverse, gimbal = (size * value for value in own)
        units = dataclasses.replace(
            start.units, spin_inertia=spin, transverse_inertia=transverse, gimbal_inertia=gimbal
        )
        body = Spacecraft(drawn_inertia(rng, 0.5), q_BN=start.spacecraft.q_BN)
        setups.append(dataclasses.replace(start, spacecraft=body, units=units))
    learned = nm.simulate("vscmg-startup", decimate=1000).estimates
    assert not learned[0, :-1].any() and learned[-1, :-1].any()
    assert_started(fly(setups))


@pytest.mark.slow
@pytest.mark.parametrize("drive", ["rate", "torque"])
def test_any_attitude_any_gimbal_angles_and_a_tumble(drive):
    rng = np.random.default_rng(21)
    start = base(units=dataclasses.replace(base().units, drive=drive))
    J, setups = start.spacecraft.inertia, []
    for q, rate in zip(quaternions(rng, 100), rng.uniform(0.0, 0.3, 100), strict=True):
        axis = rng.normal(size=3)
        body = Spacecraft(J, q_BN=q, omega_BN_B=rate * axis / np.linalg.norm(axis))
        delta = rng.uniform(-np.pi, np.pi, 4)
        setups.append(dataclasses.replace(start, spacecraft=body, delta=delta))
    assert_started(fly(setups))


@pytest.mark.slow
def test_a_constant_torque_is_carried():
    rng = np.random.default_rng(22)
    controller = dataclasses.replace(base().controller, Gamma3=0.003)
    setups = []
    for axis in rng.normal(size=(50, 3)):
        torque = 3e-4 * axis / np.linalg.norm(axis)
        setups.append(base(disturbance=Disturbance(torque), controller=controller))
    assert_started(fly(setups))


LAYOUTS = {
    "pyramid": nm.layouts.pyramid,
    "pyramid-5": lambda **own: nm.layouts.pyramid(n=5, **own),
    "pyramid-30": lambda **own: nm.layouts.pyramid(skew=np.radians(30.0), **own),
    "roof": nm.layouts.roof,
    "box90": nm.layouts.box90,
    "roof6": nm.layouts.roof6,
    "scissored-pairs": nm.layouts.scissored_pairs,
}


@pytest.mark.sampled(1)
@pytest.mark.parametrize("layout", LAYOUTS)
def test_any_array_from_home_and_with_all_rotors_aligned(layout):
    own = {"h0": INERTIA * SPEED, "rate_limit": 5.0}
    array = dataclasses.replace(
        LAYOUTS[layout](**own), wheels=Wheels(np.array(INERTIA), torque_limit=np.array(5e-3))
    )
    units = Units(3.1475e-3, 2.8e-3, 2.8e-3, drive="torque")
    zero = np.zeros(array.n)
    rng = np.random.default_rng(23)
    starts = [zero, np.full(array.n, np.pi / 2), *rng.uniform(-np.pi, np.pi, (6, array.n))]
    setups = [base(array=array, units=units, wheel_speed=zero, delta=delta) for delta in starts]
    assert_started(fly(setups))


def test_wheels_at_rest_and_aligned_give_finite_commands_and_a_status():
    array = dataclasses.replace(
        nm.layouts.box90(h0=INERTIA * SPEED, rate_limit=5.0), wheels=Wheels(np.array(INERTIA))
    )
    law = nm.laws.create("vscmg-weighted", nudge=0.0, k_gamma=0.0)
    found = run(base(array=array, law=law, delta=np.zeros(4), wheel_speed=np.zeros(4), steps=100))
    assert np.isfinite(found.rates_asked[:-1]).all() and np.isfinite(found.delta).all()
    assert np.isfinite(found.wheel_acceleration[:-1]).all()
    assert "torque-cut" in found.status


@pytest.mark.sampled(1)
@pytest.mark.parametrize("found_after", [0.0, 5.0, np.inf])
def test_a_dead_wheel_motor_leaves_a_settled_attitude(found_after):
    event = Event("wheel-dead", cmg=1, at=40.0, detected_after=found_after)
    found = run(base(events=(event,), steps=30_000))
    assert np.isfinite(found.delta).all() and np.isfinite(found.rates_asked[:-1]).all()
    late = found.t > 41.0
    assert not np.any(found.wheel_motor_torque[late][:-1, 1])
    if np.isfinite(found_after):
        others = np.delete(found.wheel_speed[-1], 1)
        assert np.degrees(found.pointing_error[-1]) < np.degrees(WITHIN)
        assert np.abs(others - SPEED).max() < 0.02 * SPEED
    assert np.isnan(found.metrics["wheel_settling_s"])
    assert abs(found.wheel_speed[-1, 1] - SPEED) > 0.02 * SPEED


@pytest.mark.slow
def test_a_stuck_gimbal_while_starting_up():
    event = Event("stuck", cmg=2, at=30.0, detected_after=1.0)
    units = dataclasses.replace(base().units, drive="rate")
    found = run(base(events=(event,), units=units))
    assert np.isfinite(found.delta).all()
    assert not np.any(found.rates[found.t > 30.0][:-1, 2])


def test_more_than_the_wheels_can_ever_hold_is_limited_not_lost():
    body = Spacecraft(base().spacecraft.inertia, omega_BN_B=np.array([0.0, 0.0, 20.0]))
    found = run(base(spacecraft=body, steps=5000))
    assert np.isfinite(found.delta).all() and "torque-cut" in found.status
    h = found.inertial_momentum
    assert np.abs(h - h[0]).max() < 1e-8 * np.linalg.norm(h[0])
