"""The command line: exit status, one message, what lands on disk."""

from __future__ import annotations

import json
import subprocess
import sys
import time

import pytest

from nullmotion.cli import app, guard, screen

SHORT = ["--set", "simulation.duration_s=0.5"]


@pytest.fixture
def cli(capsys, tmp_path, monkeypatch):
    """Call the command in an empty folder; return status, output and errors."""
    monkeypatch.chdir(tmp_path)

    def call(*arguments):
        status = guard.call(app, arguments)
        said = capsys.readouterr()
        return status, said.out, said.err

    return call


def test_help_is_fast_and_imports_nothing_heavy():
    code = "import sys; from nullmotion.cli import main; sys.argv[1:] = ['--help']\n"
    code += "heavy = ('numpy', 'llvmlite', 'pydantic')\n"
    code += "try: main()\nexcept SystemExit: print([m for m in heavy if m in sys.modules])"
    start = time.perf_counter()
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert done.stdout.strip().endswith("[]"), done.stdout + done.stderr
    assert time.perf_counter() - start < 2  # half a second on an idle machine
    for command in ("demo", "run", "rerun", "compare", "list", "paper"):
        assert f"  {command} " in done.stdout


def test_a_run_stores_everything(cli, tmp_path):
    status, out, err = cli(
        "run", "elliptic-singularity", *SHORT, "--set", "law.name=gsr", "--csv", "--out", "r"
    )
    assert (status, err) == (0, "")
    assert {p.name for p in (tmp_path / "r").iterdir()} == {
        "trajectory.nc",
        "summary.json",
        "trajectory.csv",
        "report.html",
    }
    assert json.loads((tmp_path / "r" / "summary.json").read_text())["law"] == "gsr"
    assert "Off-axis torque" in out
    status, out, _ = cli("rerun", "r", "--out", "again")
    assert status == 0
    assert "identical, bit for bit" in out
    assert (tmp_path / "again" / "summary.json").is_file()


def test_set_reaches_every_kind_of_value(cli, tmp_path):
    settings = [
        "law.name=odsr",
        "law.w=[1, 0.5, 1, 1]",
        "law.as_published=true",
        "array.rate_limit_mode=clip",
    ]
    flags = [part for setting in settings for part in ("--set", setting)]
    status, _, err = cli("run", "elliptic-singularity", *SHORT, *flags, "--out", "r")
    assert (status, err) == (0, "")
    found = json.loads((tmp_path / "r" / "summary.json").read_text())
    assert found["parameters"]["w"] == [1, 0.5, 1, 1]
    assert found["parameters"]["as_published"] is True


@pytest.mark.slow
def test_the_seed_reaches_the_plant(cli, tmp_path):
    for seed in (1, 2):
        assert cli("run", "plant-errors", *SHORT, "--seed", str(seed), "--out", f"r{seed}")[0] == 0
    finals = [json.loads((tmp_path / f"r{s}" / "summary.json").read_text()) for s in (1, 2)]
    assert [f["seed"] for f in finals] == [1, 2]
    assert finals[0]["final_momentum"] != finals[1]["final_momentum"]


def test_the_seed_reaches_the_sensors(cli, tmp_path):
    short = ("--set", "simulation.duration_s=0.2", "--set", "sensors.gyro_noise_deg_s=0.01")
    for seed in (1, 2):
        given = (*short, "--seed", str(seed), "--out", f"a{seed}")
        assert cli("run", "attitude-slew", *given)[0] == 0
    finals = [json.loads((tmp_path / f"a{s}" / "summary.json").read_text()) for s in (1, 2)]
    assert finals[0]["final_momentum"] != finals[1]["final_momentum"]


BAD = [
    (
        ["run", "elliptic-singularity", "--set", "law.name=vcbsa"],
        ["law.name", "vcbsa", "vcbsae", "--set"],
    ),
    (
        ["run", "elliptic-singularity", "--set", "array.h0_Nms=-1"],
        ["array.h0_Nms", "-1", "at least 0"],
    ),
    (["run", "elliptic-singularity", "--set", "array.rate_limit_deg_s=0"], ["above 0"]),
    (["run", "elliptic-singularity", "--set", "simulation.dt_s=20"], ["duration_s"]),
    (["run", "elliptic-singularity", "--set", "array.skew_deg=nan"], ["finite"]),
    (["run", "elliptic-singularity", "--set", "law.mu"], ["section.key=value"]),
    (["run", "elliptic-singularity", "--set", "mission.hdot_Nm=[1, 0"], ["TOML value"]),
    (["run", "eliptic-singularity"], ["did you mean elliptic-singularity"]),
    (["run", "missing.toml"], ["missing.toml", "existing file"]),
    (["run", "profile", "--law-file", "missing.py"], ["missing.py"]),
    (["run", "profile", "--backend", "gpu"], ["kernel"]),
    (["run", "failed-cmg", "--set", "law.name=nd"], ["null motion"]),
    (["rerun", "."], ["trajectory.nc"]),
    (["compare", "profile", "--laws", "sr,vcbsa"], ["--laws", "vcbsae"]),
    (["compare", "profile", "--vary", "array.skew_deg=1:2"], ["start:stop:step"]),
    (["compare", "profile", "--vary", "array.skew_deg=40:100:30"], ["array.skew_deg", "100"]),
    (["list", "law"], ["laws"]),
    (["paper", "mao2018"], ["mao2019"]),
    (["run"], ["SCENARIO"]),
    (["fly"], ["fly"]),
]


@pytest.mark.parametrize(("arguments", "says"), BAD)
def test_bad_input_is_status_2_with_one_message(arguments, says, cli, tmp_path):
    status, out, err = cli(*arguments)
    assert status == 2
    assert out == ""
    assert "Traceback" not in err
    assert err.count("rror: ") == 1
    assert all(word in err for word in says)
    assert list(tmp_path.iterdir()) == []


def test_a_bad_file_is_told_with_its_line(cli, tmp_path):
    (tmp_path / "s.toml").write_text('[array]\nlayout = "pyramid"\nskew = 54\n')
    status, _, err = cli("run", "s.toml")
    assert status == 2
    assert "s.toml:3: array.skew = 54: unknown key; it is written skew_deg (deg)" in err


def test_a_folder_that_cannot_be_written_is_told_before_the_work(cli, tmp_path):
    (tmp_path / "file").write_text("")
    status, out, err = cli("run", "profile", "--out", "file")
    assert (status, out) == (2, "")
    assert "--out" in err


def test_what_breaks_is_status_1_with_a_hint(cli, monkeypatch):
    def broken(*_, **__):
        raise RuntimeError("boom")

    monkeypatch.setattr("nullmotion.scenario.simulate.simulate", broken)
    status, _, err = cli("run", "profile")
    assert status == 1
    assert err == "error: RuntimeError: boom (add --debug for the traceback)\n"
    assert "Traceback" in cli("run", "profile", "--debug")[2]


def test_an_interrupted_run_leaves_the_old_result(cli, tmp_path, monkeypatch):
    assert cli("run", "profile", *SHORT, "--out", "r")[0] == 0
    before = {p.name: p.read_bytes() for p in (tmp_path / "r").iterdir()}

    def interrupted(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr("nullmotion.scenario.store.summary", interrupted)
    status, _, err = cli("run", "profile", "--out", "r")
    assert status == 130
    assert err == "interrupted; no result was written\n"
    assert {p.name: p.read_bytes() for p in (tmp_path / "r").iterdir()} == before


LAW = '''
from dataclasses import dataclass
from typing import ClassVar
from nullmotion import Law

@dataclass(frozen=True)
class Mine(Law):
    """Jacobian transpose."""
    name: ClassVar[str] = "mine-for-test"
    gain: float = 1.0

    def step(self, array, obs, state):
        return self.gain * array.unit_jacobian(obs.delta).T @ obs.hdot, state
'''


@pytest.fixture
def law_file(tmp_path):
    """A law of one's own; forgotten again afterwards."""
    from nullmotion import laws

    (tmp_path / "my.py").write_text(LAW)
    yield tmp_path / "my.py"
    laws.registry._entries.pop("mine-for-test", None)


def test_a_law_file_flies_and_repeats(cli, tmp_path, law_file):
    status, out, err = cli("run", "profile", *SHORT, "--law-file", "my.py", "--out", "r")
    assert (status, err) == (0, "")
    assert "mine-for-test" in out
    law_file.unlink()
    status, out, _ = cli("rerun", "r")
    assert status == 0
    assert "identical" in out


def test_a_failed_run_is_stored_with_a_page_that_says_so(cli, tmp_path, law_file):
    text = law_file.read_text().replace("obs.hdot, state", "(obs.hdot / (obs.t < 0.195)), state")
    assert text.count("obs.t") == 1
    law_file.write_text(text)
    status, out, err = cli("run", "profile", *SHORT, "--law-file", "my.py", "--out", "r")
    assert (status, err) == (0, "")
    assert "non-finite" in out
    page = (tmp_path / "r" / "report.html").read_text()
    assert "Failed: not a number from" in page
    summary = json.loads((tmp_path / "r" / "summary.json").read_text())
    assert "non-finite" in summary["status"] and summary["momentum_state"] == "unknown"


def test_vectors_are_shown_without_rounding_noise():
    assert screen.vector([1.155, 0.0, -5.294e-17]) == "1.155 0 0"
    assert screen.vector([-1e-20, 2e-20]) == "-1e-20 2e-20"
    assert screen.vector([float("nan"), 1.0]) == "nan 1"


@pytest.mark.parametrize(
    "kind", ["laws", "layouts", "controllers", "metrics", "costs", "papers", "scenarios"]
)
def test_lists(kind, cli):
    status, out, err = cli("list", kind)
    assert (status, err) == (0, "")
    entries = json.loads(cli("list", kind, "--json")[1])
    assert all(entry["name"] in out for entry in entries)
    if kind == "laws":
        assert all(entry["citation"] and entry["claims"] for entry in entries)
