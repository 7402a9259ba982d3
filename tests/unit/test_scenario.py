"""Scenario files: what is refused, and how it is told."""

from __future__ import annotations

import re

import numpy as np
import pytest

import nullmotion as nm
from nullmotion.errors import InputError
from nullmotion.scenario import ScenarioError, library_names, load_scenario
from nullmotion.scenario.toml import document_text, key_lines

GOOD = """\
[array]
layout = "pyramid"
skew_deg = 54.73
h0_Nms = 1.0
rate_limit_deg_s = 180.0
[initial]
gimbal_deg = [0, 0, 0, 0]
[law]
name = "sr"
[mission]
hdot_Nm = [1.0, 0.0, 0.0]
[simulation]
dt_s = 0.01
duration_s = 1.0
[simulation.stop]
sigma_min_below = 0.01
"""


def refused(text: str, tmp_path) -> ScenarioError:
    """Return the error of a scenario file."""
    file = tmp_path / "s.toml"
    file.write_text(text)
    with pytest.raises(ScenarioError) as caught:
        load_scenario(file)
    return caught.value


BAD = [  # line replaced, its replacement, line number, key, what the message must say
    ("skew_deg = 54.73", "skew_dg = 54.73", 3, "array.skew_dg", "skew_deg"),
    ("skew_deg = 54.73", "skew_rad = 0.9", 3, "array.skew_rad", "it is written skew_deg (deg)"),
    ("skew_deg = 54.73", 'skew_deg = "wide"', 3, "array.skew_deg", "a number"),
    ("skew_deg = 54.73", "skew_deg = true", 3, "array.skew_deg", "a number"),
    ("skew_deg = 54.73", "skew_deg = 120", 3, "array.skew_deg", "pi/2"),
    ("h0_Nms = 1.0", "h0_Nms = -1.0", 4, "array.h0_Nms", "at least 0"),
    ("h0_Nms = 1.0", "h0_Nms = [1, 2]", 4, "array.h0_Nms", "4"),
    ("h0_Nms = 1.0", "h0_Nms = [1, 1, 1, -2]", 4, "array.h0_Nms[3]", "at least 0"),
    ("h0_Nms = 1.0", "h0_Nms = nan", 4, "array.h0_Nms", "finite"),
    ("h0_Nms = 1.0", "h0_Nm = 1.0", 4, "array.h0_Nm", "it is written h0_Nms (N m s)"),
    ("h0_Nms = 1.0", "h0_Nms = 1\nwheel_speed_rpm = 6000", 4, "array.h0_Nms", "either"),
    ("h0_Nms = 1.0", "wheel_speed_rpm = 6000", 4, "array.wheel_speed_rpm", "wheel_inertia_kg_m2"),
    ("rate_limit_deg_s = 180.0", "rate_limit_deg_s = 0", 5, "array.rate_limit_deg_s", "above 0"),
    ("rate_limit_deg_s = 180.0", "rate_limit_deg_s = inf", 5, "array.rate_limit_deg_s", "finite"),
    ("rate_limit_deg_s = 180.0", 'rate_limit_mode = "cut"', 5, "array.rate_limit_mode", "'clip'"),
    ("rate_limit_deg_s = 180.0", "angle_limits_deg = [9, 3]", 5, "array.angle_limits_deg", "below"),
    ("rate_limit_deg_s = 180.0", "failed_cmgs = [4]", 5, "array.failed_cmgs", "0 to 3"),
    ("rate_limit_deg_s = 180.0", "failed_cmgs = [-1]", 5, "array.failed_cmgs[0]", "at least 0"),
    ('layout = "pyramid"', 'layout = "pyramd"', 2, "array.layout", "did you mean pyramid"),
    ("gimbal_deg = [0, 0, 0, 0]", "gimbal_deg = [0, 0]", 7, "initial.gimbal_deg", "4 numbers"),
    ("gimbal_deg = [0, 0, 0, 0]", "gimbal_deg = [0, 0, 0, nan]", 7, "initial.gimbal_deg[3]",
     "finite"),
    ('name = "sr"', 'name = "vcbsa"', 9, "law.name", "did you mean vcbsae"),
    ('name = "sr"', 'name = "sr"\nlambda_0 = 0.1', 10, "law.lambda_0", "lambda0"),
    ('name = "sr"', 'name = "sr"\nlambda0 = "x"', 10, "law.lambda0", "a number"),
    ('name = "sr"', 'name = "sr"\nlambda0 = -1.0', 10, "law.lambda0", "0"),
    ('name = "sr"', 'name = "sr"\nschedule = "never"', 10, "law.schedule", "'det'"),
    ('name = "sr"', 'name = "sr"\nperiod_s = 0.015', 10, "law.period_s", "whole multiple"),
    ('name = "sr"', 'name = "sr"\ndelay_s = -0.01', 10, "law.delay_s", "at least 0"),
    ("hdot_Nm = [1.0, 0.0, 0.0]", "hdot_Nm = [1.0, 0.0]", 11, "mission.hdot_Nm", "3 numbers"),
    ("hdot_Nm = [1.0, 0.0, 0.0]", 'kind = "spin"', 11, "mission.kind", "'momentum-rate'"),
    ("hdot_Nm = [1.0, 0.0, 0.0]", 'profile = "no.csv"', 11, "mission.profile", "existing CSV"),
    ("dt_s = 0.01", "dt_s = 2.0", 13, "simulation.dt_s", "duration_s"),
    ("dt_s = 0.01", "dt_s = 0", 13, "simulation.dt_s", "above 0"),
    ("dt_s = 0.01", "dt_ms = 10", 13, "simulation.dt_ms", "it is written dt_s (s)"),
    ("dt_s = 0.01", 'integrator = "ode45"', 13, "simulation.integrator", "'rk4'"),
    ("sigma_min_below = 0.01", "sigma_min_under = 0.01", 16, "simulation.stop.sigma_min_under",
     "sigma_min_below"),
    ("[initial]", "[inital]", 6, "inital", "did you mean initial"),
]  # fmt: skip


@pytest.mark.parametrize(("old", "new", "line", "key", "says"), BAD)
def test_a_bad_value_is_told_with_key_value_allowed_file_and_line(
    old, new, line, key, says, tmp_path
):
    assert old in GOOD
    error = refused(GOOD.replace(old, new, 1), tmp_path)
    problem = next(p for p in error.problems if p.key == key)
    assert problem.where == f"{tmp_path / 's.toml'}:{line}"
    assert says in problem.allowed
    assert str(problem) in str(error)
    assert isinstance(error, InputError)


def test_all_problems_come_at_once_in_the_order_of_the_file(tmp_path):
    text = GOOD.replace("54.73", "-1").replace("180.0", "0").replace('"sr"', '"srr"')
    lines = str(refused(text, tmp_path)).splitlines()
    assert [line.split(": ")[1].split(" = ")[0] for line in lines] == [
        "array.rate_limit_deg_s",
        "law.name",
    ]
    text = GOOD.replace("h0_Nms = 1.0", "h0_Nms = -1").replace("180.0", "0")
    assert len(refused(text, tmp_path).problems) == 2


@pytest.mark.parametrize("section", ["array", "law", "mission", "simulation"])
def test_a_missing_section_is_told(section, tmp_path):
    parts = re.split(r"^(?=\[)", GOOD, flags=re.MULTILINE)
    error = refused("".join(p for p in parts if not p.startswith(f"[{section}")), tmp_path)
    assert any(p.key == section and "missing" in p.allowed for p in error.problems)


@pytest.mark.parametrize(
    ("text", "line"), [("[array]\nlayout = pyramid\n", 2), ("[array\n", 1), ("a = 1\na = 2\n", 2)]
)
def test_broken_toml_is_told_with_its_line(text, line, tmp_path):
    assert refused(text, tmp_path).where == f"{tmp_path / 's.toml'}:{line}"


CUSTOM = GOOD.replace('layout = "pyramid"\nskew_deg = 54.73', 'layout = "custom"\n{}').replace(
    "[0, 0, 0, 0]", "[0, 0, 0]"
)


@pytest.mark.parametrize(
    ("gimbal", "spin", "key", "says"),
    [
        (
            "[[1,0,0],[0,1,0],[0,0,2]]",
            "[[0,1,0],[0,0,1],[1,0,0]]",
            "array.gimbal_axes",
            "unit vector",
        ),
        ("[[1,0,0],[0,1,0],[0,0,1]]", "[[1,0,0],[0,0,1],[1,0,0]]", "array.spin_axes", "parallel"),
        ("[[1,0,0],[0,1,0],[0,0,1]]", "[[0,1,0],[0,0,1]]", "array.spin_axes", "3 x 3"),
        (
            "[[1,0],[0,1,0],[0,0,1]]",
            "[[0,1,0],[0,0,1],[1,0,0]]",
            "array.gimbal_axes[0][2]",
            "missing",
        ),
    ],
)
def test_impossible_axes_are_told(gimbal, spin, key, says, tmp_path):
    error = refused(CUSTOM.format(f"gimbal_axes = {gimbal}\nspin_axes = {spin}"), tmp_path)
    problem = next(p for p in error.problems if p.key == key)
    assert says in problem.allowed
    assert "s.toml:" in problem.where


def test_a_custom_array_flies(tmp_path):
    text = CUSTOM.format(
        "gimbal_axes = [[1,0,0],[0,1,0],[0,0,1]]\nspin_axes = [[0,1,0],[0,0,1],[1,0,0]]"
    )
    run = nm.simulate(nm.load_scenario(text))
    assert run.setup.array.n == 3


@pytest.mark.parametrize(
    ("rows", "says"),
    [
        ("t_s,x,y,z\n0,0,0,0\n0,1,0,0\n", "increase"),
        ("t_s,x,y,z\n0,0,0,nan\n", "finite"),
        ("t_s,x,y,z\n0,0,0\n", "4 finite numbers"),
        ("t,x,y,z\n0,0,0,0\n", "t_s,x,y,z"),
        ("t_s,x,y,z\n", "at least one row"),
        ("", "t_s,x,y,z"),
    ],
)
def test_a_bad_profile_is_told(rows, says, tmp_path):
    (tmp_path / "p.csv").write_text(rows)
    error = refused(GOOD.replace("hdot_Nm = [1.0, 0.0, 0.0]", 'profile = "p.csv"'), tmp_path)
    assert error.key == "mission.profile"
    assert says in error.allowed


def test_values_set_over_a_file_are_told_as_such(tmp_path):
    with pytest.raises(ScenarioError) as caught:
        load_scenario(GOOD, {"array.skew_deg": -3.0})
    assert caught.value.where == "--set"
    assert load_scenario(GOOD, {"law.lambda0": 0.5}).law.lambda0 == 0.5


def test_compare_cases_are_checked_at_their_lines(tmp_path):
    cases = '[[compare.case]]\nname = "gsr"\n[[compare.case]]\nname = "gsr"\nmu00 = 1.0\n'
    error = refused(GOOD + cases, tmp_path)
    assert error.problems[0].key == "compare.case[1].mu00"
    assert error.where.endswith(f":{GOOD.count(chr(10)) + 5}")


def test_unknown_scenario_names_get_suggestions():
    with pytest.raises(InputError, match="did you mean elliptic-singularity"):
        load_scenario("eliptic-singularity")
    with pytest.raises(InputError, match="existing file"):
        load_scenario("nowhere/s.toml")


def test_lines_of_keys_follow_sections_tables_and_values_over_several_lines():
    text = '# c\na.b = 1\n["x y"]\nk = [\n  [1, 2], # [z]\n  3]\ns = """\n[no]\nq = 1\n"""\n'
    text += "[[t.u]]\nv = 1\n[[t.u]]\nv = { w = 2 }\n"
    lines = key_lines(text)
    assert lines[("a", "b")] == 2
    assert lines[("x y", "k")] == 4
    assert lines[("x y", "s")] == 7
    assert lines[("t", "u", 0, "v")] == 12
    assert lines[("t", "u", 1, "v")] == 14
    assert ("no",) not in lines


def test_a_written_document_reads_back(rng):
    import tomllib

    data = {
        "a": 1,
        "s": {"x": [0.1, float(rng.normal())], "t": {"y": 'q"\n'}},
        "c": {"case": [{"n": "a"}, {"b": True}]},
    }
    assert tomllib.loads(document_text(data)) == data


@pytest.mark.parametrize("name", library_names())
@pytest.mark.sampled(4)
def test_library_scenarios_fly(name):
    scenario = load_scenario(name)
    assert scenario.about.title
    assert scenario.about.description
    early = {f"event.{i}.at_s": 0.2 for i in range(len(scenario.events))}
    run = nm.simulate(load_scenario(name, {"simulation.duration_s": 0.5, **early}))
    assert np.isfinite(run.delta).all()
