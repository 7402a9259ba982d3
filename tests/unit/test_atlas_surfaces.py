"""Singular points and surfaces: printed values, geometry, degenerate directions, bad input."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import minimize

import nullmotion as nm
from nullmotion import atlas

PYRAMID = nm.layouts.pyramid(skew=np.arcsin(0.8))
LAYOUTS = [name for name in nm.layouts.names() if nm.layouts.create(name).m == 3]


def edges(cells: np.ndarray) -> np.ndarray:
    """Return the directed edges of triangles, (3 T, 2)."""
    return np.concatenate([cells[:, [0, 1]], cells[:, [1, 2]], cells[:, [2, 0]]])


def test_the_published_point_of_the_pyramid() -> None:
    u = np.array([0.206284, 0.309426, 0.928279])  # (2, 3, 9) / sqrt 94, as printed
    point = atlas.singular_points(PYRAMID, u, [1, 1, -1, -1])
    printed = [63.434949, 110.323137, -70.346176, -102.528808]
    assert np.degrees(point.delta) == pytest.approx(printed, abs=5e-5)
    exact = atlas.singular_points(PYRAMID, [2, 3, 9], [1, 1, -1, -1])
    assert np.degrees(exact.delta) == pytest.approx(printed, abs=5e-7)
    assert exact.momentum == pytest.approx([-0.971318, -1.037484, -0.068602], abs=5e-7)
    assert exact.u == pytest.approx(u, abs=5e-7)
    assert not exact.free.any()
    assert exact.across == pytest.approx(
        np.linalg.norm(np.cross(PYRAMID.gimbal_axes, exact.u), axis=1)
    )


def test_published_measures_of_the_pyramid() -> None:
    measures = nm.singularity.measures(PYRAMID, np.zeros(4))
    assert measures["sqrt_det_AAT"] == pytest.approx(1.152, abs=1e-12)
    assert PYRAMID.momentum(np.full(4, np.pi / 2)) == pytest.approx([0, 0, 3.2], abs=1e-12)


def test_opposite_directions_and_signs_are_the_same_point(rng: np.random.Generator) -> None:
    u, signs = rng.normal(size=(20, 3)), rng.choice([-1, 1], size=(20, 4))
    one, other = (atlas.singular_points(PYRAMID, s * u, s * signs) for s in (1, -1))
    assert one.delta == pytest.approx(other.delta)
    assert one.momentum == pytest.approx(other.momentum)


def test_axes_broadcast(rng: np.random.Generator) -> None:
    points = atlas.singular_points(PYRAMID, rng.normal(size=(5, 1, 3)), atlas.patterns(PYRAMID))
    assert points.delta.shape == (5, 8, 4) and points.momentum.shape == (5, 8, 3)
    assert points.free.shape == points.across.shape == points.signs.shape == (5, 8, 4)
    assert points.u.shape == (5, 8, 3)


def test_the_outer_sheet_is_where_the_momentum_along_u_is_largest(rng: np.random.Generator) -> None:
    array = nm.CmgArray(PYRAMID.gimbal_axes, PYRAMID.spin_axes, [1.0, 2.0, 0.5, 1.5])
    for u in rng.normal(size=(4, 3)):
        along = atlas.singular_points(array, u, np.ones(4)).momentum @ u
        found = max(
            -minimize(lambda d, u=u: -array.momentum(d) @ u, start).fun
            for start in rng.uniform(-np.pi, np.pi, (8, 4))
        )
        assert along == pytest.approx(found, rel=1e-9)


def test_patterns_are_all_and_different() -> None:
    array = nm.CmgArray(PYRAMID.gimbal_axes, PYRAMID.spin_axes, [0.0, 1.0, 2.0, 1.0])
    signs = atlas.patterns(array)
    assert signs.shape == (4, 4) and (signs[0] == 1).all()
    assert len({tuple(s) for s in signs}) == 4
    assert (signs[:, :2] == 1).all()  # no momentum, and the first that works
    assert len(atlas.patterns(nm.layouts.pyramid(n=8))) == 128


@pytest.mark.parametrize("name", LAYOUTS)
def test_a_direction_along_a_gimbal_axis_has_a_circle(name: str) -> None:
    array = nm.layouts.create(name, h0=1.5)
    axis = array.gimbal_axes[0]
    alike = np.abs(array.gimbal_axes @ axis) > 1 - 1e-9
    angle = np.linspace(0, 2 * np.pi, 13)
    e1 = array.spin_axes[0]
    sides = np.outer(np.cos(angle), e1) + np.outer(np.sin(angle), np.cross(axis, e1))
    points = atlas.singular_points(array, axis, np.ones(array.n), sides)
    assert (points.free == alike).all()
    centre = points.momentum[:-1].mean(axis=0)
    off = points.momentum - centre
    assert np.linalg.norm(off, axis=1) == pytest.approx(1.5 * alike.sum(), rel=1e-12)
    assert off @ axis == pytest.approx(0.0, abs=1e-12)
    alone = atlas.singular_points(array, axis, np.ones(array.n))
    assert (alone.delta[alike] == 0).all()
    beside = atlas.singular_points(array, axis + 1e-7 * sides, np.ones(array.n))
    assert beside.momentum == pytest.approx(points.momentum, abs=1e-6)
    assert not beside.free.any()


@pytest.mark.sampled(2)
@pytest.mark.parametrize("name", [*LAYOUTS, "pyramid-8", "without", "flat"])
def test_the_mesh_is_a_sphere_with_a_hole_at_every_axis(name: str) -> None:
    made = {
        "pyramid-8": nm.layouts.pyramid(n=8, skew=1.2),
        "without": PYRAMID.without(1),
        "flat": nm.layouts.pyramid(n=5, skew=0.03),  # axes close to each other
    }
    array = made.get(name) or nm.layouts.create(name)
    unlike: list[np.ndarray] = []
    for axis in array.gimbal_axes:
        if all(abs(axis @ other) < 1 - 1e-9 for other in unlike):
            unlike.append(axis)
    for resolution in (50, 700, 4000):
        sheet = atlas.surfaces(array, resolution, np.ones(array.n))[0]
        cells = sheet.cells
        directed = edges(cells)
        once = np.unique(np.sort(directed, axis=1), axis=0)
        assert len(np.unique(directed, axis=0)) == len(directed)  # all turn the same way round
        assert len(np.unique(cells)) == len(sheet.u)
        assert len(sheet.u) - len(once) + len(cells) == 2 - 2 * len(unlike)
        # the border is made of rim points alone, a closed ring at each axis
        border = once[np.unique(np.sort(directed, axis=1), axis=0, return_counts=True)[1] == 1]
        assert sheet.rim[border].all()
        assert (np.bincount(border.ravel(), minlength=len(sheet.u))[sheet.rim] == 2).all()
        assert len(np.unique(np.round(sheet.u[sheet.rim], 9), axis=0)) == 2 * len(unlike)
        corner = sheet.u[cells[~sheet.rim[cells].any(axis=1)]]
        normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
        assert (np.einsum("tk,tk->t", normal, corner.sum(axis=1)) > 0).all()


def test_sheets_meet_at_the_rims() -> None:
    """Where u is along g_i the sheets of epsilon_i = 1 and -1 have the same circle."""
    sheets = atlas.surfaces(PYRAMID, 1000)
    for i, axis in enumerate(PYRAMID.gimbal_axes):
        for sheet in sheets:
            flipped = sheet.signs.copy()
            flipped[i] *= -1
            side = 1.0
            if flipped[0] < 0:  # kept as its opposite
                flipped, side = -flipped, -1.0
            other = next(s for s in sheets if (s.signs == flipped).all())
            here = sheet.momentum[sheet.rim & (sheet.u @ axis > 1 - 1e-9)]
            there = other.momentum[other.rim & (side * other.u @ axis > 1 - 1e-9)]
            distance = np.linalg.norm(here[:, None] - there, axis=-1)
            gap = np.linalg.norm(np.roll(here, 1, axis=0) - here, axis=1).max()
            assert distance.min(axis=1).max() < 0.51 * gap


def test_u_is_normal_to_the_surface() -> None:
    array = nm.CmgArray(PYRAMID.gimbal_axes, PYRAMID.spin_axes, [1.0, 1.4, 0.8, 1.1])
    for sheet in atlas.surfaces(array, 20_000):
        corner = sheet.momentum[sheet.cells]
        normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
        size = np.linalg.norm(normal, axis=1)
        product = 1.0 / np.where(sheet.rim, 1e-9, sheet.curvature)[sheet.cells]
        spread = product.max(axis=1) / product.min(axis=1)
        longest = np.linalg.norm(corner - np.roll(corner, 1, axis=1), axis=2).max(axis=1)
        # away from edges and rims, and no slivers
        plain = (spread > 0) & (spread < 1.1) & (size > 0.1 * longest**2)
        u = sheet.u[sheet.cells].mean(axis=1)
        cosine = np.einsum("tk,tk->t", normal, u)[plain] / size[plain]
        assert plain.mean() > 0.2
        assert np.quantile(np.abs(cosine), 0.01) > 0.98
        sign = np.sign(sheet.curvature[sheet.cells[plain, 0]])
        assert (np.sign(cosine) == sign).mean() > 0.999  # a saddle turns the triangle over


def test_momenta_carry_the_bias_and_failed_cmgs_are_left_out() -> None:
    array = PYRAMID.without(2, frozen_at=0.7)
    for sheet in atlas.surfaces(array, 200):
        assert sheet.momentum == pytest.approx(array.momentum(sheet.delta), abs=1e-13)
    idle = nm.CmgArray(PYRAMID.gimbal_axes, PYRAMID.spin_axes, [1.0, 1.0, 0.0, 1.0])
    gone = atlas.surfaces(PYRAMID.without(2), 300)
    kept = atlas.surfaces(idle, 300)
    assert len(gone) == len(kept) == 4
    for a, b in zip(gone, kept, strict=True):
        assert a.momentum == pytest.approx(b.momentum, abs=1e-13)
        assert (a.kind == b.kind).all() and a.rim.sum() == b.rim.sum()


@pytest.mark.parametrize("name", ["planar", "triangle"])
def test_planar_sheets_are_circles(name: str) -> None:
    array = nm.layouts.create(name, h0=2.0)
    for sheet in atlas.surfaces(array, 90):
        radius = 2.0 * abs(sheet.signs.sum())
        assert np.linalg.norm(sheet.momentum, axis=1) == pytest.approx(radius, abs=1e-12)
        assert (sheet.cells[:-1, 1] == sheet.cells[1:, 0]).all()
        assert sheet.cells[-1, 1] == sheet.cells[0, 0] and not sheet.rim.any()
        if radius:
            assert np.abs(sheet.curvature) == pytest.approx(1 / radius)


def test_a_gimbal_axis_in_the_torque_plane() -> None:
    array = nm.CmgArray(
        [[0, 0, 1], [1, 0, 0]], [[1, 0, 0], [0, 1, 0]], torque_axes=[[1, 0, 0], [0, 1, 0]]
    )
    for sheet in atlas.surfaces(array, 100):
        assert sheet.rim.sum() == 4  # two sides of each of +x and -x
        assert np.abs(np.einsum("pm,pmn->pn", sheet.u, array.jacobian(sheet.delta))).max() < 1e-12
        assert len(sheet.cells) == len(sheet.u)


def test_one_torque_axis() -> None:
    array = nm.CmgArray([[0, 0, 1], [0, 1, 0]], [[1, 0, 0], [1, 0, 0]], torque_axes=[[1, 0, 0]])
    outer, inner = atlas.surfaces(array, 50)
    assert sorted(outer.momentum[:, 0]) == pytest.approx([-2, 2])
    assert inner.momentum[:, 0] == pytest.approx([0, 0])
    assert [atlas.KINDS[k] for k in inner.kind] == ["hyperbolic"] * 2


def test_more_resolution_changes_no_size() -> None:
    sizes = [
        np.linalg.norm(atlas.surfaces(PYRAMID, r, np.ones(4))[0].momentum, axis=1).max()
        for r in (2000, 30_000)
    ]
    assert sizes == pytest.approx([3.29848, 3.29848], abs=1e-4)


@pytest.mark.parametrize(
    ("call", "key"),
    [
        (lambda: atlas.singular_points(PYRAMID, [0, 0, 0], np.ones(4)), "u"),
        (lambda: atlas.singular_points(PYRAMID, [0, 1], np.ones(4)), "u"),
        (lambda: atlas.singular_points(PYRAMID, "up", np.ones(4)), "u"),
        (lambda: atlas.singular_points(PYRAMID, [0, np.nan, 1], np.ones(4)), "u"),
        (lambda: atlas.singular_points(PYRAMID, [0, 0, 1], np.ones(3)), "signs"),
        (lambda: atlas.singular_points(PYRAMID, [0, 0, 1], [1, 1, 0, 1]), "signs"),
        (lambda: atlas.singular_points(PYRAMID, [0, 0, 1], "++--"), "signs"),
        (lambda: atlas.singular_points(PYRAMID, [0, 0, 1], np.ones(4), [0, 0, 0]), "towards"),
        (lambda: atlas.surfaces(PYRAMID, 10), "resolution"),
        (lambda: atlas.surfaces(PYRAMID, 1e3), "resolution"),
        (lambda: atlas.surfaces(nm.layouts.planar(n=17)), "array.n"),
    ],
)
def test_bad_input_is_refused(call, key: str) -> None:
    with pytest.raises(nm.InputError) as error:
        call()
    assert error.value.key == key
