"""Self-motion sets: pieces against dense sampling and clustering, what they reach, escapes."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

import nullmotion as nm
from nullmotion import atlas

PYRAMID = nm.layouts.pyramid()
BOX = nm.layouts.box90()
TRIANGLE = nm.layouts.triangle()
UNEQUAL = nm.CmgArray(TRIANGLE.gimbal_axes, TRIANGLE.spin_axes, [1.0, 0.7, 1.4])
ELLIPTIC = np.radians([-90.0, 0.0, 90.0, 0.0])


def custom(seed: int) -> nm.CmgArray:
    """Return four CMGs with random axes and momenta."""
    rng = np.random.default_rng(seed)
    gimbal = rng.normal(size=(4, 3))
    gimbal /= np.linalg.norm(gimbal, axis=1, keepdims=True)
    spin = np.cross(gimbal, rng.normal(size=(4, 3)))
    spin /= np.linalg.norm(spin, axis=1, keepdims=True)
    return nm.CmgArray(gimbal, spin, rng.uniform(0.5, 2.0, 4), momentum_bias=[0.1, 0.2, -0.3])


def embedded(delta: np.ndarray) -> np.ndarray:
    """Return cosines and sines: angles a turn apart are the same."""
    return np.concatenate([np.cos(delta), np.sin(delta)], axis=-1)


def solutions(array: nm.CmgArray, momentum: np.ndarray, count: int) -> np.ndarray:
    """Return gimbal angles of a momentum from random ones, by damped least squares."""
    x = np.random.default_rng(11).uniform(-np.pi, np.pi, (count, array.n))
    for _ in range(60):
        A = array.jacobian(x)
        lack = (momentum - array.momentum(x))[..., None]
        move = (A.mT @ np.linalg.solve(A @ A.mT + 1e-14 * np.eye(array.m), lack))[..., 0]
        size = np.linalg.norm(move, axis=1, keepdims=True)
        x = x + move * np.minimum(1.0, 0.5 / np.maximum(size, 1e-300))
    return x[np.abs(momentum - array.momentum(x)).max(axis=1) < 1e-10]


def elbows(array: nm.CmgArray, momentum: np.ndarray, count: int) -> np.ndarray:
    """Return the angles of three planar CMGs by the cosine rule, the first on a grid."""
    first = np.linspace(-np.pi, np.pi, count, endpoint=False)
    phase = np.arctan2(array.spin_axes[:, 1], array.spin_axes[:, 0])
    a, b = array.h0[1], array.h0[2]
    rest = complex(*momentum) - array.h0[0] * np.exp(1j * (first + phase[0]))
    cosine = (np.abs(rest) ** 2 + a * a - b * b) / (2 * a * np.abs(rest))
    there = np.abs(cosine) <= 1
    found = []
    for side in (1, -1):
        second = np.angle(rest[there]) + side * np.arccos(cosine[there])
        third = np.angle(rest[there] - a * np.exp(1j * second))
        found.append(np.stack([first[there], second - phase[1], third - phase[2]], axis=1))
    return np.concatenate(found)


def clusters(delta: np.ndarray, gap: float) -> np.ndarray:
    """Return which cluster angles belong to that are closer than a gap to each other."""
    near = cKDTree(embedded(delta)).query_pairs(gap, output_type="ndarray")
    graph = coo_array((np.ones(len(near)), (near[:, 0], near[:, 1])), shape=(len(delta),) * 2)
    return connected_components(graph, directed=False)[1]


def check(array: nm.CmgArray, momentum: np.ndarray, dense: np.ndarray, gap: float) -> None:
    """Compare the pieces with clusters of solutions found another way."""
    found = atlas.self_motion(array, momentum)
    label = clusters(dense, gap)
    assert len(found) == label.max(initial=-1) + 1
    used = set()
    for piece in found:
        assert piece.followed and piece.momentum == pytest.approx(momentum)
        assert array.momentum(piece.points) == pytest.approx(
            np.tile(momentum, (len(piece.points), 1)), abs=1e-9
        )
        tree = cKDTree(embedded(piece.points))
        near = tree.query(embedded(dense))[0] < 0.06
        of = np.unique(label[near])
        assert len(of) == 1 and near[label == of[0]].all()  # this cluster, and all of it
        used.add(int(of[0]))
        sampled = np.linalg.svd(array.unit_jacobian(dense[near]))[1]
        for name, values in (("sigma_min", sampled[:, -1]), ("sqrt_det_AAT", sampled.prod(axis=1))):
            best = piece.best[name]
            assert best.value >= values.max() - 1e-9
            assert best.value == pytest.approx(values.max(), rel=2e-2, abs=1e-3)
            measure = nm.singularity.measures(array, best.delta)[name]
            assert measure == pytest.approx(best.value, abs=1e-12)
            assert array.momentum(best.delta) == pytest.approx(momentum, abs=1e-9)
    assert len(used) == len(found)


@pytest.mark.sampled(1)
@pytest.mark.parametrize(
    ("array", "momentum"),
    [
        (TRIANGLE, [0.5, 0.0]),
        (TRIANGLE, [0.0, 0.9]),  # two pieces that come close
        (TRIANGLE, [0.0, 1.1]),  # one
        (TRIANGLE, [1.0, 0.0]),  # one that crosses itself
        (TRIANGLE, [2.1, -1.3]),
        (UNEQUAL, [0.1, 0.2]),
        (UNEQUAL, [0.3, 0.0]),
        (UNEQUAL, [1.2, 0.3]),
        (UNEQUAL, [1.8, 0.3]),
    ],
)
def test_three_planar_cmgs_against_the_cosine_rule(array: nm.CmgArray, momentum: list) -> None:
    h = np.array(momentum)
    dense = elbows(array, h, 12_000)
    assert array.momentum(dense) == pytest.approx(np.tile(h, (len(dense), 1)), abs=1e-12)
    check(array, h, dense, 0.07)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("array", "momentum"),
    [
        (PYRAMID, [0.3, 0.2, 0.1]),
        (PYRAMID, [0.5, 0.0, 0.0]),
        (PYRAMID, [1.15, 0.0, 0.0]),  # two small loops about elliptic states
        (PYRAMID, [0.0, 0.0, 0.0]),  # six crossings
        (PYRAMID, [0.0, 0.0, 2.0]),
        (BOX, [0.5, 0.0, 0.0]),
        (BOX, [0.0, 0.7, 0.2]),
        (custom(1), None),
        (custom(2), None),
        (custom(3), None),
    ],
)
def test_four_cmgs_against_dense_sampling(array: nm.CmgArray, momentum: list | None) -> None:
    inside = array.momentum(np.array([0.3, -1.2, 2.0, 0.8]))
    h = inside if momentum is None else np.array(momentum)
    check(array, h, solutions(array, h, 12_000), 0.08)


@pytest.mark.sampled(1)
@pytest.mark.parametrize("momentum", [[0.3, 0.2, 0.1], [0.9, -0.4, 0.6]])
def test_closed_curves_close_and_crossings_are_singular(momentum: list[float]) -> None:
    for piece in atlas.self_motion(PYRAMID, momentum):
        assert len(piece.curves) == 1 and len(piece.crossings) == 0
        curve = piece.curves[0]
        assert curve.closed
        turned = curve.angles[-1] - curve.angles[0]
        assert turned == pytest.approx(2 * np.pi * curve.turns, abs=1e-12)
        stride = np.linalg.norm(np.diff(curve.angles, axis=0), axis=1)
        assert stride.max() < 0.06 and piece.length == pytest.approx(stride.sum())


@pytest.mark.sampled(1)
@pytest.mark.parametrize(
    ("array", "momentum", "count"),
    [
        (PYRAMID, [0, 0, 0], 6),
        (PYRAMID, [0, 0, 1], 4),
        (BOX, [0.5, 0, 0], 8),
        (TRIANGLE, [1, 0], 3),
    ],
)
def test_two_curves_meet_in_a_crossing(
    array: nm.CmgArray, momentum: list[float], count: int
) -> None:
    (piece,) = atlas.self_motion(array, momentum)
    assert len(piece.crossings) == count
    for delta in piece.crossings:
        assert np.linalg.svd(array.jacobian(delta))[1][-1] < 1e-9
        assert nm.singularity.classify(array, delta) == "hyperbolic"
        assert array.momentum(delta) == pytest.approx(momentum, abs=1e-9)
    assert not any(curve.closed for curve in piece.curves)
    ends = np.concatenate([curve.angles[[0, -1]] for curve in piece.curves])
    gap, crossing = cKDTree(embedded(piece.crossings)).query(embedded(ends))
    assert gap.max() < 1e-5
    assert (np.bincount(crossing) == 4).all()


@pytest.mark.slow
def test_an_elliptic_state_is_alone() -> None:
    piece = atlas.component(PYRAMID, ELLIPTIC)
    assert piece.points == pytest.approx(ELLIPTIC[None], abs=1e-6)
    assert piece.best["sigma_min"].value == pytest.approx(0.0, abs=1e-6)
    assert not atlas.escapable(PYRAMID, ELLIPTIC)
    others = atlas.self_motion(PYRAMID, PYRAMID.momentum(ELLIPTIC))
    assert others[0].best["sigma_min"].value > 0.9  # the same momentum, out of reach


@pytest.mark.slow
def test_close_to_an_elliptic_state_null_motion_leads_nowhere() -> None:
    beside = ELLIPTIC + np.array([0.05, 0.0, 0.0, 0.03])
    assert nm.singularity.classify(PYRAMID, beside) == "regular"
    assert atlas.escapable(PYRAMID, beside)  # it is not singular
    assert not atlas.escapable(PYRAMID, beside, least=0.3)
    assert atlas.component(PYRAMID, beside).length < 1.0
    assert atlas.escapable(PYRAMID, np.zeros(4), least=0.3)


@pytest.mark.sampled(3)
@pytest.mark.parametrize(
    ("array", "delta", "expected"),
    [
        (PYRAMID, [0, 0, 0, 0], True),
        (PYRAMID, [90, 180, -90, 0], True),  # hyperbolic
        (PYRAMID, [-90, 180, 90, 0], False),  # saturated
        (BOX, [90, -90, 90, -90], True),
        (BOX, [30, 210, 40, 220], True),  # degenerate: turn both pairs first
        (nm.layouts.planar(n=2), [0, 180], False),  # degenerate all the way round
        (BOX, [10, 190, 90, 90], False),  # on a face of the envelope
        (TRIANGLE, [-120, 0, 300], True),
    ],
)
def test_escapes(array: nm.CmgArray, delta: list[float], expected: bool) -> None:
    assert atlas.escapable(array, np.radians(delta)) == expected


@pytest.mark.sampled(2)
@pytest.mark.parametrize(
    ("array", "momentum", "count"),
    [
        (nm.layouts.pyramid(n=5), [0.3, 0.2, 0.1], 1),
        (nm.layouts.roof6(), [0.0, 0.0, 0.0], 1),
        (nm.layouts.planar(n=4), [0.3, 0.0], 1),
        (nm.layouts.planar(n=2), [0.3, 0.0], 2),  # the elbow up or down
        (nm.layouts.planar(n=2), [0.0, 0.0], 1),  # turning together
        (PYRAMID.without(0), [0.3, 0.2, 0.1], 4),
    ],
)
def test_sampled_pieces(array: nm.CmgArray, momentum: list[float], count: int) -> None:
    found = atlas.self_motion(array, momentum)
    assert len(found) == count
    for piece in found:
        assert not piece.followed and not piece.curves
        assert array.momentum(piece.points) == pytest.approx(
            np.tile(momentum, (len(piece.points), 1)), abs=1e-9
        )


@pytest.mark.sampled(1)
@pytest.mark.parametrize(
    ("h0", "size"),
    [
        ([1.0, 0.7, 1.4], 0.3),
        ([3.0, 3.0, 1.0, 0.5], 3.0),
        ([1.0, 1.2, 0.9, 1.1], 2.0),
        ([2.0, 2.0, 2.0, 0.3, 0.3], 0.1),
        ([2.0, 2.0, 0.3, 0.3, 0.2], 2.0),
        ([1.0, 1.0, 1.0, 1.0, 1.0], 0.5),
    ],
)
def test_planar_pieces_are_those_of_polygons(h0: list[float], size: float) -> None:
    """Rotors and momentum are the sides of a polygon in the plane.

    Its shapes are in two pieces just where three sides, any two of them, are longer than half
    of all (Kapovich and Millson, J. Differential Geom. 42 (1995), 133-164).
    """
    array = nm.CmgArray([[0, 0, 1]] * len(h0), [[1, 0, 0]] * len(h0), h0)
    sides = sorted([*h0, size])
    expected = 2 if sides[-2] + sides[-3] > sum(sides) / 2 else 1
    assert len(atlas.self_motion(array, [0.6 * size, -0.8 * size])) == expected


def test_out_of_reach() -> None:
    assert atlas.self_motion(PYRAMID, [0, 0, 9.0]) == ()


@pytest.mark.slow
def test_stopped_wheels_stay_where_they_are() -> None:
    idle = nm.CmgArray(PYRAMID.gimbal_axes, PYRAMID.spin_axes, [1.0, 0.0, 1.0, 1.0])
    wide = atlas.self_motion(idle, [0.3, 0.2, 0.1])
    narrow = atlas.self_motion(PYRAMID.without(1), [0.3, 0.2, 0.1])
    assert len(wide) == len(narrow)
    for a, b in zip(wide, narrow, strict=True):
        assert a.best["sigma_min"].value == pytest.approx(b.best["sigma_min"].value)
        assert (a.points[:, 1] == 0).all() and a.points.shape[1] == 4


@pytest.mark.parametrize(
    ("call", "key"),
    [
        (lambda: atlas.self_motion(PYRAMID, [0, 0]), "momentum"),
        (lambda: atlas.self_motion(PYRAMID, [0, 0, np.nan]), "momentum"),
        (lambda: atlas.self_motion(PYRAMID, [0, 0, 0], starts=0), "starts"),
        (lambda: atlas.component(PYRAMID, np.zeros(3)), "delta"),
        (lambda: atlas.component(PYRAMID, np.full(4, np.inf)), "delta"),
        (lambda: atlas.escapable(PYRAMID, np.zeros((2, 4))), "delta"),
    ],
)
def test_bad_input_is_refused(call, key: str) -> None:
    with pytest.raises(nm.InputError) as error:
        call()
    assert error.value.key == key
