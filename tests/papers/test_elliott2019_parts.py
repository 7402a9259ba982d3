"""Elliott 2019: the parts of the reproduction, each against something else."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import check_grad

from nullmotion import laws, ops
from nullmotion.array import layouts
from nullmotion.guarantee.constraints.box90_cubic import Box90Cubic
from nullmotion.guarantee.constraints.planar import Planar
from nullmotion.papers import elliott2019_printed as printed
from nullmotion.papers import elliott2019_solids as solids
from nullmotion.papers import elliott2019_sqp as sqp
from nullmotion.papers.elliott2019_camera import Body, Camera
from nullmotion.papers.elliott2019_courses import DT, courses
from nullmotion.papers.elliott2019_equations import missed, region_end
from nullmotion.papers.elliott2019_flight import Flyer
from nullmotion.papers.elliott2019_runs import augmented, start
from nullmotion.papers.elliott2019_spheres import Band, Box90, directions, least, radius


@pytest.fixture(scope="module")
def cubic():
    return Box90(Box90Cubic())


@pytest.mark.parametrize("n", [4, 5, 6, 7, 8, 9, 11])
def test_the_printed_angles_are_the_constraints(n):
    constraint = Planar(n)
    assert printed.critical_momentum(n) == pytest.approx(constraint.critical_momentum, rel=1e-14)
    for H in (0.4, 1.7, 0.6 * n, 0.9 * n):
        ours = np.asarray(constraint.angles(np.array([H, 0.0])), float)
        assert np.sort(printed.angles(n, H, "ceil")) == pytest.approx(np.sort(ours), abs=1e-12)


def test_misprints():
    assert missed(9) < 1e-12 and missed(11, "ceil") < 1e-12
    assert missed(11) == pytest.approx(1.4392, abs=1e-4)
    assert printed.critical_momentum_in_summary(5) == pytest.approx(1 + np.sqrt(3))
    assert region_end(5) == pytest.approx(1 + np.sqrt(6)) and region_end(4) == pytest.approx(2**1.5)


def test_gradients_of_the_squared_rows(rng):
    delta = rng.uniform(-np.pi, np.pi, 7)
    rows = np.linalg.pinv(np.array([-np.sin(delta), np.cos(delta)]))
    assert sqp.squares(delta)[0] == pytest.approx((rows**2).sum(axis=1), rel=1e-12)
    for i in range(7):
        error = check_grad(
            lambda d, i=i: sqp.squares(d)[0][i], lambda d, i=i: sqp.squares(d)[1][i], delta
        )
        assert error < 1e-5


def test_sqp_meets_the_closed_form(rng):
    for n, H in ((5, 4.0), (9, 8.2)):
        closed = 1.0 / np.sqrt(1.0 / Planar(n).radial_squares(H).max())
        assert sqp.solve(H, rng.uniform(-np.pi, np.pi, n)) == pytest.approx(closed, abs=1e-9)


def test_momenta_of_the_comparison():
    sizes = [sqp.momenta(printed.critical_momentum(n), n) for n in sqp.SIZES]
    assert sum(map(len, sizes)) == sqp.COUNT
    assert all(np.diff(H).max() <= sqp.STEP + 0.5 * sqp.STEP + 1e-12 for H in sizes)
    assert sizes[0][0] == pytest.approx(1 + np.sqrt(6)) and sizes[0][-1] == pytest.approx(4.95)


def test_least_on_spheres(cubic, rng):
    sizes = np.array([0.5, 1.2, 1.75])
    found = least(cubic.capability, sizes)
    u = rng.normal(size=(20_000, 3))
    u /= np.linalg.norm(u, axis=1, keepdims=True)
    tried = np.array([cubic.capability(size * u).min() for size in sizes])
    assert (found <= tried + 1e-9).all() and found == pytest.approx(tried, abs=0.02)


def test_radius_of_an_ellipsoid():
    axes = np.array([1.9, 1.1, 1.5])

    def room(h):
        return 1.0 - ((h / axes) ** 2).sum(axis=1)

    assert radius(room, 0.0) == pytest.approx(1.1, abs=1e-5)
    assert np.linalg.norm(directions(np.array([[0.3, 1.2]]))) == pytest.approx(1.0)


def test_bands_hold_what_lies_in_them():
    band = Band(np.array([0.0, 1.0]), np.array([1.0, 0.0]), np.array([1.0, 2.0]))
    sizes, values = np.array([0.5, 0.5, 0.5]), np.array([0.45, 1.0, 1.55])
    assert band.outside(sizes, values, 0.02).tolist() == [True, False, True]


def test_determinant_and_room(cubic, rng):
    h = rng.uniform(-1.4, 1.4, (50, 3))
    h = h[cubic.capability(h) > 0]
    delta = cubic.constraint.gimbal_angles(h)
    product = np.sin(delta[:, 0] - delta[:, 1]) * np.sin(delta[:, 2] - delta[:, 3])
    assert cubic.determinant(h) == pytest.approx(np.abs(product), abs=1e-12)
    assert (cubic.room(h) > 0).all() and cubic.room(np.array([[2.1, 0, 0]]))[0] < 0


def test_augmented_jacobian_by_lapack(cubic, rng):
    array, delta = layouts.box90(), start() + rng.normal(scale=0.2, size=4)
    A, h = array.jacobian(delta), array.momentum(delta)
    slope = np.asarray(cubic.constraint.bias(h)[1], float)
    row = A[0] * [1, 1, 0, 0] - 0.5 * (np.array([1.0, 0, 0]) - slope) @ A
    J = np.vstack([A, row])
    size, capability, det = augmented(array, cubic.constraint, delta)
    assert size == pytest.approx(np.linalg.norm(h))
    assert det == pytest.approx(abs(np.linalg.det(J)))
    rows = np.linalg.norm(np.linalg.inv(J)[:, :3], axis=1)
    assert capability == pytest.approx(1 / rows.max())


def test_trajectories_are_straight_and_end_at_rest(cubic):
    array = layouts.box90(h0=1.0, rate_limit=1.0)
    course = courses(cubic.capability, 0.3, 1, 7)[0]
    variants = [laws.create("local-gradient", k=k) for k in (0.2, 1.0)]
    slow, fast = Flyer(array, variants, start()).fly(course)
    assert slow.arrived and fast.arrived
    assert np.abs(slow.delta[-1] - fast.delta[-1]).max() > 1e-4
    for flown in (slow, fast):
        h = array.momentum(flown.delta)
        assert np.linalg.norm(h[-1]) < 1e-6
        turns = [np.linalg.norm(h - w, axis=1).min() for w in course.waypoints]
        assert max(turns) < 1e-5
        steps = np.linalg.norm(np.diff(h, axis=0), axis=1)
        assert steps[:50] == pytest.approx(DT * course.lengths[:50], rel=1e-3)
        way = course.waypoints[0] / np.linalg.norm(course.waypoints[0])
        assert np.cross(h[:50], way) == pytest.approx(0.0, abs=1e-5)


def test_a_ball_seen_from_afar():
    camera = Camera(0.3, -1.0)
    assert camera.axes @ camera.axes.T == pytest.approx(np.eye(3), abs=1e-15)
    view = Body(lambda h: 1.5 - ops.sqrt(h @ h)).seen(camera)
    middle = len(view.depth) // 2
    assert view.depth[middle, middle] == pytest.approx(1.5, abs=1e-4)
    assert view.normal[middle, middle] == pytest.approx([0, 0, 1], abs=0.01)
    share = np.isfinite(view.depth).mean() * (2 * 2.85) ** 2
    assert share == pytest.approx(np.pi * 1.5**2, rel=0.01)
    behind, beside = -1.6 * camera.axes[2], 1.7 * camera.axes[0]
    assert view.hidden(np.array([behind, beside, 1.6 * camera.axes[2]])).tolist() == [1, 0, 0]


def test_outlines_lie_on_the_restricted_envelope():
    for edge in solids.outlines():
        assert [float(solids.restricted(h)) for h in edge] == pytest.approx(
            [0.0] * len(edge), abs=1e-6
        )
