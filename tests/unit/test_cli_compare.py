"""``compare`` and ``demo``."""

from __future__ import annotations

import json

import pytest

from nullmotion.campaign import compare
from nullmotion.campaign.vary import parse
from nullmotion.cli import app, guard
from nullmotion.errors import InputError
from nullmotion.scenario import load_scenario


@pytest.fixture
def cli(capsys, tmp_path, monkeypatch):
    """Call the command in an empty folder; return status, output and errors."""
    monkeypatch.chdir(tmp_path)

    def call(*arguments):
        status = guard.call(app, arguments)
        said = capsys.readouterr()
        return status, said.out, said.err

    return call


def short(name, **values):
    return load_scenario(name, {"simulation.duration_s": 0.3, **values})


@pytest.mark.slow
def test_cases_say_what_they_run_on():
    comparison = compare(short("elliptic-singularity"))
    kinds = {case.label: case.parameters_kind for case in comparison.cases}
    assert kinds["pseudo-inverse"] == "defaults"
    assert kinds["VCBSAE, published"] == "published"
    assert kinds["ODSR2, published"] == "published, given"
    assert comparison.cases[0].law == "pseudo-inverse"
    given = compare(short("elliptic-singularity", **{"law.sigma_floor": 0.01}), ["sr"])
    assert [case.parameters_kind for case in given.cases] == ["given", "defaults"]


def test_a_law_that_cannot_steer_the_array_is_a_row():
    comparison = compare(short("failed-cmg"), ["nd", "sr"])
    refused = comparison.cases[1]
    assert refused.trajectory is None
    assert "null motion" in refused.reason
    assert json.loads(comparison.to_json())["cases"][1]["ran"] is False


@pytest.mark.slow
def test_varied_cases_equal_their_single_runs():
    comparison = compare(short("elliptic-singularity"), ["gsr"], parse("array.skew_deg=40:60:10"))
    assert comparison.values == (40.0, 50.0, 60.0)
    for case in comparison.cases:
        one = compare(short("elliptic-singularity", **{"array.skew_deg": case.value}), ["gsr"])
        single = next(c for c in one.cases if c.label == case.label)
        assert case.metrics["min_sigma_min"] == pytest.approx(
            single.metrics["min_sigma_min"], rel=1e-9
        )
        assert case.summary["final_momentum"] == pytest.approx(
            single.summary["final_momentum"], abs=1e-9
        )


SLEW = {"simulation.duration_s": 0.4, "simulation.dt_s": 0.02}


@pytest.mark.slow
def test_attitudes_are_compared_by_what_a_slew_is_judged_by(cli, tmp_path):
    settings = [part for key, value in SLEW.items() for part in ("--set", f"{key}={value}")]
    status, out, err = cli("compare", "attitude-slew", *settings, "--laws", "gsr", "--out", "c")
    assert (status, err) == (0, "")
    words = " ".join(out.split())
    for title in ("Settling", "pointing", "motor", "saturated", "sigma_min", "travel", "Required"):
        assert title in words
    assert "Off-axis" not in words
    assert words.count("not settled") == 2
    found = json.loads((tmp_path / "c" / "compare.json").read_text())
    assert found["cases"][0]["settling_time_s"] is None
    judged = found["cases"][0]["requirements"]
    assert {*judged[0]} == {"name", "limit", "value", "margin", "passed"}
    kept = sum(one["passed"] for one in judged)
    assert f"{kept}/{len(judged)}" in words


@pytest.mark.slow
def test_varied_attitudes_are_tables_of_their_own_metrics(cli):
    settings = [part for key, value in SLEW.items() for part in ("--set", f"{key}={value}")]
    vary = "spacecraft.inertia_kg_m2=[10, 12, 8],[11, 12, 8]"
    status, out, err = cli("compare", "attitude-slew", *settings, "--laws", "sr", "--vary", vary)
    assert (status, err) == (0, "")
    words = " ".join(out.split())
    assert "settling time [s]" in words and "final pointing error [deg]" in words


@pytest.mark.slow
def test_varied_attitudes_equal_their_single_runs():
    comparison = compare(short("attitude-slew"), ["sr"], parse("array.skew_deg=50:60:10"))
    for case in comparison.cases:
        one = compare(short("attitude-slew", **{"array.skew_deg": case.value}), ["sr"])
        single = next(c for c in one.cases if c.label == case.label)
        for key in ("final_pointing_error_deg", "max_motor_torque_Nm"):
            assert case.metrics[key] == pytest.approx(single.metrics[key], rel=1e-9)
        assert case.summary["final_q_BN"] == pytest.approx(single.summary["final_q_BN"], abs=1e-12)
        assert case.trajectory.q_BN == pytest.approx(single.trajectory.q_BN, abs=1e-12)
        judged = [[one["passed"] for one in c.summary["requirements"]] for c in (case, single)]
        assert judged[0] == judged[1] and len(judged[0]) == 3


def test_run_shows_what_a_slew_is_judged_by(cli):
    settings = [part for key, value in SLEW.items() for part in ("--set", f"{key}={value}")]
    status, out, err = cli("run", "attitude-slew", *settings)
    assert (status, err) == (0, "")
    for words in ("Settling time", "not settled", "Peak motor torque", "passed, failed: "):
        assert words in out


def test_vary_reads_ranges_and_lists():
    assert parse("a.b=40:60:1").values == tuple(range(40, 61))
    assert parse("a.b=1:0:-0.25").values == (1, 0.75, 0.5, 0.25, 0)
    assert parse("a.b=0:0.3:0.1").values == (0, 0.1, 0.2, 0.3)
    assert parse("law.name=sr,gsr").values == ("sr", "gsr")
    assert parse("law.w=[1, 2],[3, 4]").values == ([1, 2], [3, 4])
    for bad in ("a", "a=1", "a.b=", "a.b=1:2:0", "a.b=2:1:1", "a.b=1:x:1", "a.b=1,,2"):
        with pytest.raises(InputError):
            parse(bad)


@pytest.mark.slow
def test_compare_writes_its_files(cli, tmp_path):
    setting = ["--set", "simulation.duration_s=0.3"]
    status, out, err = cli(
        "compare", "planar5", *setting, "--laws", "sr", "--vary", "array.n=5,6", "--out", "c"
    )
    assert (status, err) == (0, "")
    assert {p.name for p in (tmp_path / "c").iterdir()} == {
        "compare.json",
        "compare.png",
        "report.html",
    }
    found = json.loads((tmp_path / "c" / "compare.json").read_text())
    assert found["varied"] == "array.n"
    assert [case["value"] for case in found["cases"]] == [5, 5, 6, 6]
    assert "array.n" in out


def test_a_law_file_is_compared_beside_the_rest(cli, tmp_path):
    (tmp_path / "half.py").write_text(
        "from dataclasses import dataclass\nfrom typing import ClassVar\nimport nullmotion as nm\n"
        "@dataclass(frozen=True)\nclass Half(nm.Law):\n    name: ClassVar[str] = 'half-for-test'\n"
        "    def step(self, array, obs, state):\n"
        "        return 0.5 * array.unit_jacobian(obs.delta).T @ obs.hdot, state\n"
    )
    setting = ["--set", "simulation.duration_s=0.3"]
    try:
        status, out, _ = cli(
            "compare", "planar5", *setting, "--laws", "sr", "--law-file", "half.py"
        )
    finally:
        from nullmotion import laws

        laws.registry._entries.pop("half-for-test", None)
    assert status == 0
    assert "half-for-test" in out


@pytest.mark.slow
def test_demo_shows_and_writes(cli, tmp_path):
    status, out, err = cli("demo")
    assert (status, err) == (0, "")
    page = (tmp_path / "nullmotion-demo" / "report.html").read_text(encoding="utf-8")
    assert 'id="atlas-space"' in page and 'id="atlas-data"' in page and "VCBSAE" in page
    assert "nullmotion-demo/report.html" in out
    assert "VCBSAE, published" in out
    assert "Next:" in out
