"""How far a torque capability holds: closed forms, rays of our own, singular curves, bad input."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import brentq

from nullmotion import guarantee
from nullmotion.errors import InputError
from nullmotion.guarantee.radius import (
    guaranteed_radius,
    least_capabilities,
    least_capability,
    volume,
)
from nullmotion.guarantee.singular import nearest_singular

# envelope, TC >= 0.5, TC >= 1: an independent implementation, by sampling and SQP
KNOWN = {"box90-cubic": {0.0: 1.790, 0.5: 1.391, 1.0: 0.744}}


def first_losses(constraint, level, directions, steps=400):
    """Return where TC first falls below a level on each ray: sampled, then halved."""
    sizes = constraint.reach * np.arange(1, steps + 1) / steps
    lost = constraint.torque_capability(sizes[:, None, None] * directions) < max(level, 1e-12)
    high = sizes[lost.argmax(axis=0)]
    low = high - sizes[0]
    for _ in range(30):
        middle = (low + high) / 2
        gone = constraint.torque_capability(middle[:, None] * directions) < max(level, 1e-12)
        low, high = np.where(gone, low, middle), np.where(gone, middle, high)
    return high


def unit(rng, count, m=3):
    u = rng.normal(size=(count, m))
    return u / np.linalg.norm(u, axis=1, keepdims=True)


@pytest.mark.parametrize("level", [0.0, 0.5, 1.0])
def test_the_cubic_bias_comes_back(level):
    found = guaranteed_radius(guarantee.create("box90-cubic"), level)
    assert found.value == pytest.approx(KNOWN["box90-cubic"][level], abs=1e-3)
    assert np.linalg.norm(found.momentum) == pytest.approx(found.value, rel=1e-12)


@pytest.mark.parametrize("level", [0.0, 0.3, 1.0, 1.9])
def test_scissored_pairs_in_closed_form(level):
    """TC = min sqrt(4 - h_i^2): radius sqrt(4 - t^2), a cube of momenta."""
    pairs = guarantee.create("scissored-pairs")
    radius = np.sqrt(4 - level**2)
    assert guaranteed_radius(pairs, level).value == pytest.approx(radius, rel=1e-9)
    found = volume(pairs, level, points=2**16)
    assert abs(found.value - 8 * radius**3) < 6 * found.standard_error + 1e-3 * radius**3
    if level:
        assert least_capability(pairs, radius) == pytest.approx(level, rel=1e-9)


@pytest.mark.parametrize("n", [4, 5])
def test_planar_in_closed_form(n):
    """A disc of radius n; TC is n/2 in the static region, without a direction."""
    planar = guarantee.create("planar", n=n)
    assert guaranteed_radius(planar, 0).value == pytest.approx(n, rel=1e-9)
    assert least_capability(planar, 0.5) == pytest.approx(n / 2, rel=1e-12)
    found = volume(planar, 0, points=2**16)
    assert abs(found.value - np.pi * n**2) < 6 * found.standard_error + 0.01
    size = guaranteed_radius(planar, 1.0).value
    assert planar.torque_capability([size, 0.0]) == pytest.approx(1.0, abs=1e-7)


@pytest.mark.sampled(2)
@pytest.mark.parametrize("name", ["box90-cubic", "box90-designed", "roof6", "orthogonal-pairs"])
def test_no_ray_is_lost_earlier(name, rng):
    """20,000 random rays come close to the radius and not below it; TC on it is the level."""
    constraint = guarantee.create(name)
    found = guaranteed_radius(constraint, 0.6)
    losses = first_losses(constraint, 0.6, unit(rng, 20_000))
    assert found.value <= losses.min() < found.value + 0.01
    inside, outside = (constraint.torque_capability(s * found.momentum) for s in (1 - 1e-8, 1.0))
    assert outside < 0.6 <= inside
    assert least_capability(constraint, found.value) == pytest.approx(0.6, abs=1e-6)


def test_least_capability_lies_below_every_sample(rng):
    constraint = guarantee.create("box90-cubic")
    sizes = np.array([0.2, 0.9, 1.5])
    sampled = constraint.torque_capability(sizes[:, None, None] * unit(rng, 100_000)).min(axis=1)
    least = least_capabilities(constraint, sizes)
    assert (least <= sampled).all() and (sampled - least < 3e-3).all()


def test_the_spherical_bias_has_a_singularity_that_rays_do_not_see(rng):
    """Saturation begins at 1.850, but a plane has no momentum to hold at 1.835 already."""
    constraint = guarantee.create("box90-spherical")
    seen = first_losses(constraint, 0.0, unit(rng, 10_000)).min()
    found = guaranteed_radius(constraint, 0)
    assert seen == pytest.approx(1.850, abs=5e-3)
    assert found.value == pytest.approx(1.8347, abs=1e-4)
    assert constraint.torque_capability(found.momentum) < 1e-6
    beside = found.momentum + 1e-3 * unit(rng, 100)
    assert (constraint.torque_capability(beside) > 0).all()
    parts = constraint.parts(found.momentum)
    assert min(np.linalg.norm(p) for p in parts) < 1e-8
    assert max(np.linalg.norm(p) for p in parts) < 1.9
    for level in (0.02, 0.1):  # a tube around the curve
        less = guaranteed_radius(constraint, level)
        assert less.value < found.value
        assert constraint.torque_capability(less.momentum) == pytest.approx(level, abs=1e-6)


@pytest.mark.parametrize(
    ("name", "expected"),
    [("box90-cubic", 1.9476), ("box90-spherical", 1.8347), ("box90-designed", 1.9725)],
)
def test_the_singular_curve(name, expected):
    """Its least |h|, beside roots of Psi(h_x, 0, h_z) = h_x along lines of constant h_x."""
    constraint = guarantee.create(name)
    point = nearest_singular(constraint)
    assert point is not None
    size = np.linalg.norm(point)
    assert size == pytest.approx(expected, abs=1e-4)

    def miss(h_z, h_x):
        return constraint.bias(np.array([h_x, 0.0, h_z]))[0] - h_x

    found = []
    for h_x in np.linspace(0.0, 1.9, 96):
        top = np.sqrt(4 - h_x**2) - 1e-9
        steps = np.linspace(0, top, 20)
        values = [miss(z, h_x) for z in steps]
        k = np.nonzero(np.diff(np.sign(values)))[0]
        if len(k):
            found.append(np.hypot(h_x, brentq(miss, steps[k[0]], steps[k[0] + 1], (h_x,))))
    assert size <= min(found) + 1e-9 and min(found) < size + 2e-3


def test_planes_without_parts_have_no_singular_curve():
    assert nearest_singular(guarantee.create("scissored-pairs")) is None
    assert nearest_singular(guarantee.create("planar")) is None


def test_a_face_of_the_envelope_is_found():
    """TC does not fall to 0 there, it ends: |h_x| <= extent."""
    pairs = guarantee.create("orthogonal-pairs", extent=1.0)
    found = guaranteed_radius(pairs, 0)
    assert found.value == pytest.approx(1.0, abs=1e-7)
    assert np.abs(found.momentum).max() == pytest.approx(1.0, abs=1e-7)


def test_more_than_there_is_holds_nowhere():
    cubic = guarantee.create("box90-cubic")
    found = guaranteed_radius(cubic, 1.4)
    assert found.value == 0 and (found.momentum == 0).all()
    assert volume(cubic, 2.0, points=2**12).value == 0


def test_search_is_deterministic():
    cubic = guarantee.create("box90-cubic")
    first, again = (guaranteed_radius(cubic, 0.8) for _ in range(2))
    assert first.value == again.value and (first.momentum == again.momentum).all()


@pytest.mark.parametrize("level", [-0.1, np.nan, np.inf])
def test_bad_torque_capability(level):
    cubic = guarantee.create("box90-cubic")
    for search in (guaranteed_radius, volume):
        with pytest.raises(InputError, match="torque_capability"):
            search(cubic, level)


@pytest.mark.parametrize("radius", [-1.0, np.nan, np.inf])
def test_bad_radius(radius):
    with pytest.raises(InputError, match="radius"):
        least_capability(guarantee.create("box90-cubic"), radius)
