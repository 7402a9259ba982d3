"""Ground, lattice, costs and paths of a rolling tetrahedron."""

from __future__ import annotations

import dataclasses
import json
import time

import numpy as np
import pytest
from scipy.interpolate import RegularGridInterpolator
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra
from scipy.spatial.transform import Rotation

from nullmotion.errors import InputError
from nullmotion.rover.chassis import Chassis
from nullmotion.rover.mission_cost import Upkeep
from nullmotion.rover.path import STEEPEST, find_path
from nullmotion.rover.path_cost import PlannedStep, StepCosts, StepTable
from nullmotion.rover.path_graph import slopes, step_graph
from nullmotion.rover.path_kinds import kinds
from nullmotion.rover.path_lattice import Lattice, steps_between
from nullmotion.rover.path_mission import travel
from nullmotion.rover.path_plans import CROSSES, PITCHES, covering, planner, site, step_table
from nullmotion.rover.path_roll import first_footprint, rolled
from nullmotion.rover.path_search import shortest
from nullmotion.rover.path_store import StepStore, digest
from nullmotion.rover.planner import plan_step
from nullmotion.rover.rover import MARS, Rover, peter
from nullmotion.rover.terrain import HeightField
from nullmotion.rover.terrain_files import load_terrain, save_terrain
from nullmotion.rover.terrain_random import generated


def invented(edge, face, pitch, cross, progress=None):
    """A planner at once: no step beyond 50 deg."""
    if np.hypot(pitch, cross) > np.radians(50):
        return None
    return PlannedStep(150.0 + 40 * edge + 300 * pitch**2, 4.0 + cross, 60.0 - 20 * pitch)


@pytest.fixture
def table():
    return step_table(peter(), MARS, PITCHES, CROSSES, plan=invented, store=StepStore())


def uneven(a, b, pitch, cross):
    """A cost that differs between edges, directions and slopes."""
    energy = 100.0 + 7 * a + 13 * b + 200 * np.maximum(pitch, 0) + 90 * cross**2
    return StepCosts(np.where(pitch < 0.4, energy, np.inf), 3 + pitch, 50 - 10 * pitch)


# --- ground ---


def test_heights_between_points(rng):
    z = rng.normal(size=(7, 9))
    field = HeightField(z, 0.5, (3.0, -1.0))
    x, y = np.arange(9) * 0.5 + 3, np.arange(7) * 0.5 - 1
    truth = RegularGridInterpolator((y, x), z)
    points = np.column_stack([rng.uniform(3, 7, 200), rng.uniform(-1, 2, 200)])
    assert field.height(*points.T) == pytest.approx(truth(points[:, ::-1]))
    assert field.height(x[None, :], y[:, None]) == pytest.approx(z)
    assert np.isnan(field.height([2.9, 7.1, 5.0], [0.0, 0.0, 2.1])).all()
    assert field.bounds == (3.0, 7.0, -1.0, 2.0)


def test_slopes_and_mean_plane_of_an_incline():
    field = generated(12.0, rms_slope=0.0, incline=0.3, heading=0.7, spacing=0.5)
    assert field.slopes() == pytest.approx(0.3)
    n = field.mean_normal()
    assert np.arccos(n[2]) == pytest.approx(0.3)
    assert np.arctan2(-n[1], -n[0]) == pytest.approx(0.7)


def test_generated_ground_is_as_asked_for():
    field = generated((20.0, 14.0), seed=4, rms_slope=np.radians(15), spacing=0.25)
    assert field.heights.shape == (57, 81) and field.size == (20.0, 14.0)
    assert np.sqrt(np.mean(np.tan(field.slopes()) ** 2)) == pytest.approx(np.tan(np.radians(15)))
    assert np.degrees(field.slopes()).max() > 25 and np.degrees(field.slopes()).min() < 3
    assert (
        field.heights == generated((20.0, 14.0), seed=4, rms_slope=np.radians(15)).heights
    ).all()
    assert (field.heights != generated((20.0, 14.0), seed=5).heights).any()
    # no wave shorter than asked for: what two points a quarter wave apart differ by is smooth
    bends = np.abs(np.diff(field.heights, 2, axis=1)).max() / 0.25**2
    assert bends < (2 * np.pi / 4.0) * np.tan(field.slopes().max()) * 1.5


@pytest.mark.parametrize(
    ("key", "options"),
    [
        ("terrain.size_m", {"size": -3.0}),
        ("terrain.spacing_m", {"spacing": 0.0}),
        ("terrain.spacing_m", {"size": 5000.0}),
        ("terrain.rms_slope_deg", {"rms_slope": 2.0}),
        ("terrain.shortest_m", {"shortest": 0.1}),
        ("terrain.hurst", {"hurst": np.nan}),
        ("terrain.seed", {"seed": -1}),
    ],
)
def test_ground_that_cannot_be_made(key, options):
    with pytest.raises(InputError) as caught:
        generated(**options)
    assert caught.value.key == key


def test_ground_from_files(tmp_path, rng):
    z = rng.normal(size=(4, 5))
    z[1, 2] = np.nan
    np.savetxt(tmp_path / "a.csv", z, delimiter=",", header="metres")
    np.save(tmp_path / "a.npy", z)
    save_terrain(HeightField(z, 0.5, (1.0, 2.0)), tmp_path / "a.npz")
    for name, spacing in (("a.csv", 0.5), ("a.npy", 0.5), ("a.npz", None)):
        field = load_terrain(tmp_path / name, spacing)
        assert field.heights == pytest.approx(z, nan_ok=True) and field.spacing == 0.5
        assert field.origin == ((1.0, 2.0) if spacing is None else (0.0, 0.0))
    (tmp_path / "gap.csv").write_text("1, 2\n,4\n")
    assert np.isnan(load_terrain(tmp_path / "gap.csv", 1.0).heights[1, 0])


@pytest.mark.parametrize(
    ("name", "content", "said"),
    [
        ("a.csv", b"1,2\n3,x\n", r"a\.csv:2.*'x'.*height"),
        ("a.csv", b"1,2\n3\n", r"a\.csv:2.*2 heights in every row"),
        ("a.csv", b"1,2\n3,inf\n", "finite"),
        ("a.csv", b"1,2\n", "2 rows"),
        ("a.csv", b"", "2 rows"),
        ("a.csv", b"\xff\xfe1", "UTF-8"),
        ("a.npy", b"junk", "NumPy"),
        ("a.npz", b"junk", "NumPy"),
        ("a.txt", b"1", r"\.csv, \.npy or \.npz"),
    ],
)
def test_files_that_are_no_ground(tmp_path, name, content, said):
    (tmp_path / name).write_bytes(content)
    with pytest.raises(InputError, match=said):
        load_terrain(tmp_path / name, 1.0)


def test_files_that_lack_something(tmp_path):
    with pytest.raises(InputError, match="existing file"):
        load_terrain(tmp_path / "none.csv", 1.0)
    np.save(tmp_path / "a.npy", np.zeros((3, 3)))
    with pytest.raises(InputError, match="spacing_m"):
        load_terrain(tmp_path / "a.npy")
    np.save(tmp_path / "a.npy", np.array([["a", "b"]]))
    with pytest.raises(InputError, match="real numbers"):
        load_terrain(tmp_path / "a.npy", 1.0)
    np.savez(tmp_path / "a.npz", heights=np.zeros((3, 3)))
    with pytest.raises(InputError, match="spacing"):
        load_terrain(tmp_path / "a.npz")


# --- lattice ---


def test_a_rolling_tetrahedron_keeps_to_the_lattice(rng):
    """Turn a real tetrahedron about its edges and see which corner comes down where."""
    chassis = Chassis.named("tetrahedron")
    lattice = Lattice.laid(1.0, (0.3, -0.2), 0.4)
    cell = np.zeros(3, int)
    points = lattice.corners(cell)
    body, _ = Rotation.align_vectors([[np.cos(0.4), np.sin(0.4), 0], [0, 0, 1]], np.eye(3)[[0, 2]])
    place = body.apply(chassis.vertices)
    place += np.array([*points.mean(axis=0), -place[:, 2].min()])
    for _ in range(60):
        feet, left = lattice.feet(cell), int(rng.integers(3))
        down = np.flatnonzero(np.abs(place[:, 2]) < 1e-9)
        assert set(feet) == set(down) and lattice.top(cell) not in down
        assert place[feet, :2] == pytest.approx(lattice.corners(cell), abs=1e-9)
        a, b = place[feet[(left + 1) % 3]], place[feet[(left + 2) % 3]]
        turn = Rotation.from_rotvec((b - a) * (np.pi - np.arccos(1 / 3)))
        place = a + turn.apply(place - a)
        cell = lattice.behind(cell)[left]


def test_cells_hold_their_middles(rng):
    lattice = Lattice.laid(0.8, (5.0, 4.0), 1.0, np.array([0.3, 0.1, 0.9]) / np.sqrt(0.91))
    cells = np.column_stack([rng.integers(-9, 9, (40, 2)), rng.integers(0, 2, 40)])
    for cell in cells:
        assert (lattice.cell_at(tuple(lattice.middles(cell))) == cell).all()
    assert (lattice.cell_at((5.0, 4.0)) == 0).all()


def test_least_number_of_steps_by_counting():
    lattice, field = Lattice.laid(1.0, (6.0, 6.0)), HeightField(np.zeros((13, 13)), 1.0)
    graph = step_graph(field, lattice, lambda a, b, p, c: StepCosts(p * 0 + 1, p, p), STEEPEST)
    start = graph.number(np.zeros(3, int))
    rows = np.repeat(np.arange(len(graph.cells)), 3)
    there = graph.following.ravel() >= 0
    links = csr_array((np.ones(there.sum()), (rows[there], graph.following.ravel()[there])))
    counted = dijkstra(links, indices=start)
    least = steps_between(graph.cells, graph.cells[[start]])
    near = np.isfinite(counted) & (counted < 8)  # the border bends longer ways
    assert near.sum() > 50 and least[near] == pytest.approx(counted[near])
    assert (least <= counted).all()


def test_slopes_of_an_incline_from_every_side():
    tilt = Rotation.from_rotvec([0.0, -0.3, 0.0])  # rises by 0.3 rad towards +x
    flat = np.array([[0, 0, 0], [1, 0, 0], [0.5, np.sqrt(0.75), 0]])
    for heading in np.radians([0, 25, 90, 140]):
        turn = Rotation.from_rotvec([0, 0, heading])
        pitch, cross = slopes(tilt.apply(turn.apply(flat)))
        out = turn.apply(np.roll(flat, -1, 0) + np.roll(flat, -2, 0) - 2 * flat.mean(axis=0))
        way = np.arctan2(out[:, 1], out[:, 0])
        assert pitch == pytest.approx(np.arctan(np.tan(0.3) * np.cos(way)))
        assert np.sin(cross) == pytest.approx(-np.sin(0.3) * np.sin(way), abs=1e-12)
        for p, c in zip(pitch, cross, strict=True):  # and back to the planner's site
            vector = site(MARS, p, c).vector / MARS
            assert np.arctan2(-vector[0], -vector[2]) == pytest.approx(p)
            assert -vector[1] == pytest.approx(np.sin(c))


# --- costs ---


def test_peter_has_two_kinds_of_steps():
    rover = peter()
    found = kinds(rover)
    assert [found.name(k) for k in range(2)] == ["e1", "e2"]
    for edge, (a, b) in enumerate(rover.chassis.edges, 1):
        assert found.of[a, b] == found.of[b, a] == (1 if edge in (2, 5) else 0)
    odd = dataclasses.replace(rover.cmg, gimbal_axis=np.array([0.9, 0.2, 0.4]))
    assert len(kinds(Rover(rover.chassis, odd)).examples) > 4


def test_only_tetrahedra_keep_to_a_triangular_lattice():
    cmg = peter().cmg
    cube = Rover(Chassis.named("cube", 1.0, 47.0), cmg)
    with pytest.raises(InputError, match="tetrahedron"):
        kinds(cube)
    points = Chassis.named("tetrahedron", 1.0, 47.0).vertices * [1.0, 1.0, 1.1]
    with pytest.raises(InputError, match="tetrahedron"):
        kinds(Rover(Chassis.uniform(points, 47.0), cmg))
    with pytest.raises(InputError, match="tetrahedron"):
        travel(HeightField(np.zeros((9, 9)), 1.0), cube, (2, 2), (6, 6))


def test_costs_between_planned_steps(rng):
    pitches, crosses = np.radians([-30.0, 0.0, 25.0]), np.radians([0.0, 20.0])
    values = rng.uniform(50, 90, (3, 2, 3, 2))
    of = kinds(peter()).of
    table = StepTable(of, pitches, *values, 30.0, crosses)
    a, b = np.array([[i, j] for i in range(4) for j in range(4) if i != j] * 30).T
    pitch, cross = rng.uniform(-0.5, 0.4, len(a)), rng.uniform(-0.34, 0.34, len(a))
    found = table(a, b, pitch, cross)
    for k in range(2):
        here = of[a, b] == k
        at = np.column_stack([pitch, np.abs(cross)])[here]
        for got, known in zip(found, values, strict=True):
            truth = RegularGridInterpolator((pitches, crosses), known[k])
            assert got[here] == pytest.approx(truth(at))


def test_steps_are_refused_beyond_what_was_planned(table):
    def energy(pitch, cross=0.0):
        one = np.ones(1, int)
        return table(0 * one, one, np.radians(pitch) * one, np.radians(cross) * one).energy[0]

    assert np.isfinite([energy(0), energy(45), energy(-45), energy(45, 5), energy(38, 20)]).all()
    assert np.isinf([energy(46), energy(-46), energy(45, 30), energy(60), energy(40, 38)]).all()
    # three of the four slopes around have a step: the plane through them counts
    planned = [invented(1, 0, *np.radians(at)).energy for at in ((30, 20), (45, 20), (30, 40))]
    assert energy(33, 24) == pytest.approx(
        planned[0] + 0.2 * (planned[1] - planned[0]) + 0.2 * (planned[2] - planned[0])
    )


def test_weight_on_one_spike_takes_margin():
    flat = np.full((1, 1, 1), 50.0)
    table = StepTable(np.array([[-1, 0], [0, -1]]), np.zeros(1), flat, flat, flat, 100.0)
    ask = np.zeros(1, int), np.ones(1, int), np.zeros(1)
    assert table(*ask, np.array([-0.3])).margin == pytest.approx(50 - 100 * np.sin(0.3))
    assert np.isfinite(table(*ask, np.array([0.5])).energy).all()
    assert np.isinf(table(*ask, np.array([0.53])).energy).all()
    assert np.isinf(table(ask[0], ask[0], np.zeros(1), np.zeros(1)).energy).all()


@pytest.mark.parametrize(
    ("key", "change"),
    [
        ("pitches", {"pitches": np.array([0.0, 0.0])}),
        ("crosses", {"crosses": np.array([0.1])}),
        ("time", {"time": np.zeros((1, 2, 2))}),
        ("energy", {"energy": np.full((1, 2, 1), -1.0)}),
    ],
)
def test_tables_that_do_not_fit(key, change):
    one = np.ones((1, 2, 1))
    given = {"pitches": np.array([0.0, 0.2]), "energy": one, "time": one, "margin": one}
    with pytest.raises(InputError, match=f"rover.{key}"):
        StepTable(np.zeros((4, 4), int), **given | change, weight_moment=1.0)


def test_slopes_that_a_ground_needs():
    assert covering(0.1, PITCHES) == pytest.approx(np.radians([0, 15]))
    assert len(covering(np.radians(45), PITCHES)) == 4
    assert len(covering(1.5, PITCHES)) == len(PITCHES)
    with pytest.raises(InputError, match="rover.pitches"):
        step_table(peter(), pitches=[0.1, 0.2], plan=invented, store=StepStore())


def test_planned_steps_are_kept(tmp_path):
    calls, shares = [], []

    def plan(*step):
        calls.append(step[:4])
        return invented(*step)

    path = tmp_path / "new" / "steps.json"
    options = {"plan": plan, "pitches": PITCHES, "crosses": CROSSES}
    first = step_table(peter(), store=StepStore(path), progress=shares.append, **options)
    assert len(calls) == 2 * len(PITCHES) * len(CROSSES) and shares[-1] == 1.0
    second = step_table(peter(), store=StepStore(path), **options)
    assert len(calls) == 2 * len(PITCHES) * len(CROSSES)
    assert (np.isnan(first.energy) == np.isnan(second.energy)).all()
    assert np.nan_to_num(first.energy) == pytest.approx(np.nan_to_num(second.energy), rel=1e-15)
    assert None in json.loads(path.read_text()).values()
    path.write_text("{broken")
    step_table(peter(), store=StepStore(path), **options)
    assert len(calls) == 4 * len(PITCHES) * len(CROSSES)


def test_what_was_planned_before_an_interrupt_is_kept(tmp_path):
    def plan(edge, face, pitch, cross, progress):
        if pitch > 0.3:
            raise KeyboardInterrupt
        return invented(edge, face, pitch, cross)

    path = tmp_path / "steps.json"
    with pytest.raises(KeyboardInterrupt):
        step_table(peter(), plan=plan, store=StepStore(path))
    assert len(json.loads(path.read_text())) == 2


def test_plans_are_told_apart(monkeypatch, tmp_path):
    rover = peter()
    heavier = Rover(dataclasses.replace(rover.chassis, mass=47.1), rover.cmg)
    faster = Rover(rover.chassis, dataclasses.replace(rover.cmg, rate_limit=2.5))
    found = {digest(r, g) for r in (rover, heavier, faster) for g in (3.7, 9.8)}
    assert len(found) == 6 and digest(peter(), 3.7) in found
    monkeypatch.setenv("NULLMOTION_CACHE", str(tmp_path))
    assert StepStore.of(rover, 3.7).path.parent == tmp_path


# --- search ---


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("power", [0.0, 50.0])
def test_the_best_path_is_dijkstras(seed, power):
    field = generated(20.0, seed=seed, rms_slope=np.radians(16))
    field.heights[30:50, 35:38] = np.nan
    lattice = Lattice.laid(1.0, (2.5, 2.5), 0.3 * seed, field.mean_normal())
    graph = step_graph(field, lattice, uneven, STEEPEST)
    goal = (17.0, 16.0)
    path = find_path(field, lattice, uneven, goal, power=power, pause=20.0)
    weights = graph.steps.energy + power * (20.0 + graph.steps.time)
    there = (graph.following >= 0) & np.isfinite(weights)
    rows = np.nonzero(there)[0]
    size = (len(graph.cells),) * 2
    links = csr_array((weights[there], (rows, graph.following[there])), shape=size)
    start, end = graph.number(np.zeros(3, int)), graph.number(lattice.cell_at(goal))
    truth = dijkstra(links, indices=start)
    assert path.cost == pytest.approx(truth[end], rel=1e-12)
    assert path.cost == pytest.approx(float((path.energy + power * (20 + path.time)).sum()))
    assert path.expanded < len(graph.cells)
    # its steps are the lattice's, each from where the last one led
    for k, left in enumerate(path.left):
        assert (lattice.behind(path.cells[k])[left] == path.cells[k + 1]).all()
    assert np.isfinite(path.corners).all() and len(path.edges) == len(path.left)


def test_search_on_any_graph(rng):
    following = rng.integers(-1, 300, (300, 4))
    weights = np.where(rng.random((300, 4)) < 0.2, np.inf, rng.uniform(0, 5, (300, 4)))
    rows, columns = np.nonzero(np.isfinite(weights) & (following >= 0))
    least = np.full((300, 300), np.inf)
    np.minimum.at(least, (rows, following[rows, columns]), weights[rows, columns])
    truth = dijkstra(np.where(np.isfinite(least), least, 0.0), indices=0)
    for goal in range(1, 300, 7):
        found = shortest(following, weights, 0, np.arange(300) == goal, np.zeros(300, int))
        assert found.cost == pytest.approx(truth[goal])
        assert bool(found.nodes) == np.isfinite(truth[goal])


def test_nearest_of_several_goals():
    field, lattice = HeightField(np.zeros((21, 21)), 1.0), Lattice.laid(1.0, (4.0, 4.0))
    near = find_path(field, lattice, uneven, (14.0, 14.0), within=3.0)
    far = find_path(field, lattice, uneven, (14.0, 14.0))
    assert len(near.left) < len(far.left)
    assert np.linalg.norm(near.middles[-1, :2] - 14.0) <= 3.0
    none = find_path(field, lattice, uneven, (4.0, 4.0))
    assert len(none.left) == 0 and none.cost == 0.0 and none.length == 0.0


def test_barred_steps_are_not_made():
    field, lattice = HeightField(np.zeros((21, 21)), 1.0), Lattice.laid(1.0, (4.0, 4.0))
    first = find_path(field, lattice, uneven, (14.0, 14.0))
    way = first.middles[0, :2], first.middles[1, :2]
    other = find_path(field, lattice, uneven, (14.0, 14.0), barred=[way])
    assert other.left[0] != first.left[0] and other.cost >= first.cost


def wall(gap):
    z = np.zeros((81, 81))
    z[gap:, 40:43] = np.nan
    return HeightField(z, 0.25)


@pytest.mark.parametrize(
    ("field", "start", "goal", "said"),
    [
        (wall(0), (2, 2), (18, 18), r"goal_m.*\d+ of \d+ footprints, the nearest \d"),
        (wall(40), (2, 2), (10.3, 18), "goal_m.*known ground"),
        (wall(40), (10.3, 18), (2, 2), "start_m.*known ground"),
        (wall(40), (2, 2), (40, 2), "goal_m.*known ground"),
        (generated(20.0, rms_slope=0.0, incline=1.25), (2, 2), (18, 18), r"start_m.*\d+ deg"),
    ],
)
def test_ways_that_are_refused(table, field, start, goal, said):
    with pytest.raises(InputError, match=said):
        travel(field, peter(), start, goal, cost=table)


def test_values_that_no_trip_has(table):
    field = HeightField(np.zeros((21, 21)), 1.0)
    for key, given in (
        ("mission.start_m", {"start": (np.nan, 2.0)}),
        ("mission.goal_m", {"goal": (1.0, 2.0, 3.0)}),
        ("gravity", {"gravity": 0.0}),
        ("mission.drift", {"drift": 0.0}),
    ):
        with pytest.raises(InputError) as caught:
            travel(field, peter(), **{"start": (5, 5), "goal": (9, 9), "cost": table} | given)
        assert caught.value.key == key


def test_too_much_ground():
    field = HeightField(np.zeros((2001, 2001)), 1.0)
    with pytest.raises(InputError, match="larger rover"):
        find_path(field, Lattice.laid(0.5, (9.0, 9.0)), uneven, (20.0, 20.0))


# --- rolling ---


def test_a_rigid_tetrahedron_on_uneven_ground(rng):
    field = generated(30.0, seed=2, rms_slope=np.radians(20))
    cell = Lattice.laid(1.0, (15.0, 15.0), 0.2).corners(np.zeros(3, int))
    corners = first_footprint(field, cell, 1.0)
    for _ in range(40):
        assert corners[:, 2] == pytest.approx(field.height(*corners[:, :2].T), abs=1e-9)
        sides = np.linalg.norm(corners - np.roll(corners, 1, axis=0), axis=1)
        assert sides == pytest.approx([1.0] * 3)
        n = np.cross(corners[1] - corners[0], corners[2] - corners[0])
        assert n[2] > 0
        left = int(rng.integers(3))
        landing = rolled(field, corners, left)
        assert landing is not None
        # the spike that was up, turned about the edge by the angle told, is where it landed
        top = corners.mean(axis=0) + n / np.linalg.norm(n) * np.sqrt(2 / 3)
        a, b = corners[(left + 1) % 3], corners[(left + 2) % 3]
        turned = Rotation.from_rotvec(landing.turn * (b - a)).apply(top - a) + a
        assert landing.corners[left] == pytest.approx(turned, abs=1e-8)
        before = Rotation.from_rotvec((landing.turn - 0.1) * (b - a)).apply(top - a) + a
        assert before[2] > field.height(*before[:2])
        corners = landing.corners


def test_ground_that_falls_away():
    field = HeightField(np.where(np.arange(41) > 20, np.nan, 0.0) * np.ones((41, 1)), 0.25)
    cell = Lattice.laid(1.0, (4.4, 5.0)).corners(np.zeros(3, int))
    corners = first_footprint(field, cell, 1.0)
    results = [rolled(field, corners, left) for left in range(3)]
    assert any(r is None for r in results) and any(r is not None for r in results)


# --- trips ---


def test_a_trip_on_level_ground(table):
    care = Upkeep(power=10.0, pause=30.0, spin_up_time=100.0, rotor_energy=7.0)
    field = HeightField(np.zeros((81, 81)), 0.25)
    found = travel(field, peter(), (2.0, 2.0), (18.0, 16.0), cost=table, upkeep=care)
    n = found.steps
    assert found.turn == pytest.approx(np.full(n, np.pi - np.arccos(1 / 3)))
    assert found.distance == pytest.approx(n / np.sqrt(3))
    assert found.drift < 1e-9 and found.searches == 1 and found.miss <= 1 / np.sqrt(3)
    assert found.corners == pytest.approx(found.path.corners, abs=1e-9)
    assert (found.feet == found.path.feet).all() and (found.edges == found.path.edges).all()
    of = kinds(peter()).of[tuple(found.edges.T)]
    energy = float(np.where(of == 0, 190.0, 230.0).sum())
    assert found.step_energy == pytest.approx(energy)
    total = energy + 10.0 * (34.0 * n) + 1000.0 + 7.0
    assert found.cost_of_travel == pytest.approx(total / 47.0 / found.distance)
    assert found.duration == pytest.approx(34.0 * n)
    assert found.summary()["steps"] == n


@pytest.mark.parametrize("slope", [8.0, 16.0, 22.0])
def test_trips_over_uneven_ground(table, slope):
    shares = []
    field = generated(20.0, seed=7, rms_slope=np.radians(slope))
    found = travel(field, peter(), (2.0, 3.0), (18.0, 17.0), cost=table, progress=shares.append)
    assert found.corners[..., 2] == pytest.approx(
        field.height(found.corners[..., 0], found.corners[..., 1]), abs=1e-9
    )
    assert found.miss < 1 / np.sqrt(3) + 0.5 and (found.margin >= 0).all()
    assert shares[-1] == 1.0 and (np.diff(shares) >= 0).all()
    pitch, cross = slopes(found.corners[:-1])
    rows = np.arange(found.steps)
    assert found.pitch == pytest.approx(pitch[rows, found.left])
    assert found.cross == pytest.approx(cross[rows, found.left])
    # a foot stays where it is over the two steps that it takes part in
    for k in range(found.steps):
        kept = [(found.left[k] + i) % 3 for i in (1, 2)]
        assert found.corners[k, kept] == pytest.approx(found.corners[k + 1, kept[::-1]])
        assert (found.feet[k, kept] == found.feet[k + 1, kept[::-1]]).all()


def test_round_a_wall_and_up_a_hill(table):
    found = travel(wall(60), peter(), (2.0, 17.0), (18.0, 17.0), cost=table)
    assert found.middles[:, 1].min() < 15.1 and found.distance > 17.0
    hill = generated(20.0, seed=3, incline=np.radians(35), rms_slope=np.radians(6))
    up = travel(hill, peter(), (2.0, 2.0), (18.0, 18.0), cost=table)
    assert up.miss < 1.1 and np.degrees(up.pitch.max()) > 30 and up.searches > 1


def test_no_way_at_all_costs_nothing(table):
    field = HeightField(np.zeros((21, 21)), 1.0)
    found = travel(field, peter(), (5.0, 5.0), (5.1, 5.0), cost=table)
    assert found.steps == 0 and np.isnan(found.cost_of_travel) and found.summary()["steps"] == 0


def test_an_interrupt_ends_a_trip(table):
    def stop(share):
        if share > 0.5:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        travel(generated(20.0), peter(), (2, 2), (18, 18), cost=table, progress=stop)


@pytest.mark.slow
def test_a_mission_from_start_to_goal(tmp_path, monkeypatch):
    monkeypatch.setenv("NULLMOTION_CACHE", str(tmp_path))
    rover, shares, begin = peter(), [], time.monotonic()
    field = generated(20.0, seed=11)
    found = travel(field, rover, (2.0, 2.0), (18.0, 18.0), progress=shares.append)
    assert time.monotonic() - begin < 120.0
    assert shares[-1] == 1.0 and (np.diff(shares) >= 0).all() and len(shares) > 100
    assert found.miss < 0.9 and found.straight > 21.0 and found.margin.min() > 10.0
    assert 4.0 < found.step_cost < 14.0  # Table 4 has 5.6 to 19.2
    assert found.cost_of_travel > found.step_cost
    # one step of it, planned for the very slope under the rover
    k = int(np.argmax(found.pitch))
    edge = next(
        j for j, pair in enumerate(rover.chassis.edges, 1) if set(pair) == set(found.edges[k])
    )
    plan = plan_step(rover, edge, site(MARS, found.pitch[k], found.cross[k]))
    assert plan.least_margin > 0
    again = travel(field, rover, (2.0, 2.0), (18.0, 18.0))
    assert (again.left == found.left).all()


@pytest.mark.slow
@pytest.mark.parametrize(("edge", "pitch", "cross"), [(1, 20.0, 0.0), (2, 20.0, 10.0)])
def test_downhill_and_mirrored_steps_have_the_same_margin(edge, pitch, cross):
    """The solver's optimum scatters by a few per cent; the symmetry itself is exact."""
    plan, rover = planner(peter(), MARS), peter()
    low, high = rover.chassis.faces_at(edge)
    angles = np.radians([pitch, cross])
    cases = [(low, 1, 1), (low, -1, 1), (high, 1, -1)]
    found = [plan(edge, face, up * angles[0], side * angles[1], None) for face, up, side in cases]
    margins = [step.margin for step in found]
    assert margins == pytest.approx([margins[0]] * 3, rel=0.03)


def test_the_planner_finds_no_step_where_the_rover_would_not_stay():
    assert planner(peter(), MARS)(1, 0, np.radians(54.9), 0.0, None) is None
    assert planner(peter(), MARS)(2, 0, np.radians(45), np.radians(45), None) is None
