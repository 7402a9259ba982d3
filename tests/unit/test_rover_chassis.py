"""Chassis: platonic solids, frames of steps, Eq 68."""

from __future__ import annotations

import numpy as np
import pytest

from nullmotion.errors import InputError, UnknownNameError
from nullmotion.rover import Chassis, Cmg, Rover, Site, peter
from nullmotion.rover.polyhedron import NAMES

GOLDEN = (1 + 5**0.5) / 2
# corners, faces, edges; steepest slope it stands on (Table 8); inertia over M L^2 (textbooks)
SOLIDS = {
    "tetrahedron": (4, 4, 6, 54.7, 1 / 20),
    "cube": (8, 6, 12, 45.0, 1 / 6),
    "octahedron": (6, 8, 12, 35.3, 1 / 10),
    "dodecahedron": (20, 12, 30, 31.7, (39 * GOLDEN + 28) / 150),
    "icosahedron": (12, 20, 30, 20.9, GOLDEN**2 / 10),
}


@pytest.fixture(params=NAMES)
def solid(request):
    return Chassis.named(request.param, edge_length=0.7, mass=13.0)


def test_the_five_solids(solid):
    corners, faces, edges, slope, moment = SOLIDS[solid.name]
    assert (len(solid.vertices), len(solid.faces), len(solid.edges)) == (corners, faces, edges)
    lengths = np.linalg.norm(np.diff(solid.vertices[solid.edges], axis=1), axis=2)
    assert lengths == pytest.approx(np.full((edges, 1), 0.7), rel=1e-12)
    assert solid.inertia == pytest.approx(13.0 * 0.49 * moment * np.eye(3), rel=1e-12, abs=1e-12)
    for edge in range(1, edges + 1):
        assert np.degrees(solid.edge_frame(edge).alpha) == pytest.approx(slope, abs=0.051)


def test_faces_are_counter_clockwise_from_inside(solid):
    for i, face in enumerate(solid.faces):
        corners = solid.vertices[list(face)]
        sides = np.roll(corners, -1, axis=0) - corners
        turns = np.cross(sides, np.roll(sides, -1, axis=0)) @ solid.up(i)
        assert (turns > 0).all() and -corners[0] @ solid.up(i) > 0
    assert solid.up(0) == pytest.approx([0, 0, 1], abs=1e-12)


def test_a_step_brings_the_next_face_down(solid):
    for edge in range(1, len(solid.edges) + 1):
        for face in solid.faces_at(edge):
            frame = solid.edge_frame(edge, face)
            assert frame.axes @ frame.axes.T == pytest.approx(np.eye(3), abs=1e-12)
            assert np.linalg.det(frame.axes) == pytest.approx(1.0)
            heights = [frame.spike_positions(solid.vertices, a)[:, 2] for a in (0.0, frame.turn)]
            for height, down in zip(heights, (frame.start_face, frame.end_face), strict=True):
                assert (height > -1e-12).all()
                assert set(np.flatnonzero(height < 1e-9)) == set(solid.faces[down])
            assert frame.turn == pytest.approx(2 * frame.alpha)


def test_a_step_back_comes_from_the_other_face(solid):
    there = solid.edge_frame(2)
    back = solid.edge_frame(2, there.end_face)
    assert (back.start_face, back.end_face) == (there.end_face, there.start_face)
    assert back.r == pytest.approx(-there.r) and back.spikes == there.spikes[::-1]
    assert back.turn == pytest.approx(there.turn) and back.distance == pytest.approx(there.distance)


def test_distances_of_steps():
    assert Chassis.named("tetrahedron", 2.0).edge_frame(5).distance == pytest.approx(2 / 3**0.5)
    assert Chassis.named("cube", 2.0).edge_frame(7).distance == pytest.approx(2.0)


def test_the_published_tetrahedron():
    rover = peter()
    chassis = rover.chassis
    for edge in range(1, 7):
        assert chassis.com_to_edge(edge) == pytest.approx(1 / (2 * 2**0.5))
        assert chassis.inertia_about_edge(edge) == pytest.approx(47 * (1 / 20 + 1 / 8))
        assert np.degrees(chassis.step_angle(edge)) == pytest.approx(109.4712, abs=1e-4)
    assert chassis.edge_frame(1).r == pytest.approx([1, 0, 0], abs=1e-12)
    for edge in (1, 2, 3):
        opposite = chassis.vertices[chassis.edges[[edge - 1, edge + 2]]]
        assert len(np.unique(opposite.reshape(4, 3).round(9), axis=0)) == 4


def test_the_published_gimbal_axis():
    g = peter().cmg.gimbal_axis
    assert g == pytest.approx([1 / 2**0.5, 1 / 6**0.5, -1 / 3**0.5])
    shares = [abs(peter().edge_frame(edge).r @ g) for edge in range(1, 7)]
    assert shares == pytest.approx([2**-0.5, 0, 2**-0.5, 2**-0.5, 0, 2**-0.5], abs=1e-12)


@pytest.mark.parametrize("name", [*NAMES, "odd"])
def test_no_gimbal_axis_is_better(name, rng):
    from scipy.optimize import minimize

    odd = name == "odd"
    chassis = Chassis.uniform(rng.normal(size=(4, 3)), 1.0) if odd else Chassis.named(name)
    ends = chassis.vertices[chassis.edges]
    e = ends[:, 1] - ends[:, 0]
    e /= np.linalg.norm(e, axis=1, keepdims=True)
    g = chassis.gimbal_axis()
    ours = np.abs(e @ g).max()
    tried = rng.normal(size=(4000, 3))
    tried /= np.linalg.norm(tried, axis=1, keepdims=True)
    worst = np.abs(tried @ e.T).max(axis=1)
    best = np.inf
    for start in tried[np.argsort(worst)[:5]]:
        # epigraph form: minimise z with |e_j . g| <= z on the sphere
        found = minimize(
            lambda x: x[3],
            [*start, 1.0],
            constraints=[
                {"type": "eq", "fun": lambda x: x[:3] @ x[:3] - 1},
                {"type": "ineq", "fun": lambda x: x[3] - e @ x[:3]},
                {"type": "ineq", "fun": lambda x: x[3] + e @ x[:3]},
            ],
            method="SLSQP",
            options={"ftol": 1e-12},
        )
        best = min(best, np.abs(e @ found.x[:3]).max() / np.linalg.norm(found.x[:3]))
    assert ours <= worst.min() + 1e-12
    assert ours == pytest.approx(best, abs=1e-6)


def test_a_body_of_uniform_density(rng):
    """Mass centre and inertia against points thrown into the body."""
    from scipy.spatial import Delaunay
    from scipy.stats import qmc

    corners = rng.normal(size=(5, 3)) * [1.0, 2.0, 0.7]
    corners = corners[np.unique(Delaunay(corners).convex_hull)]
    chassis = Chassis.uniform(corners, 3.0)
    low, high = chassis.vertices.min(axis=0), chassis.vertices.max(axis=0)
    points = qmc.scale(qmc.Sobol(3, seed=1).random_base2(17), low, high)
    inside = points[Delaunay(chassis.vertices).find_simplex(points) >= 0]
    assert inside.mean(axis=0) == pytest.approx(np.zeros(3), abs=3e-3)
    spread = inside.T @ inside / len(inside)
    expected = 3.0 * (np.trace(spread) * np.eye(3) - spread)
    assert chassis.inertia == pytest.approx(expected, abs=0.01 * np.trace(expected))


@pytest.mark.parametrize(
    ("call", "key"),
    [
        (lambda: Chassis.named("cube", edge_length=0.0), "edge_length"),
        (lambda: Chassis.named("cube", mass=-1.0), "mass"),
        (lambda: Chassis.uniform(np.eye(3), 1.0), "vertices"),
        (lambda: Chassis.uniform([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]], 1.0), "vertices"),
        (lambda: Chassis.uniform([*np.eye(3), np.zeros(3), [0.1, 0.1, 0.1]], 1.0), "vertices"),
        (lambda: Chassis(np.eye(4, 3) + 5.0, 1.0, np.eye(3)), "vertices"),
        (lambda: Chassis(peter().chassis.vertices, 1.0, np.diag([1.0, 1.0, 5.0])), "inertia"),
        (lambda: peter().edge_frame(7), "edge"),
        (lambda: peter().edge_frame(0), "edge"),
        (lambda: peter().edge_frame(1, face=1), "face"),
        (lambda: Site(gravity=0.0), "gravity"),
        (lambda: Site(incline=2.0), "incline"),
        (lambda: Cmg([0, 0, 1], [0, 0, 2], 1.0, 1.0, 1.0), "spin_axis"),
        (lambda: Cmg([0, 0, 1], [1, 0, 0], 0.0, 1.0, 1.0), "momentum"),
        (lambda: Rover(peter().chassis, peter().cmg, friction=-0.1), "friction"),
    ],
)
def test_what_makes_no_sense_is_refused(call, key):
    with pytest.raises(InputError) as caught:
        call()
    assert caught.value.key == key


def test_an_unknown_solid_is_refused_with_the_nearest():
    with pytest.raises(UnknownNameError, match="did you mean octahedron"):
        Chassis.named("octohedron")
