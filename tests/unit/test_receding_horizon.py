"""The law `receding-horizon`: through singularities, on any array, and what it says of trouble."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import nullmotion as nm
from nullmotion.errors import InputError
from nullmotion.lookahead import path
from nullmotion.scenario import build
from nullmotion.sim import Setup, run, workers

PERIOD = 0.01
ROOT = Path(__file__).parents[2]


def pyramid(**changes):
    return nm.layouts.pyramid(**{"skew": np.radians(54.73), "rate_limit": 1.5, **changes})


def flown(array, start, hdot, until, law="receding-horizon", period=PERIOD, **parameters):
    """Return the trajectory under a constant torque until so much momentum has been asked."""
    hdot = np.asarray(hdot, float)
    steps = round(until / np.linalg.norm(hdot) / period)
    steering = nm.laws.create(law, **parameters)
    return run(Setup(array, steering, np.asarray(start, float), hdot, dt=period, steps=steps))


def errors(found):
    """Return the error of the torque over each sample as a fraction of the command."""
    given = np.diff(found.impulse, axis=0) / found.setup.dt
    return np.linalg.norm(given - found.setup.hdot, axis=1) / np.linalg.norm(found.setup.hdot)


def test_through_the_elliptic_singularity():
    found = flown(pyramid(), np.zeros(4), [-0.75, 0.0, 0.0], 2.5)
    assert errors(found).max() < 1e-5
    assert found.measures["sigma_min"][1:].min() > 0.38
    assert found.status == [] and found.law_counts["fall-back"] == 0
    stuck = flown(pyramid(), np.zeros(4), [-0.75, 0.0, 0.0], 2.5, law="pseudo-inverse")
    assert np.linalg.norm(stuck.momentum[-1]) == pytest.approx(1.155, abs=0.01)


ARRAYS = {
    "box90": (nm.layouts.box90(rate_limit=1.5), np.radians([60, -60, 120, -120])),
    "roof": (nm.layouts.roof(rate_limit=1.5), np.radians([60, -60, 120, -120])),
    "five": (nm.layouts.pyramid(n=5, rate_limit=1.5), np.zeros(5)),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", ARRAYS)
@pytest.mark.parametrize("direction", [(-1, 0, 0), (0.6, -0.64, 0.48)])
def test_other_arrays_go_the_same_way(name, direction):
    array, start = ARRAYS[name]
    found = flown(array, start, 0.5 * np.array(direction), 1.5, period=0.02)
    assert errors(found).max() < 0.02 and found.measures["sigma_min"][1:].min() > 0.25


def test_beyond_rate_authority_the_direction_is_kept_and_it_is_said():
    found = flown(pyramid(), np.zeros(4), [-1.5, 0.0, 0.0], 1.5)
    given = np.diff(found.impulse, axis=0) / PERIOD
    assert (np.linalg.norm(given[:, 1:], axis=1) < 1e-6 * -given[:, 0]).all()
    assert "beyond-rate-authority" in found.status
    assert found.law_counts["beyond-rate-authority"] > 50
    assert found.summary()["law_counts"]["fall-back"] == 0
    assert (np.abs(found.rates[:-1]) <= 1.5 * (1 + 1e-12)).all()


def test_a_late_solver_is_counted_and_the_run_goes_on():
    """One iteration is not enough for any plan: what is left is the pseudo-inverse."""
    hdot = [-0.5, 0.2, 0.1]
    late = flown(pyramid(), [0.3, 0.1, -0.2, 0.4], hdot, 0.2, iteration_limit=1)
    plain = flown(pyramid(), [0.3, 0.1, -0.2, 0.4], hdot, 0.2, law="pseudo-inverse")
    assert late.law_counts["fall-back"] > 30 and "fall-back" in late.status
    assert errors(late).max() < 1e-6
    np.testing.assert_allclose(late.delta[-1], plain.delta[-1], atol=5e-3)


def test_a_fall_back_keeps_the_plan_it_has():
    law, array = nm.laws.create("receding-horizon"), pyramid()
    hopeless = replace(law, iteration_limit=1)
    delta, hdot, state = np.zeros(4), np.array([-0.75, 0.0, 0.0]), law.init(array, np.zeros(4))
    for k in range(30):
        rates, state = law.step(array, nm.Observation(delta, hdot, k * PERIOD, PERIOD), state)
        delta = delta + PERIOD * rates
    seen = nm.Observation(delta, hdot, 30 * PERIOD, PERIOD)
    wanted, _ = law.step(array, seen, state)
    kept, after = hopeless.step(array, seen, state)
    np.testing.assert_allclose(kept, wanted, atol=0.05)
    assert law.counts(after)["fall-back"] == 1 and after.plan is state.plan


def test_a_known_delay_is_allowed_for():
    start, hdot = np.radians([10, 20, -30, 5]), np.array([0.3, 0.4, 0.1])

    def worst(lead_s):
        law = nm.laws.create("receding-horizon", lead_s=lead_s)
        setup = Setup(pyramid(), law, start, hdot, dt=PERIOD, steps=60, delay_steps=2)
        given = np.diff(run(setup).impulse, axis=0)[2:] / PERIOD
        return np.linalg.norm(given - hdot, axis=1).max() / np.linalg.norm(hdot)

    assert worst(0.02) < 1e-6 < 1e-3 < worst(0.0)


@pytest.mark.slow
def test_a_preview_is_used_before_the_torque_comes():
    """Nothing for a second, then 1.5 times rate authority: what is known can be prepared for."""
    hdot = np.zeros((300, 3))
    hdot[100:] = [-1.0, 0.0, 0.0]

    def error(samples):
        law = nm.laws.create("receding-horizon", samples=samples)
        found = run(Setup(pyramid(), law, np.zeros(4), hdot, dt=PERIOD, steps=300))
        given = np.diff(found.impulse, axis=0) / PERIOD
        assert np.abs(given[:100]).max() < 1e-6
        assert (found.rates[:100].any()) == bool(samples)
        return np.linalg.norm(given - hdot, axis=1).mean()

    assert 4.0 * error(300) < error(0)
    law = nm.laws.create("receding-horizon")
    assert law.information_used == () and replace(law, samples=9).information_used == ("preview",)


def test_no_torque_no_motion():
    law, array = nm.laws.create("receding-horizon"), pyramid()
    seen = nm.Observation(np.zeros(4), np.zeros(3), 0.0, PERIOD)
    assert not law.step(array, seen, law.init(array, np.zeros(4)))[0].any()


def test_parameters_are_checked():
    for key, value in (("steps", 2), ("iterations", 1.5), ("rho", -1.0), ("horizon", np.inf)):
        with pytest.raises(InputError, match=f"law.{key}"):
            nm.laws.create("receding-horizon", **{key: value})
    assert "no null motion" in nm.laws.create("receding-horizon").supports(pyramid(n=3))


@pytest.mark.parametrize("first", [1e-8, 0.0075, 0.1, 0.5, 3.0])
def test_knots_start_with_the_sample_and_end_at_the_horizon(first):
    place = path.spaced(first, 1.8, 15)
    steps = np.diff(place, prepend=0.0)
    assert place[0] == first and (steps > 0).all()
    assert place[-1] == pytest.approx(max(1.8, first + 14e-3), rel=1e-6)
    assert (np.diff(steps[1:]) > -1e-9).all()


def test_a_path_ends_at_the_envelope(rng):
    array = pyramid()
    envelope = path.Envelope(array)
    ahead = path.held(np.array([-0.75, 0.0, 0.0]), PERIOD, 5.0, 15)
    target = envelope.held(np.zeros(3), ahead.target)
    assert -3.15 < target[-1][0] < -2.9 and (target[-1] == target[-2]).all()
    inside = np.abs(array.momentum(rng.uniform(-np.pi, np.pi, (500, 4))) @ envelope.directions.T)
    assert (inside <= envelope.reach / 0.97 + 1e-12).all()


@pytest.mark.slow
def test_slew_with_unknown_torque_beats_sr_tenfold():
    base = build.setup(nm.load_scenario("elliptic-slew"))

    def worst(name):
        found = run(replace(base, law=nm.laws.create(name), steps=500))
        return found.metrics["max_pointing_error_deg"]

    assert 10.0 * worst("receding-horizon") < worst("sr")


SMALL = """
[array]
layout = "pyramid"
h0_Nms = 1.0
rate_limit_deg_s = 90.0
[law]
name = "receding-horizon"
[mission]
kind = "momentum-rate"
hdot_Nm = [0.5, 0.0, 0.0]
[simulation]
dt_s = 0.05
duration_s = 0.3
"""


@pytest.mark.slow
def test_worker_processes_change_no_bit(monkeypatch, tmp_path, rng):
    (tmp_path / "s.toml").write_text(SMALL)
    starts, seen = rng.uniform(-90, 90, (5, 4)), []
    serial = nm.simulate_batch(tmp_path / "s.toml", gimbal_deg=starts, threads=1)
    monkeypatch.setattr(workers, "_WORTH", 0.0)
    spread = nm.simulate_batch(
        tmp_path / "s.toml", gimbal_deg=starts, threads=2, progress=seen.append
    )
    assert seen == sorted(seen) and seen[-1] == 1.0 and len(seen) >= 3
    np.testing.assert_array_equal(spread.final_gimbal_rad, serial.final_gimbal_rad)
    for name, values in serial.metrics.items():
        np.testing.assert_array_equal(spread[name], values)


@pytest.mark.slow
def test_success_rates():
    """A part of `design/lookahead_success.py`, which has the numbers of all 200 and all laws."""
    found = subprocess.run(
        [sys.executable, ROOT / "design" / "lookahead_success.py", "--runs", "12",
         "--period", "0.02", "--laws", "receding-horizon"],
        capture_output=True, text=True, check=True,
    ).stdout  # fmt: skip
    nominal, disturbed = [line for line in found.splitlines() if "receding-horizon" in line]
    assert "12 of 12" in nominal
    assert int(disturbed.split("|")[3].split()[0]) >= 10
