"""The command ``nullmotion rover``: what it writes, says and refuses, and how it ends."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
import xarray

from nullmotion.cli import app, guard
from nullmotion.rover.interrupt import interruptible
from nullmotion.rover.path_cost import PlannedStep
from nullmotion.rover.rover import peter

pytestmark = pytest.mark.slow  # it simulates whole steps

DISTANCE = 1 / np.sqrt(3)  # m, of a step of PETER


@pytest.fixture
def cli(capsys, tmp_path, monkeypatch):
    """Call the command in an empty folder; return status, output and errors."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("NULLMOTION_CACHE", str(tmp_path / ".cache"))

    def call(*arguments):
        status = guard.call(app, ["rover", *arguments])
        said = capsys.readouterr()
        return status, said.out, said.err

    return call


@pytest.fixture
def short_plans(monkeypatch):
    """A planner for missions that takes no time."""

    def invented(rover, gravity):
        def plan(edge, face, pitch, cross, progress):
            return PlannedStep(150.0 + 300 * pitch**2, 4.0 + cross, 60.0 - 20 * pitch)

        return plan

    monkeypatch.setattr("nullmotion.rover.path_plans.planner", invented)


@pytest.fixture(scope="module")
def ran(tmp_path_factory):
    """The folder of one run, and what it printed."""
    folder = tmp_path_factory.mktemp("run")
    command = [sys.executable, "-m", "nullmotion", "rover", "run", "peter-slope", "--csv"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=300)
    assert (done.returncode, done.stderr) == (0, "")
    return folder / "out" / "peter-slope", done.stdout


def columns(file):
    heads = file.read_text().partition("\n")[0].split(",")
    values = np.loadtxt(file, delimiter=",", skiprows=1)
    return dict(zip(heads, values.T, strict=True))


# --- a plan ---


def test_a_plan_is_written_and_told(cli, tmp_path):
    status, out, err = cli("plan", "peter", "--edge", "2", "--incline-deg", "15", "--out", "p")
    assert (status, err) == (0, "")
    assert {p.name for p in (tmp_path / "p").iterdir()} == {"plan.json", "plan.csv", "report.html"}
    found = json.loads((tmp_path / "p" / "plan.json").read_text())
    assert (found["rover"], found["edge"], found["incline_deg"]) == ("PETER", 2, 15.0)
    assert found["branch"] in (1, -1) and found["seconds"] > 0 and found["motion"] == "planned"
    t, theta = np.array(found["t_s"]), np.array(found["theta_rad"])
    assert t[-1] == pytest.approx(found["duration_s"])
    assert theta[[0, -1]] == pytest.approx([0, np.arccos(-1 / 3)], abs=1e-6)
    for angle in ("theta", "delta"):
        rate = np.array(found[f"{angle}_dot_rad_s"])
        assert np.diff(found[f"{angle}_rad"]) == pytest.approx(
            np.diff(t) * (rate[1:] + rate[:-1]) / 2, abs=2e-4
        )
    assert 0 < found["least_margin_Nm"] <= min(found["margin_Nm"]) + 1e-9
    assert found["cost_of_travel_J_kg_m"] == pytest.approx(found["energy_J"] / (47 * DISTANCE))
    table = columns(tmp_path / "p" / "plan.csv")
    assert table["delta_rad"] == pytest.approx(found["delta_rad"], rel=1e-15)
    for word in (f"{found['least_margin_Nm']:.4g}", f"{found['energy_J']:.4g}", "report.html"):
        assert word in out
    assert "[cmg]" in found["document"] and found["versions"]["casadi"]


def test_options_and_set_reach_the_plan(cli, tmp_path):
    given = ("--set", "site.gravity_m_s2=1.62", "--set", "planner.nodes=[20, 30]")
    assert cli("plan", *given, "--incline-deg", "-5", "--out", "p")[0] == 0
    found = json.loads((tmp_path / "p" / "plan.json").read_text())
    assert (found["gravity_m_s2"], found["incline_deg"], found["edge"]) == (1.62, -5.0, 1)


def test_a_plan_that_fails_says_what_is_violated(cli, tmp_path):
    status, out, err = cli("plan", "--incline-deg", "80")
    assert (status, out) == (1, "")
    assert err.startswith("error: no step over edge 1 at 80 deg in 3.711 m/s^2: ")
    assert "violated by" in err and "N m" in err and err.count("\n") == 1
    assert not (tmp_path / "out").exists()


def test_a_plan_with_wheels(cli, tmp_path):
    status, out, err = cli("plan", "hedgehog", "--incline-deg", "30", "--out", "h")
    assert (status, err) == (0, "")
    assert {p.name for p in (tmp_path / "h").iterdir()} == {"plan.json", "versine.csv"}
    found = json.loads((tmp_path / "h" / "plan.json").read_text())
    assert found["impulsive"]["cost_of_travel_J_kg_m"] == pytest.approx(1599.4, abs=0.05)  # Table 6
    assert found["versine"]["cost_of_travel_J_kg_m"] == pytest.approx(11331.4, rel=1e-3)
    assert "1599" in out and "landed" in out
    at_rest = columns(tmp_path / "h" / "versine.csv")["theta_dot_rad_s"][[0, -1]]
    assert at_rest == pytest.approx([0, 0], abs=1e-9)


@pytest.mark.parametrize(("rate", "outcome"), [("0.2", "stalled"), ("3.0", "tipped")])
def test_a_versine_that_cannot_be_made_is_named(cli, tmp_path, rate, outcome):
    asked = ("--set", "step.motion=versine", "--set", f"step.versine_rate_rad_s={rate}")
    status, out, err = cli("plan", *asked, "--incline-deg", "10", "--out", "p")
    assert (status, err) == (0, "")
    assert f"The versine {outcome} at " in out
    found = json.loads((tmp_path / "p" / "plan.json").read_text())
    assert found["outcome"] == outcome and found["reason"]
    assert found["motion"] == "versine"


# --- a run ---


@pytest.mark.slow
def test_a_run_is_written(ran):
    folder, out = ran
    tables = {"plan", "initialise", "closed_loop", "landing"}
    assert {p.name for p in folder.iterdir()} == {
        "run.json",
        "trajectory.nc",
        "report.html",
        *(f"{name}.csv" for name in tables),
    }
    found = json.loads((folder / "run.json").read_text())
    assert found["outcome"] == "landed" and found["landing"]["as_planned"] is True
    for words in ("landed", "touchdown", "Gimbal brought from 0", "Closed loop", "(rock)"):
        assert words in out


def test_the_numbers_of_a_run(ran):
    folder, _ = ran
    found = json.loads((folder / "run.json").read_text())
    plan, closed, landing = found["plan"], found["closed_loop"], found["landing"]
    assert closed["max_angle_error_rad"] < 0.05 and closed["least_margin_Nm"] > 0
    assert landing["slip_mm"] < 10 and landing["tilt_deg"] < 1
    assert landing["energy_J"] == pytest.approx(closed["energy_J"], rel=0.03)
    for part in (closed, landing):
        assert part["energy_balance"] < 1e-5
        assert part["cost_of_travel_J_kg_m"] == pytest.approx(part["energy_J"] / (47 * DISTANCE))
    way = found["initialisation"]
    assert way["to_deg"] % 360 == pytest.approx(plan["start_gimbal_deg"] % 360, abs=0.01)
    assert 0 < way["least_spare_Nm"] < way["static_threshold_Nm"]
    events = landing["events"]
    assert [e["t_s"] for e in events] == sorted(e["t_s"] for e in events)
    assert {"departure", "touchdown", "landing"} <= {e["kind"] for e in events}


def test_the_histories_of_a_run(ran):
    folder, _ = ran
    found = json.loads((folder / "run.json").read_text())
    closed, landing = (columns(folder / f"{name}.csv") for name in ("closed_loop", "landing"))
    assert np.abs(closed["angle_error_rad"]).max() == found["closed_loop"]["max_angle_error_rad"]
    # on the ground: the mass centre's height from the attitude and from its speed
    t, speed = landing["t_s"], landing["velocity_p_m_s"]
    climbed = np.sum(np.diff(t) * (speed[1:] + speed[:-1]) / 2)
    assert climbed == pytest.approx(np.ptp(landing["position_p_m"][[0, -1]]), abs=2e-3)
    carried = sum(landing[f"force_{spike}_p_N"] for spike in range(4))
    weight = 47 * 3.711 * np.cos(np.radians(15))
    assert carried[-1] == pytest.approx(weight, rel=0.05)
    q = np.array([landing[f"q_BN_{i}"] for i in range(4)])
    assert np.linalg.norm(q, axis=0) == pytest.approx(1.0, abs=1e-6)
    with xarray.open_dataset(folder / "trajectory.nc") as data:
        assert data["landing_force"].dims == ("landing_t", "spike", "axis")
        assert data["landing_force"][:, 2, 1].values == pytest.approx(landing["force_2_r_N"])
        assert data["closed_loop_theta"].attrs["units"] == "rad"
        assert data.attrs["outcome"] == "landed" and "[ground]" in data.attrs["rover"]
        assert "q_BN" in data.attrs["conventions"]


@pytest.mark.slow
def test_a_run_on_other_ground_without_manoeuvre(cli, tmp_path):
    (tmp_path / "soil.toml").write_text('[ground]\nname = "soil"\nstiffness_N_m = 8e4\n')
    status, out, err = cli("run", "peter", "--ground", "soil.toml", "--out", "r")
    assert (status, err) == (0, "")
    assert "(soil)" in out and "Gimbal brought" not in out
    assert {p.name for p in (tmp_path / "r").iterdir()} == {
        "run.json",
        "trajectory.nc",
        "report.html",
    }
    assert json.loads((tmp_path / "r" / "run.json").read_text())["initialisation"] is None


# --- a mission ---

TRIP = """[mission]
title = "a short trip"
rover = "peter"
start_m = [2.0, 2.0]
goal_m = [8.0, 8.0]
[terrain]
size_m = 10.0
seed = 4
[upkeep]
power_W = 40.0
pause_s = 30.0
spin_up_time_s = 3600.0
"""


def test_a_mission_is_written_and_compared(cli, tmp_path, short_plans):
    (tmp_path / "trip.toml").write_text(TRIP)
    status, out, err = cli("mission", "trip.toml", "--csv", "--out", "m")
    assert (status, err) == (0, "")
    names = {"mission.json", "steps.csv", "report.html"}
    assert {p.name for p in (tmp_path / "m").iterdir()} == names
    found = json.loads((tmp_path / "m" / "mission.json").read_text())
    n, path = found["steps"], found["path"]
    assert len(path["energy_J"]) == n and len(path["footprints_m"]) == n + 1
    assert np.linalg.norm(np.mean(path["footprints_m"][-1], axis=0)[:2] - [8, 8]) < 1
    # cost of travel, added up
    energy = sum(path["energy_J"]) + 40 * sum(30 + t for t in path["time_s"])
    energy += 40 * 3600 + 0.5 * 0.14 * 800**2
    middles = np.mean(found["path"]["footprints_m"], axis=1)
    way = np.linalg.norm(np.diff(middles, axis=0), axis=1).sum()
    assert found["cost_of_travel_J_kg_m"] == pytest.approx(energy / (47 * way))
    costs = found["comparison"]["cmg_J_kg_m"]
    assert costs["this trip"] == found["cost_of_travel_J_kg_m"]
    assert costs["50 m"] > costs["100 m"] > costs["10000 m"] > costs["without end"]
    rows = found["comparison"]["wheels"]
    assert [row["rover"] for row in rows] == ["Hedgehog", "hypothesised rover"]
    for row in rows:
        even = row["break_even_m"]
        spin_up = (40 * 3600 + 0.5 * 0.14 * 800**2) / 47
        assert costs["without end"] + spin_up / even == pytest.approx(row["impulsive_J_kg_m"])
    table = columns(tmp_path / "m" / "steps.csv")
    assert table["pitch_deg"] == pytest.approx(path["pitch_deg"])
    for words in ("a short trip", "Hedgehog", f"{found['step_energy_J']:.4g}"):
        assert words in out


def test_level_ground_costs_wheels_what_table_6_says(cli, tmp_path, short_plans):
    (tmp_path / "t.toml").write_text(TRIP + "rotor = 1\n")
    assert cli("mission", "t.toml")[0] == 2
    (tmp_path / "t.toml").write_text(TRIP)
    assert cli("mission", "t.toml", "--set", "terrain.rms_slope_deg=0", "--out", "m")[0] == 0
    rows = json.loads((tmp_path / "m" / "mission.json").read_text())["comparison"]["wheels"]
    assert [row["impulsive_J_kg_m"] for row in rows] == pytest.approx([632.1, 1086.1], abs=0.05)
    assert [row["refused_steps_fraction"] for row in rows] == [0, 0]


def test_no_step_is_needed(cli, tmp_path, short_plans):
    (tmp_path / "t.toml").write_text(TRIP.replace("[8.0, 8.0]", "[2.0, 2.0]"))
    status, out, _ = cli("mission", "t.toml", "--csv", "--out", "m")
    assert status == 0 and "No step was needed" in out
    assert json.loads((tmp_path / "m" / "mission.json").read_text())["steps"] == 0


def test_an_interrupted_mission_leaves_the_old_result(cli, tmp_path, short_plans, monkeypatch):
    (tmp_path / "t.toml").write_text(TRIP)
    assert cli("mission", "t.toml", "--out", "m")[0] == 0
    before = {p.name: p.read_bytes() for p in (tmp_path / "m").iterdir()}

    def interrupted(*_, **__):
        raise KeyboardInterrupt

    for place in ("mission_run.travel", "mission_run_store.mission_record"):
        monkeypatch.setattr(f"nullmotion.rover.{place}", interrupted)
        status, _, err = cli("mission", "t.toml", "--out", "m")
        assert (status, err) == (130, "interrupted; no result was written\n")
        assert {p.name: p.read_bytes() for p in (tmp_path / "m").iterdir()} == before


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="SIGINT")
def test_ctrl_c_while_steps_are_planned(tmp_path):
    command = [sys.executable, "-m", "nullmotion", "rover", "mission", "--out", "m"]
    environment = {**os.environ, "NULLMOTION_CACHE": str(tmp_path / "cache")}
    with subprocess.Popen(
        command, cwd=tmp_path, env=environment, stderr=subprocess.PIPE, text=True
    ) as process:
        begin = time.monotonic()
        while not list((tmp_path).glob("cache/*.json")) and time.monotonic() - begin < 60:
            time.sleep(0.1)  # until the first step is planned and the second on its way
        process.send_signal(signal.SIGINT)
        _, err = process.communicate(timeout=30)
    assert (process.returncode, err) == (130, "interrupted; no result was written\n")
    assert [p.name for p in tmp_path.iterdir()] == ["cache"]
    assert all(json.loads(p.read_text()) for p in (tmp_path / "cache").iterdir())


@pytest.mark.parametrize(("presses", "kept"), [(1, ["before", "after"]), (2, ["before"])])
def test_ctrl_c_waits_for_a_report_unless_pressed_again(presses, kept):
    told: list[str] = []

    def work():
        with interruptible(lambda share: told.append("before")) as report:
            report(0.1)
            for _ in range(presses):
                signal.raise_signal(signal.SIGINT)
            told.append("after")
            report(0.2)
            told.append("never")

    with pytest.raises(KeyboardInterrupt):
        work()
    assert told == kept
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


# --- what is refused ---

BAD = [
    (["plan", "petr"], ["did you mean peter"]),
    (["plan", "missing.toml"], ["existing TOML file"]),
    (["plan", "--edge", "7"], ["command line: step.edge = 7", "1 to 6"]),
    (["plan", "--incline-deg", "95"], ["site.incline_deg = 95", "below 90"]),
    (["plan", "--incline-deg", "nan"], ["finite"]),
    (["plan", "--set", "cmg.momentum_Nms=0"], ["cmg.momentum_Nms = 0", "above 0"]),
    (["plan", "--set", "edge"], ["section.key=value"]),
    (["plan", "mission-20m"], ["mission-20m:", "rover mission"]),
    (["plan", "hedgehog", "--incline-deg", "50"], ["site.incline_deg = 50", "45 deg"]),
    (["run", "hedgehog"], ["hedgehog:", "wheels", "rover plan"]),
    (["run", "--ground", "sandy"], ["ground.file", "did you mean sand"]),
    (["run", "--initial-gimbal-deg", "inf"], ["initial.gimbal_deg", "finite"]),
    (["mission", "peter"], ["peter:", "rover plan"]),
    (
        ["mission", "--set", "mission.goal_m=[30, 30]"],
        ["mission.goal_m = [30, 30]", "known ground"],
    ),
    (["mission", "--set", "terrain.seed=-1"], ["terrain.seed = -1"]),
    (
        ["mission", "--set", "terrain.incline_deg=70"],
        ["mission-20m:", "mission.start_m", "falls by"],
    ),
    (["fly"], ["fly"]),
]


@pytest.mark.parametrize(("arguments", "says"), BAD)
def test_bad_input_is_status_2_with_one_message(arguments, says, cli, tmp_path, short_plans):
    status, out, err = cli(*arguments)
    assert (status, out) == (2, "")
    assert "Traceback" not in err and err.count("rror: ") == 1
    assert all(words in err for words in says), err
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_cannot_be_written_is_told_before_the_work(cli, tmp_path):
    (tmp_path / "file").write_text("")
    for command in ("plan", "run", "mission"):
        status, out, err = cli(command, "--out", "file")
        assert (status, out) == (2, "") and "--out" in err


@pytest.mark.parametrize("command", ["plan", "run", "mission"])
def test_without_casadi_it_says_what_to_install(command, tmp_path):
    code = "import sys; sys.modules['casadi'] = None\nfrom nullmotion.cli import main\n"
    code += f"sys.argv[1:] = ['rover', {command!r}]\nmain()"
    environment = {**os.environ, "NULLMOTION_CACHE": str(tmp_path / "cache")}
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, env=environment,
                          capture_output=True, text=True, timeout=120)  # fmt: skip
    assert (done.returncode, done.stdout) == (2, "")
    assert "pip install 'nullmotion[rover]'" in done.stderr and done.stderr.count("\n") == 1
    assert not (tmp_path / "out").exists()


def test_help_imports_nothing_heavy():
    code = "import sys; from nullmotion.cli import main; sys.argv[1:] = ['rover', 'run', '-h']\n"
    code += "heavy = ('numpy', 'scipy', 'casadi', 'nullmotion.rover')\n"
    code += "try: main()\nexcept SystemExit: print([m for m in heavy if m in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert done.stdout.strip().endswith("[]"), done.stdout + done.stderr
    assert "--initial-gimbal-deg" in done.stdout


@pytest.mark.slow
def test_progress_of_a_run_rises_to_the_end(short_plans, tmp_path, monkeypatch):
    from nullmotion.rover import files, files_mission, mission_run, rover_run

    monkeypatch.setenv("NULLMOTION_CACHE", str(tmp_path))
    told: list[float] = []
    quick = {"planner.nodes": [20, 30], "site.incline_deg": 5.0}
    rover_run.run_file(files.load_step("peter", quick), told.append)
    assert told == sorted(told) and told[-1] == pytest.approx(1.0) and len(told) > 20
    told.clear()
    mission_run.run_mission(files_mission.load_mission(TRIP), told.append)
    assert told == sorted(told) and told[-1] == pytest.approx(1.0)


def test_rovers_are_listed(capsys):
    assert guard.call(app, ["list", "rovers", "--json"]) == 0
    entries = {entry["name"]: entry for entry in json.loads(capsys.readouterr().out)}
    assert {"peter", "peter-slope", "hedgehog", "mission-20m"} <= set(entries)
    assert entries["hedgehog"]["kind"] == "rover with reaction wheels"
    assert entries["mission-20m"]["command"] == "nullmotion rover mission mission-20m"
    assert all(entry["title"] and entry["about"] for entry in entries.values())


def test_the_library_is_packaged():
    import nullmotion.rover

    folder = Path(nullmotion.rover.__file__).parent / "library"
    assert {p.suffix for p in folder.iterdir()} == {".toml"}
    assert peter().name == "PETER"
