"""The momentum envelope: printed values, closed forms, symmetries, degenerate arrays, bad input."""

from __future__ import annotations

import signal
import time
from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.spatial.transform import Rotation

import nullmotion as nm
from nullmotion.atlas.envelope import max_momentum, omnidirectional, reach, volume
from nullmotion.errors import InputError

PYRAMID = nm.layouts.pyramid(skew=np.arcsin(0.8))
X, Y, Z = np.eye(3)


def made(gimbal: Any, spin: Any, h0: Any, **more: Any) -> nm.CmgArray:
    """Return an array of plain lists of axes."""
    return nm.CmgArray(np.array(gimbal, float), np.array(spin, float), h0, **more)


def planar(*h0: float) -> nm.CmgArray:
    """Return CMGs with one gimbal axis in common."""
    return made([Z] * len(h0), [X] * len(h0), list(h0))


def circle_and_disc(circle: float, disc: float) -> nm.CmgArray:
    """Return a CMG that turns in x, y and a pair that fills a disc in x, z."""
    return made([Z, Y, Y], [X, X, X], [circle, 0.5 * disc, 0.5 * disc])


def test_the_published_pyramid() -> None:
    found = omnidirectional(PYRAMID)
    assert 2.521 <= found.lower <= found.upper <= 2.523
    assert found.gap <= 0.005 and found.basis.startswith("proven")
    assert found.at is not None
    assert np.linalg.norm(found.at) == pytest.approx(found.upper, rel=1e-12)
    assert max_momentum(PYRAMID).value == pytest.approx(3.29848, abs=1e-5)


def test_the_greatest_momentum_is_proven_and_held() -> None:
    found = max_momentum(PYRAMID)
    assert found.at is not None and found.gap < 1e-7
    assert np.linalg.norm(found.at) == pytest.approx(found.lower, rel=1e-12)
    u = found.at / found.lower
    h = sum(
        p / np.linalg.norm(p)
        for p in u - np.outer(PYRAMID.gimbal_axes @ u, 1) * PYRAMID.gimbal_axes
    )
    assert h == pytest.approx(found.at, abs=1e-4)


@pytest.mark.sampled(4)
@pytest.mark.parametrize(
    ("array", "radius", "greatest"),
    [
        (nm.layouts.box90(), 2.0, 4.0),
        (nm.layouts.planar(n=5), 5.0, 5.0),
        (nm.layouts.triangle(), 3.0, 3.0),
        (nm.layouts.scissored_pairs(), 4.0, None),
        (nm.layouts.orthogonal_pairs(), 4.0, 2 * np.sqrt(6.0)),
        (planar(1.0, 1.0), 2.0, 2.0),
        (planar(1.0, 4.0, 1.0), 0.0, 6.0),
        (planar(2.0), 0.0, 2.0),
        (made([Z, Y], [X, X], [1.0, 2.0], torque_axes=[X]), 3.0, 3.0),
        (made([Z], [X], [2.0], torque_axes=np.eye(3)), 0.0, 2.0),
        (made([Z, X], [X, Y], [1.0, 1.0]), 0.0, 2.0),
    ],
)
def test_radii_in_closed_form(array: nm.CmgArray, radius: float, greatest: float | None) -> None:
    found, most = omnidirectional(array), max_momentum(array)
    assert found.lower - 1e-9 <= radius <= found.upper + 1e-9 and found.upper - found.lower < 1e-3
    assert greatest is None or most.value == pytest.approx(greatest, rel=1e-7)
    assert most.lower <= most.upper
    assert reach(array, np.arange(1.0, array.m + 1)).upper <= most.upper * (1 + 1e-9)


def two_discs(circle: float, disc: float) -> float:
    """Return the volume of a circle in x, y and a disc in x, z: at each y two discs overlap."""

    def area(y: float) -> float:
        apart = 2 * np.sqrt(circle**2 - y * y)
        if apart >= 2 * disc:
            return 2 * np.pi * disc**2
        lens = 2 * disc**2 * np.arccos(apart / (2 * disc))
        return 2 * np.pi * disc**2 - lens + 0.5 * apart * np.sqrt(4 * disc**2 - apart**2)

    found: float = quad(area, -circle, circle)[0]
    return found


@pytest.mark.parametrize(
    ("array", "exact"),
    [
        (nm.layouts.box90(), 32 * np.pi),
        (planar(1.0, 1.0), 4 * np.pi),
        (planar(1.0, 2.0), 8 * np.pi),
        (planar(1.0, 4.0, 1.0), 32 * np.pi),
        (made([Z, Y], [X, X], [1.0, 2.0], torque_axes=[X]), 6.0),
        (made([Z, X], [X, Y], [1.0, 1.0]), 0.0),
        (planar(2.0), 0.0),
    ],
)
def test_volumes_in_closed_form(array: nm.CmgArray, exact: float) -> None:
    found = volume(array)
    assert found.lower * (1 - 1e-9) <= exact <= found.upper * (1 + 1e-9)
    assert found.gap <= 0.05 and found.value == pytest.approx(exact, rel=0.01, abs=1e-12)


@pytest.mark.parametrize(
    ("circle", "disc", "radius"),
    [(0.5, 2.0, 0.5), pytest.param(1.0, 1.0, 0.0, marks=pytest.mark.slow)],
)
def test_the_radius_of_a_circle_and_a_disc(circle: float, disc: float, radius: float) -> None:
    """As large as the disc the circle leaves no room above the origin, which is reachable."""
    found = omnidirectional(circle_and_disc(circle, disc), tolerance=0.02)
    assert found.lower <= radius <= found.upper <= radius + 0.02


@pytest.mark.slow
@pytest.mark.parametrize(("circle", "disc"), [(0.5, 2.0), (1.0, 1.0), (1.5, 1.0)])
def test_the_volume_of_a_circle_and_a_disc(circle: float, disc: float) -> None:
    found, exact = volume(circle_and_disc(circle, disc), 0.2), two_discs(circle, disc)
    assert found.lower <= exact <= found.upper and found.gap <= 0.2
    assert found.value == pytest.approx(exact, rel=0.01)


def test_a_hole_is_not_in_reach() -> None:
    found = reach(circle_and_disc(1.0, 1.0), [1.0, 1.0, 1.0])  # s^2 <= 2 s sqrt(1 - s^2)
    exact = np.sqrt(3) * 2 / np.sqrt(5)
    assert found.lower - 1e-4 <= exact <= found.upper and found.gap < 1e-3
    assert found.at is not None and found.at == pytest.approx(np.full(3, found.upper / np.sqrt(3)))


FAILED = {
    "removed": PYRAMID.without(1),
    "frozen": PYRAMID.without(1, 0.3),
    "idle": made(PYRAMID.gimbal_axes, PYRAMID.spin_axes, [1.0, 0.0, 1.0, 1.0]),
    "other": PYRAMID.without(2, -1.0),
}


@pytest.mark.slow
def test_a_failed_cmg_counts_for_nothing_however_it_failed() -> None:
    """Its frozen momentum is bias, which is left out; by symmetry it does not matter which."""
    radii = [omnidirectional(array, tolerance=0.05) for array in FAILED.values()]
    greatest = [max_momentum(array).value for array in FAILED.values()]
    assert greatest == pytest.approx([greatest[0]] * 4, rel=1e-7)
    assert max(r.lower for r in radii) <= min(r.upper for r in radii)
    assert all(r.gap <= 0.051 for r in radii) and max(r.upper for r in radii) < 1.7


@pytest.mark.slow
def test_the_unit_and_the_frame_of_momentum_do_not_matter() -> None:
    array = nm.CmgArray(PYRAMID.gimbal_axes, PYRAMID.spin_axes, [1.0, 1.2, 0.7, 0.9])
    turn = Rotation.from_rotvec([0.3, -0.5, 0.9])
    turned = nm.CmgArray(turn.apply(array.gimbal_axes), turn.apply(array.spin_axes), 50 * array.h0)
    one, other = (omnidirectional(a, tolerance=0.005) for a in (array, turned))
    assert 50 * one.lower <= other.upper and other.lower <= 50 * one.upper
    assert other.gap <= 0.0051
    assert max_momentum(turned).value == pytest.approx(50 * max_momentum(array).value, rel=1e-7)
    along = np.array([0.2, -1.0, 0.5])
    ahead = reach(array, along, 0.005), reach(turned, turn.apply(along), 0.005)
    assert 50 * ahead[0].lower <= ahead[1].upper and ahead[1].lower <= 50 * ahead[0].upper
    scaled = nm.CmgArray(array.gimbal_axes, array.spin_axes, 2 * array.h0)
    again = omnidirectional(scaled, tolerance=0.005)
    assert (again.lower, again.upper) == pytest.approx((2 * one.lower, 2 * one.upper), rel=1e-9)


@pytest.mark.slow
def test_no_direction_reaches_less_than_the_ball(rng: np.random.Generator) -> None:
    ball = omnidirectional(PYRAMID, tolerance=0.01)
    assert ball.at is not None
    found = [reach(PYRAMID, u, tolerance=0.01) for u in [ball.at, *rng.normal(size=(4, 3))]]
    assert all(r.upper >= ball.lower for r in found)
    assert found[0].lower <= ball.upper
    assert all(r.upper <= max_momentum(PYRAMID).upper for r in found)


def test_bounds_that_are_not_closed_say_so() -> None:
    found = omnidirectional(PYRAMID, budget=500)
    assert "not closed within 500 cells" in found.basis
    assert found.lower <= 2.5215 and found.upper >= 2.5225
    found = volume(PYRAMID, budget=2000)
    assert "not closed within 2000 cells" in found.basis
    assert found.lower < 121 < found.upper and found.value == pytest.approx(121.4, rel=0.02)


@pytest.mark.parametrize("measure", [omnidirectional, volume])
def test_progress_grows_to_the_end(measure: Callable[..., Any]) -> None:
    seen: list[float] = []
    measure(PYRAMID, tolerance=0.4, progress=seen.append)
    assert len(seen) > 3 and seen[-1] == pytest.approx(1.0)
    assert all(0 <= a <= b <= 1 for a, b in pairwise(seen))


@pytest.mark.parametrize("measure", [omnidirectional, volume])
def test_ctrl_c_leaves_at_once(measure: Callable[..., Any]) -> None:
    measure(PYRAMID, budget=10)  # compiles
    start = time.perf_counter()
    signal.setitimer(signal.ITIMER_REAL, 0.4)
    before = signal.signal(signal.SIGALRM, signal.default_int_handler)
    try:
        with pytest.raises(KeyboardInterrupt):
            measure(PYRAMID, tolerance=1e-6, budget=10**7)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    assert time.perf_counter() - start < 3.0


def test_bad_input_is_refused() -> None:
    for tolerance in (0.0, -1.0, 0.6, np.nan):
        for measure in (omnidirectional, volume, lambda a, tolerance: reach(a, X, tolerance)):
            with pytest.raises(InputError, match="tolerance"):
                measure(PYRAMID, tolerance=tolerance)
    for direction in ([0.0, 0.0, 0.0], [1.0, 0.0], np.eye(3), [np.nan, 0.0, 1.0]):
        with pytest.raises(InputError, match="direction"):
            reach(PYRAMID, direction)


def test_bounds_are_plain_data() -> None:
    found = max_momentum(PYRAMID).as_dict()
    assert set(found) == {"lower", "upper", "at", "basis", "seconds"}
    assert [type(v) for v in found["at"]] == [float] * 3 and found["basis"] == "proven"
    assert volume(planar(1.0, 1.0)).as_dict()["estimate"] == pytest.approx(4 * np.pi, rel=1e-3)
    flat = volume(planar(1.0))
    assert (flat.value, flat.gap, flat.at) == (0.0, 0.0, None)
