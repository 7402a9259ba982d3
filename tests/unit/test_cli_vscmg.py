"""The command line on variable-speed CMGs: files, pages, refusals."""

from __future__ import annotations

import json
import re

import numpy as np
import pytest

from nullmotion.cli import app, guard
from nullmotion.plot import figures, panels, wheels
from nullmotion.report.wheels import INCOMPLETE
from nullmotion.scenario import load_scenario
from nullmotion.scenario.simulate import simulate

STARTUP = """\
[array]
layout = "pyramid"
wheel_inertia_kg_m2 = 1e-3
wheel_speed_rad_s = 200.0
wheel_torque_limit_Nm = 0.004
wheel_speed_limit_rpm = 2000
rate_limit_deg_s = 40.0
[vscmg]
spin_inertia_kg_m2 = 2e-3
transverse_inertia_kg_m2 = 1.5e-3
gimbal_inertia_kg_m2 = 1.5e-3
[spacecraft]
inertia_kg_m2 = [0.05, 0.06, 0.07]
q_BN = [0.9, 0.1, 0.4, 0.1]
omega_BN_B = [0.02, 0.0, 0.0]
[controller]
name = "adaptive"
kp = 0.005
k = 0.02
[law]
name = "vscmg-weighted"
k_m = 30.0
[mission]
kind = "startup"
target_q_BN = [1.0, 0.0, 0.0, 0.0]
[[event]]
kind = "wheel-dead"
cmg = 1
at_s = 1.5
detected_after_s = 0.5
[simulation]
duration_s = 2.5
"""
SHORT = ("--set", "simulation.duration_s=0.2", "--set", "event.0.at_s=0.1")


@pytest.fixture
def cli(capsys, tmp_path, monkeypatch):
    """Call the command in an empty folder; return status, output and errors."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "s.toml").write_text(STARTUP, encoding="utf-8")

    def call(*arguments):
        status = guard.call(app, arguments)
        said = capsys.readouterr()
        return status, said.out, said.err

    return call


@pytest.fixture(scope="module")
def flown():
    return simulate(load_scenario(STARTUP))


def test_a_startup_is_run_stored_and_repeated(cli, tmp_path):
    status, out, err = cli("run", "s.toml", "--out", "r")
    assert status == 0 and not err
    for words in ("Wheels settled", "Final wheel speeds", "Momentum budget", "torque cut"):
        assert words in out
    assert "startup-incomplete" in out and "wheel torque" in out
    summary = json.loads((tmp_path / "r" / "summary.json").read_text())
    assert "startup-incomplete" in summary["status"] and len(summary["limited"]) >= 2
    page = (tmp_path / "r" / "report.html").read_text()
    headline = re.search(r"<h1[^>]*>(.*?)</h1>", page)[1]
    assert headline.startswith("CMG 2&#x27;s wheel motor dead at t = 1.5 s, found at 2 s")
    assert "startup incomplete: wheels off by up to" in headline
    charts = json.loads(re.search(r'id="charts">(.*?)</script>', page)[1])["figures"]
    for key in ("wheel_speeds", "wheel_torques", "rates", "estimated_inertia", "lyapunov"):
        assert key in charts
    shaded = [s for s in charts["wheel_torques"]["layout"]["shapes"] if s["type"] == "rect"]
    assert shaded and "Shaded" in page
    status, out, err = cli("rerun", "r")
    assert status == 0 and "identical, bit for bit" in out


@pytest.mark.parametrize(
    ("setting", "says"),
    [
        ("array.wheel_torque_limit_Nm=-1", "array.wheel_torque_limit_Nm = -1: at least 0"),
        ("vscmg.drive=belt", "vscmg.drive = \"belt\": 'rate' or 'torque'"),
        ("law={ name = 'sr' }", 'law.name = "sr": a startup needs a law that turns the wheels'),
        ("spacecraft.omega_BN_B=[20,0,0]", "omega_BN_B = [20.0, 0.0, 0.0]: less momentum: 1 N m s"),
        ("servo.time_constant_s=0.1", "servo: not beside [vscmg]"),
        ("vscmg.gimbal_inertia=1", "gimbal_inertia_kg_m2"),
        ("event.0.kind=spin-down", 'event[0].kind = "spin-down"'),
    ],
)
def test_bad_input_is_one_message_and_status_2(cli, setting, says):
    status, out, err = cli("run", "s.toml", "--set", setting)
    assert status == 2 and not out and "Traceback" not in err
    assert err.count("error:") == 1 and says in err and "--set" in err


def test_the_file_and_line_are_told(cli, tmp_path):
    (tmp_path / "bad.toml").write_text(STARTUP.replace("spin_inertia_kg_m2 = 2e-3\n", ""))
    status, _, err = cli("run", "bad.toml")
    assert status == 2 and "bad.toml:8: vscmg.spin_inertia_kg_m2: this key is missing" in err


@pytest.mark.slow
def test_startups_are_compared_over_new_keys(cli, tmp_path):
    vary = "array.wheel_torque_limit_Nm=0.002,0.02"
    status, out, err = cli("compare", "s.toml", "--vary", vary, *SHORT, "--out", "c")
    assert status == 0 and not err and "final wheel speed error" in out
    cases = json.loads((tmp_path / "c" / "compare.json").read_text())["cases"]
    assert [case["value"] for case in cases] == [0.002, 0.02]
    assert cases[0]["max_wheel_torque_Nm"] <= 0.002 * (1 + 1e-9) < cases[1]["max_wheel_torque_Nm"]
    page = (tmp_path / "c" / "report.html").read_text()
    assert "varied_final_wheel_speed_error" in page


@pytest.mark.slow
def test_a_law_that_cannot_start_wheels_is_a_row(cli):
    status, out, _ = cli("compare", "s.toml", "--laws", "sr", *SHORT)
    assert status == 0 and "could not run" in out and "turns the wheels" in out


def test_the_charts_hold_what_the_run_did(flown):
    found = {panel.key: panel for panel in panels.run_panels(flown)}
    speeds = found["wheel_speeds"]
    assert np.array_equal(speeds.curves[2].y, flown.wheel_speed[:, 2])
    assert next(level.value for level in speeds.levels) == pytest.approx(200.0)
    assert speeds.levels[0].dash == "dash" and "design 200" in speeds.levels[1].label
    torques = found["wheel_torques"]
    assert {level.value for level in torques.levels} >= {0.004}
    cut = np.flatnonzero(flown.limited[:-1] > 0)
    inside = [any(a <= flown.t[k] < b for a, b in torques.spans) for k in cut]
    assert all(inside) and torques.spans == found["wheel_speeds"].spans
    assert not found["body_rate"].spans
    values = found["estimated_inertia"].curves[0].y
    scale = 10.0 ** np.round(np.log10(flown.estimates[-1, 0] / values[-1]))
    assert np.allclose(values * scale, flown.estimates[:, 0])
    keys = [panel.key for panel in panels.figure_panels(flown)]
    assert keys[:4] == ["pointing_error", "wheel_speeds", "wheel_torques", "rates"]


def test_shaded_spans_near_each_other_are_one():
    spans = [(0.0, 1.0), (1.2, 2.0), (50.0, 60.0)]
    assert wheels._joined(spans, 10.0) == ((0.0, 1.0), (1.2, 2.0), (50.0, 60.0))
    assert wheels._joined(spans, 1000.0) == ((0.0, 2.0), (50.0, 60.0))
    many = [(float(i), i + 0.5) for i in range(1000)]
    assert len(wheels._joined(many, 1000.0)) <= 200


@pytest.mark.slow
def test_a_figure_is_drawn(flown, tmp_path):
    assert INCOMPLETE in flown.status
    target = figures.run_figure(flown, tmp_path / "run.png", "Startup")
    assert target.stat().st_size > 50_000
