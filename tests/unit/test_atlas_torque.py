"""Torque maps against dense sampling and SLSQP, closed forms, and what they claim of themselves."""

from __future__ import annotations

from collections.abc import Callable
from itertools import combinations, product

import numpy as np
import pytest
from scipy.optimize import approx_fprime, least_squares, minimize
from scipy.spatial import ConvexHull

import nullmotion as nm
from nullmotion import atlas
from nullmotion.atlas import torque_bounds
from nullmotion.atlas.torque_climb import METHODS

PYRAMID = nm.layouts.pyramid(rate_limit=2.0, h0=3.0)  # 54.74 deg: axes across a cube's diagonals
MEASURES = ["sigma", "pseudo-inverse", "optimal"]


def custom(seed: int, n: int, limited: bool = True) -> nm.CmgArray:
    """Return CMGs with random axes, momenta and rate limits."""
    rng = np.random.default_rng(seed)
    gimbal = rng.normal(size=(n, 3))
    gimbal /= np.linalg.norm(gimbal, axis=1, keepdims=True)
    spin = np.cross(gimbal, rng.normal(size=(n, 3)))
    spin /= np.linalg.norm(spin, axis=1, keepdims=True)
    limits = rng.uniform(0.5, 2.0, n) if limited else np.inf
    return nm.CmgArray(gimbal, spin, rng.uniform(0.5, 2.0, n), limits)


def planar(h0: list[float], **fields) -> nm.CmgArray:
    """Return CMGs with one gimbal axis."""
    return nm.CmgArray([[0, 0, 1]] * len(h0), [[1, 0, 0]] * len(h0), h0, **fields)


FOUR, FIVE, PLANAR = custom(1, 4), custom(2, 5), planar([1.0, 0.7, 1.4], rate_limit=[1, 2, 0.7])


def limits_of(array: nm.CmgArray) -> np.ndarray:
    return np.where(np.isfinite(array.rate_limit), array.rate_limit, 1.0)


def rate_bounds(array: nm.CmgArray, delta: np.ndarray) -> np.ndarray:
    """Return limit_i / |row_i(A^+)| [N m], (..., n), by LAPACK."""
    inverse = np.linalg.pinv(array.jacobian(delta))
    return limits_of(array) / np.linalg.norm(inverse, axis=-1)


def facet_bounds(array: nm.CmgArray, delta: np.ndarray) -> np.ndarray:
    """Return the distances of the facets of {A w: |w_i| <= limit_i} [N m], (..., facets)."""
    A = array.jacobian(delta)
    found = []
    for members in combinations(range(array.n), array.m - 1):
        columns = A[..., list(members)]
        if array.m == 3:
            normal = np.cross(columns[..., 0], columns[..., 1])
        else:
            normal = columns[..., 0] @ np.array([[0.0, 1.0], [-1.0, 0.0]])
        size = np.linalg.norm(normal, axis=-1)
        support = np.abs(np.einsum("...mn,...m->...n", A, normal)) @ limits_of(array)
        found.append(np.where(size > 1e-9, support / np.maximum(size, 1e-9), np.inf))
    return np.stack(found, axis=-1)


BOUNDS = {"pseudo-inverse": rate_bounds, "optimal": facet_bounds}


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


def brute(array: nm.CmgArray, momentum: np.ndarray, method: str, count: int, best: int) -> float:
    """Return the greatest least bound over random angles of a momentum, the best ones climbed.

    max t  with  bound_i(delta) >= t,  h(delta) = momentum  (SLSQP)
    """
    points = solutions(array, momentum, count)
    values = BOUNDS[method](array, points).min(axis=1)
    greatest = values.max()
    rules = [
        {"type": "ineq", "fun": lambda x: BOUNDS[method](array, x[:-1]).clip(max=1e3) - x[-1]},
        {"type": "eq", "fun": lambda x: array.momentum(x[:-1]) - momentum},
    ]
    for k in np.argsort(-values)[:best]:
        start = np.append(points[k], values[k])
        found = minimize(lambda x: -x[-1], start, constraints=rules, options={"maxiter": 60})
        angles = found.x[:-1]
        if np.abs(array.momentum(angles) - momentum).max() < 1e-7:
            greatest = max(greatest, BOUNDS[method](array, angles).min())
    return float(greatest)


def check(made: atlas.TorqueMap, array: nm.CmgArray) -> np.ndarray:
    """Check that a map is what its angles give; return which momenta are reached."""
    there = ~np.isnan(made.capability)
    assert made.capability.shape == (len(made.y), len(made.x)) == made.sigma_min.shape
    assert (np.isnan(made.delta).any(axis=-1) == ~there).all()
    assert (np.isnan(made.sigma_min) == ~there).all()
    delta, unit = made.delta[there], array.mean_momentum
    if there.any():
        assert np.abs(array.momentum(delta) - made.momentum[there]).max() < 1e-9 * unit
        limit = np.min(array.rate_limit) if np.isfinite(array.rate_limit).any() else 1.0
        given = nm.guarantee.torque_capability(array, delta, made.method) * unit * limit
        assert made.capability[there] == pytest.approx(given, rel=1e-12)
        assert np.abs(delta).max() <= np.pi
        if array.n >= array.m:
            sigma = np.linalg.svd(array.jacobian(delta) / unit, compute_uv=False)[:, -1]
            assert made.sigma_min[there] == pytest.approx(sigma, abs=1e-12)
    return there


def check_against_brute(
    array: nm.CmgArray, method: str, count: int, cells: int = 3, normal=None, offset: float = 0.0
) -> None:
    """Compare random momenta of a map with `brute`: at most 1 % below it."""
    made = atlas.torque_map(array, normal, offset, 21, method)
    there = check(made, array)
    rng = np.random.default_rng(array.n)
    picked = rng.permutation(
        np.argwhere(there & (made.capability > 0.02 * made.capability[there].max()))
    )
    for row, column in picked[:cells]:
        best = brute(array, made.momentum[row, column], method, count, 12)
        assert made.capability[row, column] >= 0.99 * best
        own = BOUNDS[method](array, made.delta[row, column]).min()
        assert made.capability[row, column] == pytest.approx(own, rel=1e-6)


@pytest.mark.parametrize(
    ("array", "method"),
    [(PYRAMID, "pseudo-inverse"), (PLANAR, "optimal")],
)
def test_against_brute_force(array: nm.CmgArray, method: str) -> None:
    check_against_brute(array, method, 600, 2)


@pytest.mark.slow
@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(
    ("array", "normal", "offset"),
    [
        (PYRAMID, [1, 2, -1], 2.0),
        (FOUR, None, 0.3),
        (custom(2, 4, False), [1, 0, 0], 0.0),
        (custom(3, 5), [0, 1, 1], 0.2),
        (custom(4, 6), None, 0.0),
        (nm.layouts.box90(), [1, 1, 0], 0.5),
        (nm.layouts.roof(), None, 0.0),
        (nm.layouts.pyramid(n=5), None, 0.4),
        (nm.layouts.roof6(rate_limit=0.5).without(1), None, 0.0),
        (nm.layouts.roof6().without(4, frozen_at=0.7), [0, 0, 1], 0.1),
        (nm.layouts.scissored_pairs(), [1, 0.4, 0.2], 0.0),
        (nm.layouts.pyramid().without(2, frozen_at=-1.0), [0, 1, 0], 0.0),
        (custom(5, 3), None, 0.0),
        (planar([1.0, 1.0, 1.0, 1.0]), None, 0.0),
        (planar([1.0, 0.5, 4.0, 0.5], rate_limit=[1, 2, 0.5, 1]), None, 0.0),
        (planar([1.0, 0.5, 2.0, 0.7, 1.2]).without(0, frozen_at=2.0), None, 0.0),
        (nm.layouts.triangle(), None, 0.0),
    ],
)
def test_many_arrays_against_brute_force(array, normal, offset: float, method: str) -> None:
    check_against_brute(array, method, 3000, 4, normal, offset)


def test_maxima_of_the_pyramid() -> None:
    """At no momentum all columns are as a cube's diagonals: A A^T = (4/3) I.

    The pseudo-inverse has its bound n/m; four such columns span a rhombic dodecahedron.
    """
    for method, best in (("pseudo-inverse", 4 / 3), ("optimal", np.sqrt(8 / 3))):
        made = atlas.torque_map(PYRAMID, resolution=5, method=method)
        assert made.capability[2, 2] == pytest.approx(6.0 * best, rel=1e-4)
        assert np.nanmax(made.capability) == made.capability[2, 2]
        assert made.sigma_min[2, 2] == pytest.approx(np.sqrt(4 / 3), rel=1e-3)


def test_two_planar_cmgs_have_one_capability() -> None:
    """Two angles hold a momentum, the elbow up or down, with |sin| of the angle between alike."""
    made = atlas.torque_map(planar([1.0, 1.0]), resolution=11)
    there = check(made, planar([1.0, 1.0]))
    cosine = 0.5 * np.linalg.norm(made.momentum, axis=2)[there] ** 2 - 1.0
    assert made.capability[there] == pytest.approx(np.sqrt(1 - cosine**2), abs=1e-6)


@pytest.mark.parametrize(
    ("h0", "bias"),
    [
        ([1.0, 0.5, 4.0, 0.5], [0.4, -1.3, 0.2]),
        ([1.0, 1.0, 1.0], [0.0, 0.0, 0.0]),
        ([3.0, 1.0], [0.3, 0.0, 0.0]),
    ],
)
def test_planar_arrays_reach_a_ring(h0: list[float], bias: list[float]) -> None:
    array = planar(h0, momentum_bias=bias)
    made = atlas.torque_map(array, resolution=23)
    there = check(made, array)
    size = np.linalg.norm(made.momentum - bias[:2], axis=2)
    inner, outer = max(0.0, 2 * max(h0) - sum(h0)), sum(h0)
    unsure = (np.abs(size - inner) < 1e-6) | (np.abs(size - outer) < 1e-6)
    assert (there == (size >= inner) & (size <= outer))[~unsure].all()
    assert made.x[0] < bias[0] - outer and made.x[-1] > bias[0] + outer
    assert made.y[0] < bias[1] - outer and made.y[-1] > bias[1] + outer


def test_too_few_cmgs_have_no_torque() -> None:
    one = atlas.torque_map(planar([1.0, 0.0]), resolution=5)
    assert np.isnan(one.capability).all()  # no point of the grid is on the circle
    two = PYRAMID.without([0, 1])
    made = atlas.torque_map(two, resolution=11)
    there = check(made, two)
    assert there.any() and (made.capability[there] == 0).all()  # both turn alike, on a line
    assert (made.sigma_min[there] == 0).all()


@pytest.mark.parametrize(
    ("array", "normal", "offset"),
    [
        (custom(7, 3), [1, 0, 0], 0.4),
        pytest.param(custom(5, 3), None, 0.0, marks=pytest.mark.slow),
        pytest.param(custom(2, 4), [0, 1, 0.3], 0.5, marks=pytest.mark.slow),
    ],
)
def test_what_is_not_reached_scipy_does_not_reach(array, normal, offset: float) -> None:
    made = atlas.torque_map(array, normal, offset, 15)
    there = check(made, array)
    rng = np.random.default_rng(1)
    beside = np.zeros_like(there)
    beside[1:-1, 1:-1] = there[2:, 1:-1] | there[:-2, 1:-1] | there[1:-1, 2:] | there[1:-1, :-2]
    picked = rng.permutation(np.argwhere(~there & beside))[:4]
    assert len(picked) == 4
    for row, column in picked:
        wanted = made.momentum[row, column]
        for start in rng.uniform(-np.pi, np.pi, (12, array.n)):
            found = least_squares(lambda x, h=wanted: array.momentum(x) - h, start)
            assert np.abs(found.fun).max() > 1e-6


@pytest.mark.slow
def test_all_of_the_largest_ball_is_reached() -> None:
    array = nm.layouts.pyramid(skew=np.arcsin(0.8))
    ball = atlas.omnidirectional(array, 2e-3)
    made = atlas.torque_map(array, [1, 0, 0], resolution=61)
    size = np.linalg.norm(made.momentum, axis=2)
    assert not np.isnan(made.capability[size < ball.lower]).any()


@pytest.mark.parametrize("method", METHODS)
def test_opposite_momenta_have_opposite_angles(method: str) -> None:
    array = FOUR.altered(momentum_bias=np.array([0.3, -0.1, 0.4]))
    made = atlas.torque_map(array, None, 0.4, 10, method)
    assert np.isfinite(made.capability).any()
    assert made.capability == pytest.approx(made.capability[::-1, ::-1], rel=1e-9, nan_ok=True)
    turned = np.abs(np.cos(0.5 * (made.delta - made.delta[::-1, ::-1])))
    assert np.nanmax(turned) < 1e-6


def test_the_pyramid_is_alike_from_four_sides() -> None:
    made = atlas.torque_map(PYRAMID, resolution=15)
    turned = made.capability.T[:, ::-1]
    assert (np.isnan(made.capability) == np.isnan(turned)).all()
    assert made.capability == pytest.approx(turned, rel=3e-3, abs=1e-3, nan_ok=True)


def test_the_plane_is_the_one_asked_for() -> None:
    array = PYRAMID.without(1, frozen_at=0.7)
    normal = np.array([0.4, -2.0, 1.1])
    made = atlas.torque_map(array, normal, 1.5, 9)
    assert made.momentum @ normal == pytest.approx(np.full((9, 9), 1.5))
    assert made.basis @ made.basis.T == pytest.approx(np.eye(2))
    assert made.basis @ made.origin == pytest.approx(np.zeros(2))
    assert np.cross(*made.basis) @ normal > 0
    assert made.method in made.title
    shown = atlas.torque_map(PYRAMID, resolution=3)
    assert shown.basis.tolist() == [[1, 0, 0], [0, 1, 0]] and (shown.origin == 0).all()


def test_the_grid_covers_the_section() -> None:
    """Random momenta on the plane, found by SciPy, lie within the grid."""
    normal = np.array([0.3, 1.0, -0.5])
    made = atlas.torque_map(FOUR, normal, 1.2, 3)
    rng = np.random.default_rng(1)
    for start in rng.uniform(-np.pi, np.pi, (30, 4)):
        found = least_squares(lambda x: [FOUR.momentum(x) @ normal - 1.2], start)
        place = made.basis @ FOUR.momentum(found.x)
        assert made.x[0] <= place[0] <= made.x[-1] and made.y[0] <= place[1] <= made.y[-1]


def test_stopped_wheels_stay_where_they_are() -> None:
    """They count in nothing but the least rate limit."""
    idle = nm.CmgArray(
        PYRAMID.gimbal_axes, PYRAMID.spin_axes, [1.0, 0.0, 1.0, 2.0], [2.0, 0.5, 1.0, 1.0]
    )
    made = atlas.torque_map(idle, None, 0.2, 9)
    there = check(made, idle)
    assert there.any() and (made.delta[there][:, 1] == 0).all()
    fewer = atlas.torque_map(idle.without(1), None, 0.2, 9)
    assert made.capability == pytest.approx(fewer.capability, rel=1e-6, nan_ok=True)


def test_no_rate_limit_is_one_radian_per_second() -> None:
    free = planar([2.0, 1.0, 1.0])
    a, b = (
        atlas.torque_map(array, resolution=7)
        for array in (free, free.altered(rate_limit=np.ones(3)))
    )
    assert a.capability == pytest.approx(b.capability, nan_ok=True)
    some = free.altered(rate_limit=np.array([1.0, np.inf, 0.5]))
    check(atlas.torque_map(some, resolution=7, method="optimal"), some)


def test_progress_grows_to_one_and_may_interrupt() -> None:
    told: list[float] = []
    atlas.torque_map(PYRAMID, resolution=7, progress=told.append)
    assert told == sorted(told) and told[-1] == 1.0 and len(told) > 5 and min(told) >= 0

    def stop(share: float) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        atlas.torque_map(PYRAMID, resolution=7, progress=stop)


@pytest.mark.parametrize(
    ("call", "key"),
    [
        (lambda: atlas.torque_map(PYRAMID, [0, 0, 0]), "normal"),
        (lambda: atlas.torque_map(PYRAMID, [0, 0, np.nan]), "normal"),
        (lambda: atlas.torque_map(PYRAMID, [0, 1]), "normal"),
        (lambda: atlas.torque_map(PYRAMID, np.eye(3)), "normal"),
        (lambda: atlas.torque_map(PYRAMID, "z"), "normal"),
        (lambda: atlas.torque_map(planar([1.0, 1.0]), [0, 0, 1]), "normal"),
        (lambda: atlas.torque_map(planar([1.0, 1.0]), offset=0.5), "offset"),
        (lambda: atlas.torque_map(PYRAMID, offset=9.9), "offset"),  # 4 h0 sin(54.74 deg) = 9.798
        (lambda: atlas.torque_map(PYRAMID, offset=np.nan), "offset"),
        (lambda: atlas.torque_map(PYRAMID, offset="far"), "offset"),
        (lambda: atlas.torque_map(PYRAMID, resolution=2), "resolution"),
        (lambda: atlas.torque_map(PYRAMID, resolution=30.0), "resolution"),
        (lambda: atlas.torque_map(PYRAMID, resolution=10_000), "resolution"),
        (lambda: atlas.torque_map(PYRAMID, method="local-gradient"), "method"),
        (lambda: atlas.torque_map(PYRAMID.altered(torque_axes=np.eye(3)[:1])), "array"),
        (lambda: atlas.surface_torque(PYRAMID, atlas.surfaces(FIVE, 50)[0]), "surface"),
        (lambda: atlas.surface_torque(PYRAMID, atlas.surfaces(PYRAMID, 50)[0], "all"), "measure"),
    ],
)
def test_bad_input_is_refused(call: Callable[[], object], key: str) -> None:
    with pytest.raises(nm.InputError) as error:
        call()
    assert error.value.key == key


@pytest.mark.parametrize("array", [FOUR, FIVE, PLANAR])
@pytest.mark.parametrize("method", METHODS)
def test_slopes_of_the_bounds(array: nm.CmgArray, method: str) -> None:
    spin = array.rotor_momenta(np.zeros(array.n))
    torque = array.rotor_momenta(np.full(array.n, np.pi / 2))
    limits = limits_of(array)

    def bounds(delta: np.ndarray) -> list[torque_bounds.Bound]:
        return METHODS[method](torque_bounds.state(spin, torque, delta), limits)

    delta = np.random.default_rng(8).uniform(-np.pi, np.pi, array.n)
    found = bounds(delta)
    expected = np.log(BOUNDS[method](array, delta))
    assert [b.value for b in found] == pytest.approx(expected, abs=1e-6)
    slopes = approx_fprime(delta, lambda x: np.array([b.value for b in bounds(x)]), 1e-7)
    assert np.array([b.slope for b in found], float) == pytest.approx(slopes, abs=2e-5)


@pytest.mark.parametrize(
    "array",
    [PYRAMID, nm.layouts.box90(), custom(3, 6), custom(6, 3), PYRAMID.without([0, 1])],
)
def test_torque_left_on_a_surface(array: nm.CmgArray) -> None:
    for surface in atlas.surfaces(array, 200)[:3]:
        sigma = np.linalg.svd(array.unit_jacobian(surface.delta), compute_uv=False)
        assert atlas.surface_torque(array, surface) == pytest.approx(sigma[:, 1], abs=1e-7)
        across = np.linalg.svd(surface.u[:, None])[2][:, 1:]  # bases of the planes, not ours
        A = across @ array.jacobian(surface.delta)
        regular = np.linalg.svd(A, compute_uv=False)[:, -1] > 1e-6
        inverse = np.linalg.pinv(A[regular])
        rows = (limits_of(array) / np.linalg.norm(inverse, axis=2).clip(1e-12)).min(axis=1)
        found = atlas.surface_torque(array, surface, "pseudo-inverse")
        assert found[regular] == pytest.approx(rows, rel=1e-6)
        best = atlas.surface_torque(array, surface, "optimal")
        for k in np.flatnonzero(regular)[::40]:
            signs = np.array(list(product((-1.0, 1.0), repeat=array.n)))
            hull = ConvexHull((signs * limits_of(array)) @ A[k].T)
            assert best[k] == pytest.approx(-hull.equations[:, -1].max(), rel=1e-6)


def test_torque_left_in_a_plane() -> None:
    """Where a planar array is singular, all columns are along one line across u."""
    array, sizes = PLANAR, np.asarray(PLANAR.h0)
    surface = atlas.surfaces(array, 60)[1]
    sigma = np.linalg.norm(sizes) / array.mean_momentum
    assert atlas.surface_torque(array, surface) == pytest.approx(np.full(len(surface.u), sigma))
    best = sizes @ array.rate_limit
    found = atlas.surface_torque(array, surface, "optimal")
    assert found == pytest.approx(np.full(len(surface.u), best))
    shared = (sizes @ sizes) / np.max(sizes / array.rate_limit)
    linear = atlas.surface_torque(array, surface, "pseudo-inverse")
    assert linear == pytest.approx(np.full(len(surface.u), shared))


@pytest.mark.slow
def test_large_maps_are_quick() -> None:
    """The seconds of a processor that others may share; a free one takes half of it."""
    from time import process_time

    for array, most in ((nm.layouts.pyramid(), 8.0), (nm.layouts.pyramid(n=8), 20.0)):
        start = process_time()
        made = atlas.torque_map(array)
        assert process_time() - start < most
        assert np.isfinite(made.capability).sum() > 4000
