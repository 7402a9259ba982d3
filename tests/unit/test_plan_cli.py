"""The command ``nullmotion plan``: what it writes, what it refuses, how it ends."""

from __future__ import annotations

import json

import pytest

from nullmotion.cli import app, guard
from nullmotion.plan import exact
from nullmotion.scenario import load_scenario
from nullmotion.scenario.simulate import simulate

ROLL = "papakonstantinou-roll"


@pytest.fixture
def cli(capsys, tmp_path, monkeypatch):
    """Call the command in an empty folder; return status, output and errors."""
    monkeypatch.chdir(tmp_path)

    def call(*arguments):
        status = guard.call(app, arguments)
        said = capsys.readouterr()
        return status, said.out, said.err

    return call


def written(folder):
    return json.loads((folder / "plan.json").read_text())


def test_a_plan_is_written_and_flown(cli, tmp_path):
    status, out, err = cli("plan", ROLL, "--lag", "--out", "p")
    assert (status, err) == (0, "")
    assert "+103.01" in out and "yes, of 59,049 courses" in out
    assert {p.name for p in (tmp_path / "p").iterdir()} == {"plan.json", "plan.toml"}
    found = written(tmp_path / "p")
    assert found["knots"] == [1, 0, -1, -1, 0, 0, 0, 0, 0, 0]
    assert found["proven"] is True and found["ties"] == []
    assert found["gain"] == pytest.approx(1.0301, abs=1e-4)
    keys = {"value", "baseline_value", "rollouts", "seconds", "method", "depth", "levels", "k_max"}
    assert keys | {"cost", "certificate"} <= set(found)
    flown = load_scenario(str(tmp_path / "p" / "plan.toml"))
    assert flown.law.name == "follow-plan"
    assert flown.law.base_parameters == {"schedule": "exponential", "lambda0": 1.0, "mu": 0.2}
    before, after = simulate(ROLL).metrics, simulate(flown).metrics
    assert after["min_sigma_min"] > 2 * before["min_sigma_min"]
    status, _, err = cli("run", "p/plan.toml", "--out", "r")
    assert (status, err) == (0, "")
    status, _, err = cli("plan", "p/plan.toml", "--out", "again")  # its base law, not the plan
    assert (status, err) == (0, "")
    assert written(tmp_path / "again")["value"] == found["value"]
    assert (tmp_path / "again" / "plan.toml").read_text() == (
        tmp_path / "p" / "plan.toml"
    ).read_text()


def test_preferred_angles_become_the_start(cli, tmp_path):
    status, out, err = cli(
        "plan", ROLL, "--method", "preferred", "--set", "plan.cost=energy", "--out", "p"
    )
    assert (status, err) == (0, "")
    assert "Start angles" in out
    flown = load_scenario(str(tmp_path / "p" / "plan.toml"))
    assert flown.law.name == "sr"
    assert list(flown.initial.gimbal_deg) == written(tmp_path / "p")["gimbal_deg"]


@pytest.mark.parametrize("method", ["skip", "enumerate"])
def test_other_methods(cli, tmp_path, method):
    status, _, err = cli("plan", ROLL, "--method", method, "--depth", "5", "--out", "p")
    assert (status, err) == (0, "")
    found = written(tmp_path / "p")
    assert found["proven"] is (method == "enumerate")
    assert found["value"] >= found["baseline_value"]


def test_a_momentum_rate_schedule_brings_its_file(cli, tmp_path):
    status, _, err = cli("plan", "profile", "--depth", "3", "--out", "p")
    assert (status, err) == (0, "")
    assert (tmp_path / "p" / "profile.csv").is_file()
    status, _, err = cli("run", "p/plan.toml", "--out", "r")
    assert (status, err) == (0, "")


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("--depth", "0"), "depth = 0"),
        (("--depth", "99"), "depth = 99"),
        (("--levels", "4"), "levels = 4"),
        (("--method", "exct"), "did you mean exact"),
        (("--set", "plan.cost=energ"), "energy"),
        (("--set", "plan.levels=2"), "plan.levels"),
        (("--set", "array.failed_cmgs=[0]"), "null motion"),
        (("--out", "/proc/nowhere"), "--out"),
    ],
)
def test_what_cannot_be_is_refused_in_one_message(cli, tmp_path, arguments, said):
    status, out, err = cli("plan", ROLL, *arguments)
    assert status == 2 and out == ""
    assert said in err and "Traceback" not in err and err.count("\n") == 1
    assert not (tmp_path / "out").exists()


def test_ctrl_c_writes_the_best_so_far(cli, tmp_path, monkeypatch):
    def stop(work, *_):
        for _ in range(12):
            work.step()
        raise KeyboardInterrupt

    monkeypatch.setattr(exact, "_run", stop)
    status, out, err = cli("plan", ROLL, "--depth", "20", "--out", "p")
    assert (status, err) == (0, "")
    assert "not proven" in out
    found = written(tmp_path / "p")
    assert found["proven"] is False and found["value"] >= found["baseline_value"]
    assert (tmp_path / "p" / "plan.toml").is_file()
