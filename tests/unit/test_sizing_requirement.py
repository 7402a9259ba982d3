"""Requirement files: what they may say, and what is said about what they may not."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from nullmotion import sizing
from nullmotion.cli import app, guard
from nullmotion.errors import InputError
from nullmotion.scenario.problems import ScenarioError
from nullmotion.sizing import schema

LEAST = """[spacecraft]
inertia_kg_m2 = [18.0, 20.0, 17.0]
[slew]
angle_deg = 30.0
time_s = 10.0
"""


def test_defaults_are_sensible():
    r = sizing.load_requirement(LEAST)
    assert r.layouts == ("box90", "roof", "roof6", "pyramid")
    assert (r.time, r.profile_time, r.period) == (10.0, 9.5, 0.02)
    assert r.cone == pytest.approx(np.pi) and r.natural_frequency == pytest.approx(2.0)
    assert r.gimbal_rates == pytest.approx(np.radians([10, 120]))
    assert np.array_equal(r.inertia, np.diag([18.0, 20.0, 17.0]))
    assert r.failures == 0 and not r.torque.any()
    assert r.held_back(2.0, 1.0) == (2.0, 1.0)


def test_settling_time_stands_beside_the_slew():
    r = sizing.load_requirement(LEAST + "[settling]\ntime_s = 2.0\n")
    assert (r.time, r.profile_time) == (12.0, 10.0)


def test_margins_are_held_back_and_put_back():
    r = sizing.load_requirement(LEAST + "[margin]\nmomentum = 0.25\ntorque = 0.5\n")
    h0, rate = r.held_back(5.0, 2.0)
    assert h0 == pytest.approx(4.0)
    assert h0 * rate == pytest.approx(5.0 * 2.0 / 1.5)
    assert r.with_margins(h0, rate) == pytest.approx((5.0, 2.0))


def test_numbers_may_stand_for_ranges_and_aliases_for_names():
    text = LEAST + '[array]\nlayouts = ["box-90"]\ngimbal_rate_deg_s = 60.0\nskew_deg = 40.0\n'
    r = sizing.load_requirement(text)
    assert r.layouts == ("box90",)
    assert r.gimbal_rates == pytest.approx((np.pi / 3, np.pi / 3))
    assert r.skews == pytest.approx(np.radians([40, 40]))


def test_the_library_loads():
    assert sizing.library_names() == ["agile-100kg", "imager-1500kg"]
    for name in sizing.library_names():
        r = sizing.load_requirement(name)
        assert r.name == name and r.title != name


WRONG = [
    ("angle_deg = 30.0", "angle_deg = 300.0", 4, "slew.angle_deg = 300.0: at most 180"),
    ("time_s", "time_ms", 5, "slew.time_ms = 10.0: unknown key; it is written time_s (s)"),
    ("[slew]", "[slue]", 3, "slue: unknown section; did you mean slew"),
    ("[18.0, 20.0, 17.0]", "[1.0, 2.0, 30.0]", 2, "at most the sum of the other two"),
    ("[18.0, 20.0, 17.0]", "[1.0, 2.0]", 2, "3 numbers (this has 2)"),
    ("10.0", "10.0\naxis = [0.0, 0.0, 0.0]", 6, "a vector that is not zero"),
    ("10.0", "nan", 5, "a finite number"),
]
MORE = [
    ("[settling]\npointing_error_deg = 40.0", 7, "below slew.angle_deg = 30"),
    ("[disturbance]\nmomentum_Nms = [1.0, 2.0]", 7, "3 numbers"),
    ("[failure]\nfailed_cmgs = 2", 7, "0 or 1"),
    ("[margin]\nmomentum = -0.1", 7, "at least 0"),
    ('[array]\nlayouts = ["piramid"]', 7, "did you mean pyramid?"),
    ('[array]\nlayouts = ["planar"]', 7, "allowed: box90"),
    ('[array]\nlayouts = ["box90", "box-90"]', 7, "each layout once"),
    ("[array]\nlayouts = []", 7, "a list of at least 1"),
    ("[array]\ngimbal_rate_deg_s = [50.0, 20.0]", 7, "a lower and a greater one"),
    ("[array]\nskew_deg = 95.0", 7, "below 90"),
    ('[law]\nbox90 = "vcbsea"', 7, "did you mean vcbsae"),
    ("[law]\nperiod_s = 1.0", 7, "from 0.0001 to 0.5 s"),
    ("[controller]\nnatural_frequency_rad_s = 100.0", 7, "at most 25"),
    ("[sampling]\naxes = 2.5", 7, "a whole number"),
    ("[spacecraft_]", 6, "unknown section"),
]


@pytest.mark.parametrize(("old", "new", "line", "said"), WRONG)
def test_what_is_wrong_is_said_with_its_line(tmp_path, old, new, line, said):
    refused(tmp_path, LEAST.replace(old, new), line, said)


@pytest.mark.parametrize(("text", "line", "said"), MORE)
def test_what_is_wrong_in_other_sections_is_said_too(tmp_path, text, line, said):
    refused(tmp_path, LEAST + text + "\n", line, said)


def refused(folder: Path, text: str, line: int, said: str) -> None:
    file = folder / "r.toml"
    file.write_text(text)
    with pytest.raises(ScenarioError) as error:
        sizing.load_requirement(file)
    lines = [one for one in str(error.value).splitlines() if said in one]
    assert len(lines) == 1, str(error.value)
    assert lines[0].startswith(f"{file}:{line}: "), str(error.value)


def test_everything_that_is_wrong_is_said_at_once():
    text = LEAST.replace("30.0", "-1.0").replace("time_s", "time_h")
    with pytest.raises(ScenarioError) as error:
        sizing.load_requirement(text + "[failure]\nfailed_cmgs = 7\n")
    assert len(str(error.value).splitlines()) == 4  # time_s is missing, too


@pytest.mark.parametrize("name", ["agile-100", "no-such.toml", "/"])
def test_a_requirement_that_is_not_there(name):
    with pytest.raises(InputError, match="agile-100kg"):
        sizing.load_requirement(name)


def test_the_command_refuses_in_one_message_and_makes_nothing(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("r.toml").write_text(LEAST.replace("30.0", "-1.0"))
    assert guard.call(app, ["size", "r.toml"]) == 2
    said = capsys.readouterr()
    assert said.out == "" and said.err.count("\n") == 1
    assert "r.toml:4: slew.angle_deg = -1.0: above 0" in said.err
    assert guard.call(app, ["size", "agile-100kg", "--out", "r.toml"]) == 2
    assert not Path("out").exists()


def test_the_documentation_has_every_key():
    text = (Path(__file__).parents[2] / "docs" / "sizing.md").read_text()
    own = set(schema.layout_names())
    for section, model in schema.models().items():
        assert f"[{section}]" in text
        for key in model.model_fields:
            assert key in own or re.search(rf"`{key}`", text), f"{section}.{key}"
