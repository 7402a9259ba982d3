"""The momentum envelope: printed values, closed forms, symmetries, degenerate arrays, bad input."""

from __future__ import annotations

import signal
import time
from collections.abc import Callable
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


@pytest.mark.parametrize(
    "array, radius, greatest",
    [
        (nm.layouts.box90(), 2.0, 2 * np.sqrt(5.0)),
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
    "array, exact",
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


def test_three_cmgs_have_circles_in_closed_form() -> None:
    array = circle_and_disc(0.5, 2.0)
    assert omnidirectional(array).value == pytest.approx(2.0 - 0.5 + 0.0, rel=1)
    found = volume(array, tolerance=0.15)
    exact = two_discs(0.5, 2.0)
    assert found.lower <= exact <= found.upper and found.gap <= 0.15
    assert found.value == pytest.approx(exact, rel=0.01)
