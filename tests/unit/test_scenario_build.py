"""Scenarios become setups: units, plants, profiles, failures, batches."""

from __future__ import annotations

import numpy as np
import pytest

import nullmotion as nm
from nullmotion.errors import InputError, UnsupportedArrayError
from nullmotion.scenario import load_scenario
from nullmotion.scenario.build import setup

BASE = "elliptic-singularity"


def test_units_become_si():
    made = setup(
        load_scenario(BASE, {"array.rate_limit_deg_s": 90.0, "initial.gimbal_deg": [90, 0, 0, 0]})
    )
    assert np.allclose(made.array.rate_limit, np.pi / 2)
    assert np.allclose(made.delta, [np.pi / 2, 0, 0, 0])
    assert made.steps == 1000
    assert made.stop[0].below
    assert made.stop[0].metric.name == "momentum_state"


def test_wheel_momentum_is_inertia_times_speed():
    text = (
        '[array]\nlayout="pyramid"\nwheel_inertia_kg_m2=[0.1,0.1,0.1,0.2]\nwheel_speed_rpm=6000\n'
    )
    text += '[law]\nname="pi"\n[mission]\nhdot_Nm=[1,0,0]\n[simulation]\nduration_s=1\n'
    assert np.allclose(
        setup(load_scenario(text)).array.h0, np.array([0.1, 0.1, 0.1, 0.2]) * 200 * np.pi
    )


def test_the_plant_is_off_by_exactly_what_was_asked():
    values = {
        "plant.gimbal_axis_error_deg": 2.0,
        "plant.h0_error": 0.1,
        "plant.encoder_bias_deg": 1.0,
    }
    made = setup(load_scenario(BASE, values))
    turned = np.degrees(np.arccos(np.sum(made.array.gimbal_axes * made.plant.gimbal_axes, axis=1)))
    assert np.allclose(turned, 2.0)
    assert np.all(np.abs(made.plant.h0 - 1) <= 0.1)
    assert np.ptp(made.plant.h0) > 0
    assert np.all(np.abs(made.encoder_bias) <= np.radians(1.0))
    axes = np.stack([made.plant.gimbal_axes, made.plant.spin_axes], axis=1)
    assert np.allclose(axes @ axes.transpose(0, 2, 1), np.eye(2))


def test_the_seed_decides_the_plant():
    def axes(seed):
        return setup(load_scenario("plant-errors", {"plant.seed": seed})).plant.gimbal_axes

    assert np.array_equal(axes(3), axes(3))
    assert not np.array_equal(axes(3), axes(4))


def test_a_planar_array_with_errors_keeps_two_torque_dimensions():
    made = setup(load_scenario("planar5", {"plant.gimbal_axis_error_deg": 1.0}))
    assert made.plant.m == made.array.m == 2


def test_failed_cmgs_leave_and_frozen_ones_bias():
    made = setup(load_scenario("failed-cmg"))
    assert made.array.n == len(made.delta) == 3
    assert np.allclose(made.array.momentum_bias, [0, -1, 0])
    given = setup(load_scenario("failed-cmg", {"initial.gimbal_deg": [1, 2, 3, 4]}))
    assert np.allclose(np.degrees(given.delta), [1, 2, 4])


def test_a_profile_is_linear_between_rows_and_held_beyond(tmp_path):
    (tmp_path / "p.csv").write_text("t_s,x,y,z\n0.1,1,0,0\n0.3,2,0,-4\n")
    (tmp_path / "s.toml").write_text(
        '[array]\nlayout="pyramid"\n[law]\nname="pi"\nperiod_s=0.1\n[mission]\nprofile="p.csv"\n'
        "[simulation]\nduration_s=0.5\n"
    )
    made = setup(load_scenario(tmp_path / "s.toml"))
    assert np.allclose(made.hdot, [[1, 0, 0], [1, 0, 0], [1.5, 0, -2], [2, 0, -4], [2, 0, -4]])
    assert made.period_steps == 10
    run = nm.simulate(tmp_path / "s.toml")
    assert np.allclose(run.hdot[25], [1.5, 0, -2])


def test_a_duration_that_is_no_multiple_is_reached():
    assert setup(load_scenario(BASE, {"simulation.duration_s": 0.295})).steps == 30
    assert setup(load_scenario(BASE, {"simulation.duration_s": 0.3})).steps == 30


def test_a_law_that_cannot_steer_the_array_is_refused():
    with pytest.raises(UnsupportedArrayError, match="null motion"):
        nm.simulate(load_scenario("failed-cmg", {"law.name": "nd"}))


def test_a_batch_equals_its_runs(rng):
    starts = rng.uniform(-180, 180, (9, 4))
    commands = rng.normal(size=(9, 3))
    base = load_scenario(BASE, {"law.name": "gsr"})
    batch = nm.simulate_batch(base, gimbal_deg=starts, hdot_Nm=commands, metrics=["sigma_min"])
    for i in (0, 8):
        one = nm.simulate(
            base.with_values(
                {"initial.gimbal_deg": starts[i].tolist(), "mission.hdot_Nm": commands[i].tolist()}
            )
        )
        assert np.allclose(batch.final_gimbal_rad[i], one.delta[-1], atol=1e-9)
        assert np.isclose(batch["min_sigma_min"][i], one.metrics["min_sigma_min"])


def test_any_value_varies_by_key():
    base = load_scenario(BASE, {"law.name": "gsr"})
    batch = nm.simulate_batch(base, skew_deg=[45.0, 54.73], **{"law.mu0": [0.01, 0.05]})
    one = nm.simulate(base.with_values({"array.skew_deg": 45.0, "law.mu0": 0.01}))
    assert np.isclose(batch.stopped_at_s[0], one.stopped_at_s)
    assert np.allclose(batch.final_gimbal_rad[0], one.delta[-1], atol=1e-9)


def test_runs_of_different_structure_come_back_in_order():
    base = load_scenario(BASE, {"simulation.duration_s": 0.2})
    batch = nm.simulate_batch(base, **{"law.name": ["sr", "gsr", "sr"]}, hdot_Nm=np.eye(3))
    for i, law in enumerate(["sr", "gsr", "sr"]):
        one = nm.simulate(
            base.with_values({"law.name": law, "mission.hdot_Nm": np.eye(3)[i].tolist()})
        )
        assert np.allclose(batch.final_gimbal_rad[i], one.delta[-1], atol=1e-12)


@pytest.mark.parametrize(
    ("values", "says"),
    [
        ({"gimbal_dg": [[0.0] * 4]}, "gimbal_deg"),
        ({"gimbal_deg": [[0.0] * 3]}, "shape"),
        ({"gimbal_deg": [[0.0] * 4], "hdot_Nm": np.eye(3)}, "same number of runs"),
        ({"hdot_Nm": [[np.nan, 0, 0]]}, "finite"),
        ({"skew_deg": [50.0, 200.0]}, "run 1"),
        ({"skew_deg": 50.0}, "one value for each run"),
        ({}, "at least one"),
    ],
)  # fmt: skip
def test_bad_batches_are_told(values, says):
    with pytest.raises(InputError, match=says):
        nm.simulate_batch(load_scenario(BASE), **values)
