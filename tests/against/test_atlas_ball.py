"""The envelope against random gimbal angles, root finding by SciPy, and closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import least_squares

import nullmotion as nm
from nullmotion import atlas

PYRAMID = nm.layouts.pyramid(skew=np.arcsin(0.8))
STATES = 10_000_000
NEAR = 0.12  # [N m s]: a momentum this near to a sampled one is reached from it


def momentum(array, delta):
    """Sum of the rotors' momenta: not the project's code."""
    total = np.zeros((*delta.shape[:-1], 3))
    for i in range(array.n):
        s, g = array.spin_axes[i], array.gimbal_axes[i]
        c, d = np.cos(delta[..., i, None]), np.sin(delta[..., i, None])
        total += array.h0[i] * (c * s + d * np.cross(g, s))
    return total @ array.torque_axes.T


def held(array, h, starts, rng):
    """Whether SciPy finds gimbal angles with this momentum."""
    for _ in range(starts):
        start = rng.uniform(-np.pi, np.pi, array.n)
        found = least_squares(lambda x: momentum(array, x) - h, start, xtol=1e-15, ftol=1e-15)
        if np.abs(found.fun).max() < 1e-8:
            return True
    return False


def random_array(rng, n):
    g = rng.normal(size=(n, 3))
    g /= np.linalg.norm(g, axis=1, keepdims=True)
    s = np.cross(g, rng.normal(size=(n, 3)))
    s /= np.linalg.norm(s, axis=1, keepdims=True)
    return nm.CmgArray(g, s, h0=rng.uniform(0.5, 2.0, n))


def directions(rng, count, m=3):
    u = rng.normal(size=(count, m))
    return u / np.linalg.norm(u, axis=1, keepdims=True)


def test_the_printed_numbers():
    ball, most = atlas.omnidirectional(PYRAMID), atlas.max_momentum(PYRAMID)
    assert 2.521 < ball.lower <= ball.upper < 2.523
    assert (ball.upper - ball.lower) / ball.upper < 0.005 and ball.basis.startswith("proven")
    assert most.lower == pytest.approx(3.29848, abs=1e-5) and most.upper - most.lower < 1e-6
    assert np.linalg.norm(ball.at) == pytest.approx(ball.upper)


@pytest.mark.slow
def test_ten_million_random_states_find_nothing_against_it():
    """None is where nothing can be, all around the ball there are some, none is beyond the most."""
    ball, most = atlas.omnidirectional(PYRAMID), atlas.max_momentum(PYRAMID)
    rng = np.random.default_rng(8)
    turns = [np.diag(d) for d in ((1, 1, 1), (-1, -1, 1), (-1, -1, -1), (1, 1, -1))]
    quarter = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    holes = np.array([t @ q @ ball.at for t in turns for q in (np.eye(3), quarter)])
    wanted = ball.lower * directions(rng, 400)
    nearest, empty, largest = np.full(len(wanted), np.inf), np.inf, 0.0
    for _ in range(STATES // 500_000):
        h = momentum(PYRAMID, rng.uniform(-np.pi, np.pi, (500_000, 4)))
        size = np.linalg.norm(h, axis=1)
        largest = max(largest, float(size.max()))
        shell = h[np.abs(size - ball.upper) < 0.2]
        for hole in holes:
            empty = min(empty, float(np.linalg.norm(shell - hole, axis=1).min()))
        for i, w in enumerate(wanted):
            nearest[i] = min(nearest[i], float(np.linalg.norm(shell - w, axis=1).min()))
    assert largest <= most.upper and largest > 0.99 * most.lower
    assert empty > 0  # the proven momentum has a neighbourhood: how wide, the next test says
    assert nearest.max() < NEAR
    assert sum(held(PYRAMID, w, 40, rng) for w in wanted[nearest.argsort()[-60:]]) == 60


@pytest.mark.slow
def test_where_the_ball_ends_nothing_is_found(rng):
    ball = atlas.omnidirectional(PYRAMID)
    assert not held(PYRAMID, ball.at, 60, rng)
    inward = ball.at * (1 - 4e-3)
    assert held(PYRAMID, inward, 200, rng)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(5))
def test_random_arrays_hold_what_is_inside_and_not_what_is_at_the_end(seed):
    rng = np.random.default_rng(seed)
    array = random_array(rng, int(rng.integers(3, 8)))
    ball = atlas.omnidirectional(array, 2e-3)
    assert 0 <= ball.lower <= ball.upper
    inside = rng.uniform(0.6, 1.0, (12, 1)) * ball.lower * directions(rng, 12)
    assert all(held(array, h, 120, rng) for h in inside)
    if ball.upper > 0:
        assert not held(array, 1.0001 * ball.at, 60, rng)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(3))
def test_reach_ends_where_root_finding_ends(seed):
    rng = np.random.default_rng(100 + seed)
    array = PYRAMID if seed % 2 else random_array(rng, int(rng.integers(4, 7)))
    u = directions(rng, 1)[0]
    along = atlas.reach(array, u)
    assert along.lower <= along.upper <= atlas.max_momentum(array).upper * (1 + 1e-12)
    assert (along.upper - along.lower) / along.upper < 5e-3
    for share in (0.5, 0.9, 0.999):
        assert held(array, share * along.lower * u, 150, rng)
    assert not held(array, 1.001 * along.upper * u, 60, rng) or not held(array, along.at, 60, rng)


def test_closed_forms():
    annulus = nm.layouts.planar(n=3, h0=[1.0, 1.0, 5.0])
    assert atlas.omnidirectional(annulus).upper == 0.0  # no momentum at all below 3 N m s
    area = atlas.volume(annulus, 0.01)
    exact = np.pi * (49 - 9)
    assert area.lower <= exact <= area.upper and area.value == pytest.approx(exact, rel=0.01)
    disc = nm.layouts.planar(n=5, h0=2.0)
    assert atlas.omnidirectional(disc).lower == pytest.approx(10.0, rel=1e-6)
    box = atlas.omnidirectional(nm.layouts.box90(h0=3.0))
    assert box.lower == pytest.approx(6.0, rel=1e-6) == box.upper
    one = nm.CmgArray([[0, 0, 1.0]], [[1.0, 0, 0]])
    assert atlas.omnidirectional(one).upper == 0 and atlas.volume(one).upper == 0
    assert atlas.max_momentum(one).upper == pytest.approx(1.0)


def test_volume_of_two_crossed_discs():
    """box-90: (x1, y) in one disc of radius 2, (x2, z) in another, x = x1 + x2."""
    rng = np.random.default_rng(3)
    array = nm.layouts.box90()
    found = atlas.volume(array, 0.02)
    h = rng.uniform(-1, 1, (200_000, 3)) * np.array([4.0, 2.0, 2.0])
    inside = np.abs(h[:, 0]) <= np.sqrt(4 - h[:, 1] ** 2) + np.sqrt(4 - h[:, 2] ** 2)
    exact = inside.mean() * 8 * 4 * 2 * 2
    assert found.lower <= exact * 1.01 and found.upper >= exact * 0.99
    assert found.value == pytest.approx(exact, rel=0.02)


@pytest.mark.slow
def test_volume_of_the_pyramid_by_random_momenta():
    found, rng = atlas.volume(PYRAMID), np.random.default_rng(4)
    side = atlas.max_momentum(PYRAMID).upper
    h = rng.uniform(-side, side, (120, 3))
    share = np.mean([np.linalg.norm(w) <= side and held(PYRAMID, w, 25, rng) for w in h])
    spread = 3 * np.sqrt(share * (1 - share) / len(h))
    volume = (2 * side) ** 3
    assert (share - spread) * volume <= found.upper
    assert (share + spread) * volume >= found.lower


@pytest.mark.slow
def test_sizes_scale_and_turn_with_the_array():
    array = nm.layouts.pyramid(n=5, h0=2.5)
    small = nm.layouts.pyramid(n=5)
    one, two = atlas.omnidirectional(array, 1e-3), atlas.omnidirectional(small, 1e-3)
    assert one.lower <= 2.5 * two.upper and 2.5 * two.lower <= one.upper
    frozen = small.without(0, 0.7)
    gone = small.without(0)
    assert atlas.omnidirectional(frozen).lower == pytest.approx(atlas.omnidirectional(gone).lower)
    dead = nm.layouts.pyramid(n=5, h0=[0.0, 1, 1, 1, 1])
    assert atlas.omnidirectional(dead).lower == pytest.approx(atlas.omnidirectional(gone).lower)


def test_bad_input_is_refused():
    for tolerance in (0.0, 0.6, np.nan):
        with pytest.raises(nm.InputError, match="tolerance"):
            atlas.omnidirectional(PYRAMID, tolerance)
    with pytest.raises(nm.InputError, match="direction"):
        atlas.reach(PYRAMID, [0, 0, 0])
    with pytest.raises(nm.InputError, match="direction"):
        atlas.reach(PYRAMID, np.eye(3))


def test_work_tells_its_progress_and_stops(monkeypatch):
    seen = []
    atlas.omnidirectional(PYRAMID, progress=seen.append)
    assert seen == sorted(seen) and seen[0] >= 0 and seen[-1] <= 1

    def stop(share):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        atlas.omnidirectional(PYRAMID, progress=stop)
