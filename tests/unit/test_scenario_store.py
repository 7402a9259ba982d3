"""Results on disk: complete, readable, all or nothing."""

from __future__ import annotations

import json
import os

import netCDF4
import numpy as np
import pytest

import nullmotion as nm
from nullmotion import rotation
from nullmotion.errors import InputError
from nullmotion.scenario import files, load_scenario, rerun, store, variables

KEYS = {
    "stopped_at_s", "stop_reason", "final_momentum", "min_sigma_min",
    "max_off_axis_torque_fraction", "max_rate_step_rad_s", "status",
}  # fmt: skip


@pytest.fixture(scope="module")
def flown():
    """A scenario with a profile, and its run."""
    scenario = load_scenario("profile", {"simulation.duration_s": 2.0})
    return scenario, nm.simulate(scenario)


def test_a_trajectory_file_tells_it_all(flown, tmp_path):
    scenario, run = flown
    store.write(run, scenario, tmp_path / "r", csv=True)
    with netCDF4.Dataset(tmp_path / "r" / "trajectory.nc") as file:
        assert set(file.dimensions) >= {"time", "cmg", "torque_axis"}
        assert all(v.units and v.long_name for v in file.variables.values())
        assert np.array_equal(file["delta"][:], run.delta)
        assert file["rates"].units == "rad s-1"
        assert "profile" in file.scenario
        assert json.loads(file.parameters)["law"]["period_s"] == pytest.approx(0.1)
        assert json.loads(file.parameters)["array"]["skew_deg"] == pytest.approx(54.73)
        for key in (
            "nullmotion_version",
            "numpy_version",
            "llvmlite_version",
            "python_version",
            "backend",
            "seed",
        ):
            assert file.getncattr(key)
    table = np.genfromtxt(tmp_path / "r" / "trajectory.csv", delimiter=",", names=True)
    assert np.array_equal(table["t_s"], run.t)
    assert np.array_equal(table["delta_3_rad"], run.delta[:, 3])
    assert np.array_equal(table["momentum_y_Nms"], run.momentum[:, 1])


def test_a_summary_has_its_keys_and_no_nan(flown, tmp_path):
    scenario, run = flown
    store.write(run, scenario, tmp_path)
    text = (tmp_path / "summary.json").read_text()
    assert json.loads(text).keys() >= KEYS
    assert "NaN" not in text
    assert "Infinity" not in text
    assert json.loads(text)["stopped_at_s"] is None


def test_a_stored_run_repeats_bit_for_bit(flown, tmp_path):
    scenario, run = flown
    store.write(run, scenario, tmp_path)
    stored = rerun.read(tmp_path)
    again = nm.simulate(stored.scenario())
    assert rerun.verdict(stored, again) == "identical, bit for bit"
    other = nm.simulate(stored.scenario().with_values({"law.schedule": "constant"}))
    assert rerun.verdict(stored, other).startswith("differs by up to")


def test_xarray_has_units(flown):
    dataset = flown[1].to_xarray()
    assert dataset["momentum"].attrs["units"] == "N m s"
    assert dataset.sizes["cmg"] == 4
    assert "delta_dot" in dataset.attrs["conventions"]


@pytest.fixture(scope="module")
def turned():
    """A slew, and its run."""
    scenario = load_scenario("attitude-slew", {"simulation.duration_s": 1.0})
    return scenario, nm.simulate(scenario)


def test_an_attitude_file_tells_what_the_body_did(turned, tmp_path):
    scenario, run = turned
    store.write(run, scenario, tmp_path / "r", csv=True)
    with netCDF4.Dataset(tmp_path / "r" / "trajectory.nc") as file:
        assert all(v.units and v.long_name for v in file.variables.values())
        assert file["q_BN"].dimensions == ("time", "quaternion")
        assert file["omega_BN_B"].units == "rad s-1"
        assert file["motor_torque"].units == "N m"
        assert np.array_equal(file["q_BN"][:], run.q_BN)
        assert np.array_equal(file["inertial_momentum"][:], run.inertial_momentum)
        assert "reference^-1 * q_BN" in file.conventions
        for angle, row in zip(file["euler_321"][:].data, run.q_BN, strict=True):
            again = rotation.from_euler_321(angle)
            assert np.abs(np.abs(again @ row) - 1.0) < 1e-14
    table = np.genfromtxt(tmp_path / "r" / "trajectory.csv", delimiter=",", names=True)
    assert np.array_equal(table["q_BN_2"], run.q_BN[:, 2])
    assert np.array_equal(table["omega_BN_B_z_rad_s"], run.omega_BN_B[:, 2])
    assert np.array_equal(table["motor_torque_3_Nm"], run.motor_torque[:, 3], equal_nan=True)
    assert np.array_equal(table["pointing_error_rad"], run.pointing_error)
    assert {"euler_321_yaw_rad", "inertial_momentum_x_Nms", "speed_0_rad_s"} <= {*table.dtype.names}


def test_an_attitude_repeats_bit_for_bit(turned, tmp_path):
    scenario, run = turned
    store.write(run, scenario, tmp_path)
    stored = rerun.read(tmp_path)
    assert rerun.verdict(stored, nm.simulate(stored.scenario())) == "identical, bit for bit"


def test_what_only_a_spacecraft_has_is_left_out_without_one(flown):
    names = {variable.name for variable in variables.variables(flown[1])}
    assert not {"q_BN", "omega_BN_B", "reference", "euler_321", "motor_torque", "speed"} & names


def test_what_is_no_stored_run_is_refused(tmp_path):
    with pytest.raises(InputError, match="trajectory.nc"):
        rerun.read(tmp_path)
    (tmp_path / "trajectory.nc").write_text("no")
    with pytest.raises(InputError, match="NetCDF"):
        rerun.read(tmp_path)


def put(folder, **texts):
    """Write files through `replacing`."""
    with files.replacing(folder, ("a", "b")) as new:
        for name, text in texts.items():
            (new / name).write_text(text)


def listing(folder):
    return {p.name: p.read_text() for p in folder.iterdir()}


def test_files_are_replaced_and_others_left_alone(tmp_path):
    (tmp_path / "mine").write_text("mine")
    put(tmp_path, a="1", b="1")
    put(tmp_path, a="2")
    assert listing(tmp_path) == {"mine": "mine", "a": "2"}


def test_an_interruption_while_writing_leaves_the_old_result(tmp_path):
    put(tmp_path, a="1", b="1")

    def write():
        with files.replacing(tmp_path, ("a", "b")) as new:
            (new / "a").write_text("half")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        write()
    assert listing(tmp_path) == {"a": "1", "b": "1"}


@pytest.mark.parametrize("after", [0, 1, 2])
def test_an_interruption_while_replacing_leaves_the_old_result(after, tmp_path, monkeypatch):
    put(tmp_path, a="1", b="1")
    calls, real = [], os.replace

    def interrupted(*names):
        calls.append(names)
        if len(calls) == after + 1:
            raise KeyboardInterrupt
        real(*names)

    monkeypatch.setattr(os, "replace", interrupted)
    with pytest.raises(KeyboardInterrupt):
        put(tmp_path, a="2", b="2", c="2")
    assert listing(tmp_path) == {"a": "1", "b": "1"}


def test_a_new_folder_goes_away_when_interrupted(tmp_path):
    with pytest.raises(KeyboardInterrupt), files.replacing(tmp_path / "new"):
        raise KeyboardInterrupt
    assert not (tmp_path / "new").exists()


def test_a_folder_that_cannot_be_made_is_refused(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="folder"):
        put(tmp_path / "file" / "x", a="1")
