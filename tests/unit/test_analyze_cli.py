"""``nullmotion analyze``: its files, the state it looks at, bad input."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from nullmotion.cli import app, guard

ARRAY = '[array]\nlayout = "pyramid"\nskew_deg = 53.13010235415598\nrate_limit_deg_s = 60.0\n'


def analyze(*arguments: str) -> int:
    return guard.call(app, ["analyze", *arguments])


@pytest.fixture
def array_file(tmp_path: Path) -> Path:
    file = tmp_path / "array.toml"
    file.write_text(ARRAY, encoding="utf-8")
    return file


@pytest.mark.slow
def test_numbers_page_and_figure_are_written(array_file, tmp_path, capsys):
    out = tmp_path / "a"
    state = "--gimbal-deg=-90,0,90,0"
    assert analyze(str(array_file), "--quick", state, "--figure", "png", "--out", str(out)) == 0
    printed = capsys.readouterr().out
    assert "Omnidirectional momentum" in printed and "elliptic" in printed
    assert sorted(p.name for p in out.iterdir()) == ["analysis.json", "atlas.html", "atlas.png"]
    told = json.loads((out / "analysis.json").read_text(encoding="utf-8"))
    ball, most = told["omnidirectional_momentum"], told["max_momentum"]
    assert ball["lower"] <= 2.523 and ball["upper"] >= 2.521
    assert (ball["upper"] - ball["lower"]) / ball["lower"] < 0.005
    assert most["lower"] == pytest.approx(3.29848, abs=1e-5)
    assert told["state"]["kind"] == "elliptic" and not told["state"]["escapable"]
    assert told["array"]["rate_limit_deg_s"] == pytest.approx([60.0] * 4)
    page = (out / "atlas.html").read_text(encoding="utf-8")
    assert 'id="atlas"' in page and 'id="numbers"' in page and 'id="state"' in page
    assert analyze(str(array_file), "--quick", "--out", str(out)) == 0  # written over its own
    assert not (out / "atlas.png").exists()


@pytest.mark.slow
def test_a_scenario_is_flown_and_shown(tmp_path, capsys):
    out = tmp_path / "s"
    assert analyze("elliptic-singularity", "--quick", "--out", str(out)) == 0
    page = (out / "atlas.html").read_text(encoding="utf-8")
    assert 'id="history"' in page
    assert analyze("elliptic-singularity", "--quick", "--no-run", "--out", str(out)) == 0
    assert 'id="history"' not in (out / "atlas.html").read_text(encoding="utf-8")
    capsys.readouterr()


@pytest.mark.slow
def test_everything_at_once(array_file, tmp_path, capsys):
    out = tmp_path / "whole"
    assert analyze(str(array_file), "--figure", "pdf", "--out", str(out)) == 0
    told = json.loads((out / "analysis.json").read_text(encoding="utf-8"))
    bounds = told["volume_bounds"]
    assert bounds["lower"] <= told["volume"] <= bounds["upper"]
    assert [one["like"] for one in told["failed"]] == [0, 0, 0, 0]
    left = told["failed"][0]["radii"]
    assert left["omnidirectional"]["upper"] < told["omnidirectional_momentum"]["lower"]
    assert len(told["torque_capability"]) == 3
    assert told["torque_capability"][0]["greatest_Nm"] > 0
    assert (out / "atlas.pdf").read_bytes().startswith(b"%PDF")
    assert "One CMG failed" in capsys.readouterr().out


def test_states_may_stand_in_the_file(array_file, tmp_path, capsys):
    text = ARRAY + "[initial]\ngimbal_deg = [90, 90, 90, 90]\n"
    array_file.write_text(text, encoding="utf-8")
    assert analyze(str(array_file), "--quick", "--out", str(tmp_path / "a")) == 0
    state = json.loads((tmp_path / "a" / "analysis.json").read_text(encoding="utf-8"))["state"]
    np.testing.assert_allclose(state["momentum_Nms"], [0, 0, 3.2], atol=1e-12)
    assert "[90, 90, 90, 90] deg" in capsys.readouterr().out


def test_failed_unequal_and_guaranteed(tmp_path, capsys):
    file = tmp_path / "five.toml"
    five = '[array]\nlayout = "planar"\nn = 5\nrate_limit_deg_s = 57.29577951308232\n'
    file.write_text(five, encoding="utf-8")
    level = ("--torque-capability", "1.0")
    assert analyze(str(file), "--quick", *level, "--out", str(tmp_path / "a")) == 0
    told = json.loads((tmp_path / "a" / "analysis.json").read_text(encoding="utf-8"))
    (row,) = told["guaranteed"]
    assert row["constraint"] == "planar" and row["torque_Nm"] == pytest.approx(1.0)
    assert 4.8 < row["proven_radius"] <= row["radius"] < 5.0
    lost = ("--set", "array.failed_cmgs=[0]", "--set", "array.frozen_at_deg=0.0")
    assert analyze(str(file), "--quick", *lost, "--out", str(tmp_path / "b")) == 0
    told = json.loads((tmp_path / "b" / "analysis.json").read_text(encoding="utf-8"))
    assert told["array"]["n"] == 4
    np.testing.assert_allclose(told["array"]["momentum_bias_Nms"], [1, 0, 0], atol=1e-15)
    assert told["omnidirectional_momentum"]["lower"] == pytest.approx(4.0, rel=1e-3)
    capsys.readouterr()


@pytest.mark.parametrize(
    ("change", "arguments", "message"),
    [
        ("", ("--gimbal-deg", "1,2"), "4 angles in degrees"),
        ("", ("--gimbal-deg", "1,2,x,4"), "4 angles in degrees"),
        ("", ("--figure", "gif"), "one of pdf, png, svg"),
        ("", ("--torque-capability", "0"), "a number above 0"),
        ("", ("--torque-capability", "nan"), "a number above 0"),
        ("", ("--set", "array.skew_deg=x"), "array.skew_deg"),
        ("skew = 3\n", (), "it is written skew_deg"),
        ("[initial]\ngimbal_deg = [1, 2]\n", (), "4 numbers, one for each CMG"),
        ("[initial]\nmomentum_Nms = [9, 0, 0]\n", (), "at most 3.2"),
        ("[plant]\n", (), "[array], [initial], [scenario]"),
        ("[aray]\n", (), "did you mean array"),
    ],
)
def test_bad_input_is_told_in_one_message(array_file, tmp_path, capsys, change, arguments, message):
    array_file.write_text(ARRAY + change, encoding="utf-8")
    out = tmp_path / "kept"
    assert analyze(str(array_file), *arguments, "--out", str(out)) == 2
    told = capsys.readouterr().err
    assert message in told and "Traceback" not in told
    assert not out.exists()


def test_a_missing_file_and_a_strange_folder_are_refused(array_file, tmp_path, capsys):
    assert analyze(str(tmp_path / "none.toml")) == 2
    out = tmp_path / "mine"
    out.write_text("my own", encoding="utf-8")
    assert analyze(str(array_file), "--quick", "--out", str(out)) == 2
    assert "a folder that can be written to" in capsys.readouterr().err
    assert out.read_text(encoding="utf-8") == "my own"
