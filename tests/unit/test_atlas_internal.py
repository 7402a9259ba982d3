"""The nearest impassable singularity: against random search, LAPACK's forms, and known states."""

from __future__ import annotations

import json
from functools import cache

import numpy as np
import pytest

import nullmotion as nm
from nullmotion import atlas
from nullmotion.atlas.internal_bound import nothing_within, size_bound
from nullmotion.atlas.internal_inertia import cases_of, hyperbolic
from nullmotion.atlas.internal_sphere import Sphere
from nullmotion.atlas.signs import mixed, patterns

PYRAMID = nm.layouts.pyramid(skew=np.radians(54.73))
STEEP = nm.layouts.pyramid(skew=np.arcsin(0.8))
ELLIPTIC = np.radians([-90.0, 0.0, 90.0, 0.0])


def custom(seed: int, n: int, pairs: bool = False, h0: tuple[float, float] = (0.5, 2.0)):
    """Return CMGs with random axes and momenta, and some bias."""
    rng = np.random.default_rng(seed)
    gimbal = rng.normal(size=(n, 3))
    if pairs:
        gimbal[1::2] = gimbal[: 2 * (n // 2) : 2]
    gimbal /= np.linalg.norm(gimbal, axis=1, keepdims=True)
    spin = np.cross(gimbal, rng.normal(size=(n, 3)))
    spin /= np.linalg.norm(spin, axis=1, keepdims=True)
    return nm.CmgArray(gimbal, spin, rng.uniform(*h0, n), momentum_bias=[0.1, 0.2, -0.3])


def like(layout: nm.CmgArray, h0: list[float]) -> nm.CmgArray:
    """Return an array with other momenta."""
    return nm.CmgArray(layout.gimbal_axes, layout.spin_axes, h0)


@cache
def nearest(array: nm.CmgArray) -> atlas.Impassable:
    """Return the nearest impassable point, worked out once for each array."""
    found = atlas.nearest_impassable(array)
    assert found is not None
    return found


def definite(array: nm.CmgArray, delta: np.ndarray, u: np.ndarray) -> np.ndarray:
    """Return where no null motion keeps h . u in second order, with rotors on both sides, (k,)."""
    right = np.linalg.svd(array.jacobian(delta))[2]
    along = np.einsum("knm,km->kn", array.rotor_momenta(delta), u)
    N = right[:, array.m - 1 :]
    value = np.linalg.eigvalsh(np.einsum("kan,kn,kbn->kab", N, along, N))
    same = (value[:, 0] > 1e-9) | (value[:, -1] < -1e-9)
    return same & (along > 0).any(axis=1) & (along < 0).any(axis=1)


def random_points(array: nm.CmgArray, count: int, rng: np.random.Generator):
    """Return singular points of random directions and signs."""
    u = rng.normal(size=(count, array.m))
    signs = rng.choice([-1.0, 1.0], size=(count, array.n))
    return atlas.singular_points(array, u / np.linalg.norm(u, axis=1, keepdims=True), signs)


CASES = {
    "pyramid": PYRAMID,
    "steep": STEEP,
    "one lost": PYRAMID.without(0),
    "unequal": like(PYRAMID, [1.0, 0.6, 1.3, 0.9]),
    "three": custom(7, 3),
    "four": custom(1, 4),
    "five": custom(2, 5),  # at the end of a long narrow valley
    "six": nm.layouts.pyramid(n=6),
    "seven": custom(4, 7),
    "pairs": custom(5, 6, pairs=True),
    "unlike pairs": like(nm.layouts.box90(), [1.0, 1.2, 0.9, 1.4]),
}


@pytest.mark.sampled(1)
@pytest.mark.parametrize("name", CASES)
def test_no_random_point_is_nearer_and_some_come_close(name: str) -> None:
    array = CASES[name]
    found = nearest(array)
    assert found.lower <= found.radius <= found.lower * 1.002  # the proof closes
    bias = array.momentum_bias
    points = random_points(array, 60_000, np.random.default_rng(8))
    size = np.linalg.norm(points.momentum - bias, axis=1)
    near = size < 1.3 * found.radius + 0.2 * array.mean_momentum
    inside = definite(array, points.delta[near], points.u[near])
    assert inside.any()
    assert found.lower <= size[near][inside].min()
    # at the point itself, and just beside it on its own sheet
    h = array.momentum(found.delta) - bias
    assert h == pytest.approx(found.momentum, abs=1e-12)
    assert np.linalg.norm(h) == pytest.approx(found.radius, abs=1e-12)
    assert definite(array, found.delta[None], found.u[None])[0]
    assert found.kind == nm.singularity.classify(array, found.delta) == "elliptic"
    sigma = np.linalg.svd(array.unit_jacobian(found.delta), compute_uv=False)
    assert sigma[-1] < 1e-12
    again = atlas.singular_points(array, found.u, found.signs)
    assert again.delta == pytest.approx(found.delta, abs=1e-12)


def test_the_pyramid_of_54_73_deg() -> None:
    """1.155 h0: [-90, 0, 90, 0] deg, and what is nearer by a part in 5000."""
    found = nearest(PYRAMID)
    known = 2 * np.cos(np.radians(54.73))
    assert np.linalg.norm(PYRAMID.momentum(ELLIPTIC)) == pytest.approx(known, abs=1e-12)
    assert found.lower < found.radius < known
    assert found.radius == pytest.approx(1.155, abs=5e-4)
    assert found.radius == pytest.approx(known, rel=3e-4)
    assert found.inside and not found.edge
    # |h| is stationary there: h is along u
    assert np.cross(found.momentum, found.u) == pytest.approx(np.zeros(3), abs=1e-10)
    # alone with its momentum, which can go back along u but not on
    piece = atlas.component(PYRAMID, found.delta)
    assert piece.points == pytest.approx(found.delta[None], abs=1e-6)
    assert not atlas.escapable(PYRAMID, found.delta)
    assert not atlas.passable(PYRAMID, found.delta, found.u)
    assert atlas.passable(PYRAMID, found.delta, -found.u)
    others = atlas.self_motion(PYRAMID, found.momentum)
    assert others[0].best["sigma_min"].value > 0.5  # there is more beyond, elsewhere


def test_the_pseudo_inverse_sticks_on_the_pyramid_and_nowhere_nearer() -> None:
    delta, dt = np.zeros(4), 2e-3
    for _ in range(1500):
        rates = np.linalg.pinv(PYRAMID.jacobian(delta), rcond=1e-9) @ [1.0, 0.0, 0.0]
        delta = delta + dt * rates * min(1.0, 3.0 / max(np.abs(rates).max(), 1e-12))
        if np.linalg.svd(PYRAMID.jacobian(delta))[1][-1] < 0.02:
            break
    assert np.cos(delta - ELLIPTIC).min() > 0.99
    stuck = np.linalg.norm(PYRAMID.momentum(delta))
    found = nearest(PYRAMID)
    assert stuck == pytest.approx(1.155, abs=2e-3)
    assert found.lower <= stuck + 1e-3


@pytest.mark.sampled(2)
@pytest.mark.parametrize("name", ["roof6", "triangle", "box90", "roof", "planar"])
def test_arrays_without_impassable_points(name: str) -> None:
    array = nm.layouts.create(name)
    assert atlas.nearest_impassable(array) is None
    points = random_points(array, 4000, np.random.default_rng(3))
    assert not definite(array, points.delta, points.u).any()


def test_one_rotor_larger_than_the_others_leaves_a_hole_in_the_plane() -> None:
    array = nm.CmgArray([[0, 0, 1]] * 3, [[1, 0, 0]] * 3, [4.0, 1.0, 1.0])
    found = atlas.nearest_impassable(array)
    assert found is not None
    assert found.radius == pytest.approx(2.0) and found.lower == pytest.approx(2.0)
    assert not found.inside  # nothing is reachable on the other side
    assert found.u @ found.momentum == pytest.approx(-2.0)
    assert atlas.self_motion(array, 0.99 * found.momentum) == ()


@pytest.mark.slow
def test_a_plane_of_tilted_cmgs_by_its_own_search() -> None:
    array = nm.CmgArray(
        [[0, 0, 1], [1, 0, 0], [0, 0.6, 0.8]],
        [[1, 0, 0], [0, 1, 0], [1, 0, 0]],
        torque_axes=[[1, 0, 0], [0, 1, 0]],
    )
    found = atlas.nearest_impassable(array)
    assert found is not None
    assert found.lower == 0.0 and "search" in found.basis
    angle = np.linspace(0, 2 * np.pi, 20_001)
    u = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    least = np.inf
    for signs in patterns(array):
        points = atlas.singular_points(array, u, signs)
        good = definite(array, points.delta, points.u)
        least = min(least, np.linalg.norm(points.momentum[good], axis=1).min(initial=np.inf))
    assert found.radius == pytest.approx(least, rel=1e-3)


@pytest.mark.slow
def test_failed_cmgs_bias_and_turned_arrays() -> None:
    gone, frozen = PYRAMID.without(0), PYRAMID.without(0, frozen_at=0.5)
    idle = like(PYRAMID, [0.0, 1.0, 1.0, 1.0])
    turn = np.linalg.qr(np.random.default_rng(4).normal(size=(3, 3)))[0]
    turn = turn * np.sign(np.linalg.det(turn))
    turned = nm.CmgArray(gone.gimbal_axes @ turn.T, gone.spin_axes @ turn.T, 7.0)
    made = [atlas.nearest_impassable(a) for a in (gone, frozen, idle, turned)]
    sizes = [found.radius for found in made if found is not None]
    assert sizes == pytest.approx([sizes[0], sizes[0], sizes[0], 7 * sizes[0]], rel=1e-7)
    for found, array in zip(made, (gone, frozen, idle, turned), strict=True):
        assert found is not None
        bias = array.momentum_bias
        assert array.momentum(found.delta) - bias == pytest.approx(found.momentum, abs=1e-12)
        assert found.delta.shape == found.signs.shape == (array.n,)


@pytest.mark.slow
def test_two_cmgs_are_singular_everywhere() -> None:
    found = atlas.nearest_impassable(PYRAMID.without([0, 1]))
    assert found is not None
    assert found.radius == pytest.approx(0.0, abs=1e-9) and found.lower == 0.0
    assert not found.inside and found.eigenvalues.shape == (0,)


def test_it_goes_into_a_file_and_reports_its_progress() -> None:
    shares: list[float] = []
    found = atlas.nearest_impassable(PYRAMID.without(0), shares.append)
    assert found is not None
    assert shares == sorted(shares) and shares[0] > 0 and shares[-1] == 1.0
    text = json.dumps(found.as_dict(), allow_nan=False)
    kept = json.loads(text)
    assert kept["radius"] == found.radius and kept["lower"] == found.lower
    assert np.radians(kept["gimbal_deg"]) == pytest.approx(found.delta)
    assert kept["kind"] == "elliptic" and kept["signs"] == found.signs.tolist()

    def stop(share: float) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        atlas.nearest_impassable(PYRAMID.without(0), stop)


def test_patterns_that_are_left_out_have_nothing_elliptic(rng: np.random.Generator) -> None:
    arrays = [custom(3, 6), nm.layouts.box90(), custom(4, 8), nm.layouts.scissored_pairs()]
    for array in arrays:
        kept = {tuple(s) for s in mixed(array)}
        for signs in patterns(array):
            if tuple(signs) in kept:
                continue
            u = rng.normal(size=(60, 3))
            u /= np.linalg.norm(u, axis=1, keepdims=True)
            points = atlas.singular_points(array, u, signs)
            assert not definite(array, points.delta, points.u).any()


BOUNDED = [
    custom(11, 4),
    custom(12, 5, pairs=True),
    custom(13, 7),
    like(nm.layouts.box90(), [1.0, 1.3, 0.8, 0.9]),
]


@pytest.mark.parametrize("array", BOUNDED)
def test_what_is_said_of_patches_holds_all_over_them(
    array: nm.CmgArray, rng: np.random.Generator
) -> None:
    sphere, signs = Sphere(array), mixed(array)
    case = cases_of(sphere, array.h0 / array.mean_momentum, signs)
    patches = sphere.cover(len(signs[:1]))
    for _ in range(9):
        patches = patches.take(rng.integers(len(patches), size=200))
        patches = patches.halves(rng.random(200) < 0.5)
    patches = type(patches)(
        patches.chart, patches.box, rng.integers(len(case.weights), size=len(patches))
    )
    view, cases = sphere.view(patches), case.take(patches.pattern)
    low, sure = size_bound(view, cases.weights), hyperbolic(view, cases)
    assert sure.mean() > 0.05
    for _ in range(12):
        share = rng.choice([0.0, 1.0], size=(len(patches), 2)) * (rng.random() < 0.3)
        share = np.where(share > 0, share, rng.random((len(patches), 2)))
        lower, upper = patches.box[:, ::2], patches.box[:, 1::2]
        at = lower + share * (upper - lower)
        inside = type(patches)(patches.chart, np.repeat(at, 2, axis=1), patches.pattern)
        there = sphere.view(inside)
        away = np.arccos(np.clip(np.sum(there.u * view.u, axis=1), -1, 1))
        assert (away < view.radius + 1e-7).all()
        turn = np.arccos(np.clip(np.sum(there.towards * view.towards, axis=2), -1, 1))
        assert (turn <= view.turn + 1e-7).all()
        assert (there.across >= view.least - 1e-9).all()
        assert (there.across <= view.most + 1e-9).all()
        points = atlas.singular_points(array, there.u, cases.signs, there.u)
        size = np.linalg.norm(np.einsum("bk,bkm->bm", cases.weights, there.towards), axis=1)
        assert (size >= low).all()
        off = (there.across > 1e-6).all(axis=1)
        h = np.linalg.norm(points.momentum - array.momentum_bias, axis=1) / array.mean_momentum
        assert h[off] == pytest.approx(size[off], abs=1e-6)
        assert not definite(array, points.delta[sure & off], points.u[sure & off]).any()


def test_the_patches_cover_every_direction(rng: np.random.Generator) -> None:
    """Where all are looked at, every random direction is in one that is not left out."""
    array = custom(11, 4)
    sphere = Sphere(array)
    patches = sphere.cover(1)
    for _ in range(4):
        view = sphere.view(patches)
        patches = patches.take(~view.covered).halves(view.wide[~view.covered])
    view = sphere.view(patches)
    kept = ~view.covered
    u = rng.normal(size=(3000, 3))
    u /= np.linalg.norm(u, axis=1, keepdims=True)
    u = np.concatenate([u, sphere.axes])
    away = np.arccos(np.clip(u @ view.u[kept].T, -1, 1)) - view.radius[kept]
    assert (away.min(axis=1) < 0).all()


@pytest.mark.slow
def test_a_proof_of_too_much_stops_at_what_is_true() -> None:
    found = nearest(STEEP)
    proof = nothing_within(STEEP, mixed(STEEP), 1.3 * found.radius, 40_000)
    assert 0.9 * found.radius < proof.radius <= found.radius
    assert len(proof.u) > 0
    assert nothing_within(STEEP, mixed(STEEP), 0.5 * found.radius, 40_000).radius == pytest.approx(
        0.5 * found.radius
    )
