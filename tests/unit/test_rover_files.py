"""Rover and mission files: what they hold, and what they refuse with file and line."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from nullmotion.errors import InputError
from nullmotion.rover import Gains, Rover, Settings, peter
from nullmotion.rover.files import library_names, load_step
from nullmotion.rover.files_find import find
from nullmotion.rover.files_mission import load_mission
from nullmotion.rover.files_schema import ROVER
from nullmotion.rover.mission_cost import Upkeep
from nullmotion.rover.wheels import WheelRover, hedgehog
from nullmotion.scenario.problems import ScenarioError

LEAST = """[chassis]
mass_kg = 10.0
[cmg]
momentum_Nms = 20.0
rate_limit_rad_s = 2.0
acceleration_limit_rad_s2 = 20.0
"""
TRIP = """[mission]
rover = "peter"
start_m = [2.0, 2.0]
goal_m = [8.0, 8.0]
[terrain]
size_m = [12.0, 10.0]
seed = 3
"""


# --- the library ---


def test_peter_is_table_2():
    file = load_step("peter")
    rover, cmg = file.rover, file.rover.cmg
    assert (rover.mass, rover.chassis.name, rover.friction) == (47.0, "tetrahedron", None)
    lengths = np.linalg.norm(
        rover.chassis.vertices[[0, 1]] - rover.chassis.vertices[[2, 3]], axis=1
    )
    assert lengths == pytest.approx(1.0)
    assert (cmg.momentum, cmg.rate_limit, cmg.acceleration_limit) == (115.0, 2.0, 20.0)
    assert cmg.inertia == pytest.approx([0.55, 0.45, 0.36])
    assert cmg.rotor_inertia * cmg.rotor_speed == pytest.approx(112.0)
    assert np.abs(cmg.gimbal_axis) == pytest.approx(1 / np.sqrt([2, 6, 3]))
    assert (file.site.gravity, file.site.incline, file.edge) == (3.711, 0.0, 1)
    assert cmg.axes(0.3)[2] == pytest.approx(peter().cmg.axes(0.3)[2], abs=1e-12)


def test_the_slope_of_the_library():
    file = load_step("peter-slope")
    assert file.site.incline == pytest.approx(np.radians(15))
    ground = file.ground
    assert (ground.stiffness, ground.damping, ground.drag, ground.friction) == (1e5, 1e6, 1e5, None)
    assert (file.initial_gimbal, file.threshold_share) == (0.0, 0.5)


def test_hedgehog_is_table_5():
    rover = load_step("hedgehog").rover
    assert isinstance(rover, WheelRover)
    assert (rover.mass, rover.wheel_inertia) == (18.75, 0.00095)
    assert rover.chassis.inertia == pytest.approx(18.75 * 0.25**2 / 6 * np.eye(3))
    assert rover.chassis.vertices == pytest.approx(hedgehog().chassis.vertices)


def test_the_mission_of_the_library():
    file = load_mission("mission-20m")
    assert file.terrain.size == (20.0, 20.0) and file.rover.name == "PETER"
    assert (file.start, file.goal, file.gravity) == ((2.0, 2.0), (18.0, 18.0), 3.711)
    assert file.upkeep == Upkeep.of(peter(), 50.0, 60.0, 86_400.0)


def test_every_file_of_the_library_loads():
    for name in library_names():
        load = load_mission if "mission" in find(name).data else load_step
        assert load(name).title


# --- what a file says ---


def test_what_is_left_out_has_defaults():
    file = load_step(LEAST)
    assert file.settings == Settings() and file.gains == Gains()
    assert file.ground.name == "rock" and file.initial_gimbal is None
    assert isinstance(file.rover, Rover) and file.rover.cmg.momentum == 20.0


def test_values_reach_the_objects():
    text = LEAST + (
        "[site]\ngravity_m_s2 = 1.62\nincline_deg = -8.0\nheading_deg = 90\n"
        '[step]\nedge = 3\nface = 0\nmotion = "versine"\nversine_rate_rad_s = 0.7\n'
        "[planner]\nnodes = [30, 50]\nstart_durations_s = [3]\nacceleration_rad_s2 = 4.5\n"
        "longest_s = 8.0\nbody_rate_rad_s = 1.5\n"
        "[control]\nkp = 9.0\nkd = 6.0\ngimbal = 150.0\n[initial]\ngimbal_deg = 180\n"
        "[ground]\nstiffness_N_m = 2e4\nfriction = 0.7\n"
    )
    file = load_step(text, {"cmg.gimbal_axis": [0, 0, 3], "chassis.friction": 0.8})
    assert (file.site.gravity, file.site.incline) == (1.62, pytest.approx(np.radians(-8)))
    assert file.site.vector[:2] == pytest.approx([0.0, 1.62 * np.sin(np.radians(8))], abs=1e-12)
    assert (file.edge, file.face, file.motion, file.versine_rate) == (3, 0, "versine", 0.7)
    assert file.settings == Settings((30, 50), start_durations=(3.0,), acceleration=4.5,
                                     longest=8.0, body_rate=1.5)  # fmt: skip
    assert file.gains == Gains(9.0, 6.0, 150.0)
    assert file.initial_gimbal == pytest.approx(np.pi)
    assert (file.ground.stiffness, file.ground.friction, file.ground.damping) == (2e4, 0.7, 1e6)
    assert file.rover.cmg.gimbal_axis == pytest.approx([0, 0, 1]) and file.rover.friction == 0.8


def test_a_chassis_by_its_corners():
    corners = [[x, y, z] for x in (0, 0.5) for y in (0, 0.5) for z in (0, 0.5)]
    given = {"chassis.vertices_m": corners, "chassis.mass_kg": 6.0}
    found = load_step(LEAST, given).rover.chassis
    assert found.inertia == pytest.approx(6.0 * 0.5**2 / 6 * np.eye(3))
    assert ConvexHull(found.vertices).volume == pytest.approx(0.125)
    assert found.vertices.mean(axis=0) == pytest.approx(0.0, abs=1e-12)
    named = load_step(LEAST, {"chassis.inertia_kg_m2": [0.5, 0.6, 0.7]}).rover.chassis
    assert named.inertia == pytest.approx(np.diag([0.5, 0.6, 0.7]))
    assert named.name == "tetrahedron"


def test_files_beside_a_file(tmp_path, monkeypatch):
    (tmp_path / "in").mkdir()
    (tmp_path / "in" / "dust.toml").write_text("[ground]\nstiffness_N_m = 3e4\n")
    (tmp_path / "in" / "r.toml").write_text(LEAST + '[ground]\nfile = "dust.toml"\n')
    (tmp_path / "in" / "m.toml").write_text(TRIP.replace('"peter"', '"r.toml"'))
    heights = "\n".join(",".join(["0.5"] * 41) for _ in range(41))
    (tmp_path / "in" / "h.csv").write_text(heights)
    monkeypatch.chdir(tmp_path)
    assert load_step("in/r.toml").ground.stiffness == 3e4
    assert load_mission("in/m.toml").rover.mass == 10.0
    terrain = TRIP[: TRIP.index("[terrain]")] + '[terrain]\nfile = "h.csv"\nspacing_m = 0.25\n'
    (tmp_path / "in" / "m.toml").write_text(terrain)
    field = load_mission("in/m.toml", {"terrain.origin_m": [-1, 2]}).terrain
    assert field.bounds == (-1.0, 9.0, 2.0, 12.0) and field.height(0.0, 3.0) == 0.5


def test_a_mission_changes_its_rover():
    text = TRIP + "[chassis]\nmass_kg = 50.0\n[site]\ngravity_m_s2 = 1.62\n"
    given = {"cmg.momentum_Nms": 90, "upkeep.pause_s": 5, "terrain.incline_deg": 10}
    file = load_mission(text, given)
    assert (file.rover.mass, file.rover.cmg.momentum, file.gravity) == (50.0, 90.0, 1.62)
    assert file.upkeep == Upkeep.of(file.rover, 50.0, 5.0)
    assert file.terrain.mean_normal()[0] == pytest.approx(-np.sin(np.radians(10)), abs=0.08)
    alone = load_mission(TRIP.replace('rover = "peter"\n', "") + LEAST)
    assert (alone.rover.mass, alone.gravity) == (10.0, 3.711)


# --- what is refused ---

BAD = [
    ("chassis.shape", "tetrahedrn", "did you mean tetrahedron"),
    ("chassis.edge_length_m", 0.0, "above 0"),
    ("chassis.mass_kg", "47", "a number"),
    ("chassis.inertia_kg_m2", [1.0, 1.0, 5.0], "principal moments"),
    ("chassis.vertices_m", [[0, 0, 0], [1, 0, 0]], "at least 4"),
    ("cmg.momentum_Nms", -1.0, "above 0"),
    ("cmg.mometum_Nms", 1.0, "did you mean momentum_Nms"),
    ("cmg.rate_limit_deg_s", 90.0, "rate_limit_rad_s"),
    ("cmg.gimbal_axis", [0, 0, 0], "not zero"),
    ("cmg.gimbal_axis", [0, 0], "3 numbers (this has 2)"),
    ("site.incline_deg", 90.0, "below 90"),
    ("site.incline_deg", float("nan"), "finite"),
    ("site.gravity_m_s2", 0, "above 0"),
    ("step.edge", 7, "1 to 6"),
    ("step.edge", 1.5, "whole number"),
    ("step.face", 2, "face at edge 1: 0 or 3"),
    ("step.motion", "jump", "'planned' or 'versine'"),
    ("planner.nodes", [5, 6], "at least 10"),
    ("planner.longest_s", 0.4, "above the shortest"),
    ("planner.authority", 1.0, "below 1"),
    ("control.kp", 0, "above 0"),
    ("initial.threshold_share", 2.0, "at most 1"),
    ("ground.stiffness_N_m", 1e20, "1e+12"),
    ("ground.file", "sandy", "did you mean sand"),
    ("ground.file", "missing.toml", "existing TOML file"),
    ("step", 3, "a section with keys"),
    ("stp.edge", 1, "unknown section; did you mean step"),
]


@pytest.mark.parametrize(("key", "value", "said"), BAD)
def test_bad_values_are_told(key, value, said):
    with pytest.raises(ScenarioError, match=r"^--set: ") as caught:
        load_step("peter", {key: value})
    words = str(caught.value)
    assert said in words and key.partition(".")[0] in words


def test_what_does_not_go_together():
    for key, value in (
        ("wheels.inertia_kg_m2", 0.1),
        ("chassis.vertices_m", [[1, 0, 0], [0, 1, 0], [0, 0, 1], [-1, -1, -1]]),
    ):
        with pytest.raises(ScenarioError, match="not beside"):
            load_step("peter", {key: value})
    with pytest.raises(ScenarioError, match=r"ground\.friction = 0.5: not beside file"):
        load_step("peter", {"ground.file": "sand", "ground.friction": 0.5})
    with pytest.raises(ScenarioError, match="own inertia"):
        load_step("hedgehog", {"wheels.inertia_kg_m2": 1.0})


def test_file_and_line(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "r.toml").write_text(LEAST.replace("20.0\n", "-20.0\n") + "[step]\nedge = 9\n")
    with pytest.raises(ScenarioError) as caught:
        load_step("r.toml")
    assert [p.where for p in caught.value.problems] == ["r.toml:4", "r.toml:6"]
    (tmp_path / "r.toml").write_text("[chassis]\nmass_kg = 3.0\nmass = 3\n")
    with pytest.raises(ScenarioError) as caught:
        load_step("r.toml")
    told = str(caught.value)
    assert "r.toml:3: chassis.mass = 3: unknown key; did you mean mass_kg" in told
    assert "cmg: this section is missing" in told
    (tmp_path / "r.toml").write_text("[chassis\n")
    with pytest.raises(ScenarioError, match=r"r\.toml:1"):
        load_step("r.toml")


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        (("goal_m", "gaol_m"), "did you mean goal_m"),
        (("goal_m = [8.0, 8.0]\n", ""), "mission.goal_m: this key is missing"),
        (("[8.0, 8.0]", "[8.0]"), r"2 numbers \(this has 1\)"),
        (('"peter"', '"petr"'), "did you mean peter"),
        (('"peter"', '"hedgehog"'), "a rover with a CMG"),
        (('rover = "peter"\n', ""), r"mission\.rover: .*missing"),
        (("seed = 3", "seed = -3"), "at least 0"),
        (("seed = 3", "shortest_m = 0.1"), r"text:\d+: terrain.shortest_m = 0.1: from 0.5"),
        (("seed = 3", 'file = "h.csv"'), "terrain.size_m.*not beside file"),
        (("size_m = [12.0, 10.0]\nseed = 3", 'file = "h.csv"'), "terrain.file.*existing file"),
        (("seed = 3", "origin_m = [1.0, 2.0]"), "only beside file"),
        (("[terrain]", "[terrian]"), "did you mean terrain"),
        (("seed = 3", "seed = 3\n[chassis]\nmass_kg = -3"), "chassis.mass_kg = -3: above 0"),
        (("seed = 3", 'seed = 3\n[chassis]\nshape = "cube"'), "regular tetrahedron"),
        (("seed = 3", "seed = 3\n[site]\nincline_deg = 3"), "allowed: gravity_m_s2"),
        (("seed = 3", "seed = 3\n[upkeep]\npower_W = -1"), "at least 0"),
    ],
)
def test_bad_missions_are_told(changed, said):
    assert changed[0] in TRIP
    with pytest.raises(ScenarioError, match=said) as caught:
        load_mission(TRIP.replace(*changed))
    assert caught.value.where


def test_the_line_of_a_terrain_that_cannot_be_read(tmp_path):
    (tmp_path / "h.csv").write_text("0,0,0\n0,x,0\n")
    (tmp_path / "m.toml").write_text(
        TRIP[: TRIP.index("[terrain]")] + '[terrain]\nfile = "h.csv"\nspacing_m = 1.0\n'
    )
    with pytest.raises(InputError, match=r"h\.csv:2"):
        load_mission(tmp_path / "m.toml")
    (tmp_path / "h.csv").write_text("0,0\n0,0\n")
    text = (tmp_path / "m.toml").read_text()
    (tmp_path / "m.toml").write_text(text.replace("spacing_m = 1.0\n", ""))
    with pytest.raises(ScenarioError, match=r"m\.toml:5: terrain.spacing_m: a length above 0"):
        load_mission(tmp_path / "m.toml")


def test_one_kind_of_file_for_the_other():
    with pytest.raises(ScenarioError, match="rover mission"):
        load_step("mission-20m")
    with pytest.raises(ScenarioError, match="rover plan"):
        load_mission("peter")
    for name, said in (("petr", "did you mean peter"), ("a/b.toml", "existing TOML file")):
        with pytest.raises(InputError, match=said):
            load_step(name)


def test_nothing_but_one_kind_of_error(rng):
    values = [-1, 0, 1e300, float("inf"), "x", True, [], [1], [1, 2, 3], [[1]], {"a": 1}, ""]
    for name, model in ROVER.items():
        for key in model.model_fields:
            for value in values:
                try:
                    load_step("peter", {f"{name}.{key}": value})
                except InputError as error:
                    assert str(error)  # noqa: PT017
