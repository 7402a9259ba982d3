"""Constraint functions: momentum met, torque capability against NumPy's inverses, bad input."""

from __future__ import annotations

import numpy as np
import pytest

import nullmotion as nm
from nullmotion.errors import InputError, UnknownNameError

_COUNTS = range(3, 16)
_SPATIAL = [n for n in nm.guarantee.names() if n not in ("planar", "backbone")]


def _plane(rng: np.random.Generator, reach: float, count: int = 200) -> np.ndarray:
    angle, size = rng.uniform(-np.pi, np.pi, count), rng.uniform(0, reach, count)
    return np.stack([size * np.cos(angle), size * np.sin(angle)], axis=1)


def _inside(name: str, rng: np.random.Generator, count: int = 400) -> np.ndarray:
    constraint = nm.guarantee.create(name)
    h = rng.uniform(-2.0, 2.0, (count, 3))
    return h[constraint.torque_capability(h) > 0.02]


def _rows(A: np.ndarray) -> np.ndarray:
    return np.linalg.norm(np.linalg.pinv(A), axis=-1)


@pytest.mark.sampled(4)
@pytest.mark.parametrize("n", _COUNTS)
def test_planar_meets_momentum_and_equals_the_pseudo_inverse(
    n: int, rng: np.random.Generator
) -> None:
    """h(delta) = h; TC is 1 over the greatest row of NumPy's pinv."""
    constraint = nm.guarantee.create("planar", n=n)
    h = _plane(rng, 0.9999 * n)
    delta, array = constraint.gimbal_angles(h), constraint.array()
    assert np.abs(array.momentum(delta) - h).max() < 1e-12
    expected = 1 / _rows(array.jacobian(delta)).max(axis=-1)
    assert np.abs(constraint.torque_capability(h) / expected - 1).max() < 1e-9


@pytest.mark.sampled(3)
@pytest.mark.parametrize("n", [n for n in _COUNTS if n > 3])
def test_planar_static_region(n: int, rng: np.random.Generator) -> None:
    """Every row is 2/n and det A A^T = n^2/4 below H_c; continuous at H_c."""
    constraint = nm.guarantee.create("planar", n=n)
    A = constraint.array().jacobian(
        constraint.gimbal_angles(_plane(rng, constraint.critical_momentum))
    )
    assert np.abs(_rows(A) - 2 / n).max() < 1e-14
    assert np.abs(np.linalg.det(A @ A.mT) - n**2 / 4).max() < 1e-12 * n**2
    edge = constraint.critical_momentum * np.array([1 - 1e-12, 1 + 1e-12])
    assert np.ptp(constraint.torque_capability(np.stack([edge, 0 * edge], axis=1))) < 1e-6
    assert abs(constraint.torque_capability([edge[1], 0.0]) - n / 2) < 1e-6


@pytest.mark.sampled(3)
@pytest.mark.parametrize("n", [n for n in _COUNTS if n % 2])
def test_planar_odd_declining_region(n: int, rng: np.random.Generator) -> None:
    """TC = [(1-x^2)/(n-CC)^2 + x^2/CC^2]^(-1/2) with x = (H-1)/(n-1), CC = 1 + (n-1) x^2."""
    constraint = nm.guarantee.create("planar", n=n)
    H = rng.uniform(constraint.critical_momentum, 0.999 * n, 50)
    x = (H - 1) / (n - 1)
    CC = 1 + (n - 1) * x**2
    expected = ((1 - x**2) / (n - CC) ** 2 + x**2 / CC**2) ** -0.5
    found = constraint.torque_capability(np.stack([0 * H, -H], axis=1))
    assert np.abs(found / expected - 1).max() < 1e-9


@pytest.mark.sampled(3)
@pytest.mark.parametrize("n", [n for n in _COUNTS if n % 2 == 0])
def test_planar_even_declining_region(n: int, rng: np.random.Generator) -> None:
    """TC = H sqrt(n^2 - H^2)/n (Eq 155)."""
    constraint = nm.guarantee.create("planar", n=n)
    H = rng.uniform(constraint.critical_momentum, 0.999 * n, 50)
    found = constraint.torque_capability(np.stack([H, 0 * H], axis=1))
    assert np.abs(found / (H * np.sqrt(n**2 - H**2) / n) - 1).max() < 1e-9


@pytest.mark.parametrize(
    ("n", "sizes"),
    [
        (6, [1, 2, 2, 1]),
        (10, [2, 3, 3, 2]),
        (11, [2, 3, 1, 3, 2]),
        (13, [3, 3, 1, 3, 3]),
        (15, [3, 4, 1, 4, 3]),
    ],
)
def test_group_sizes(n: int, sizes: list[int]) -> None:
    """CMGs at one angle; the printed k_4 leaves one out at n = 11 and 15."""
    delta = nm.guarantee.create("planar", n=n).gimbal_angles([1.3, 0.0])
    _, counts = np.unique(np.round(delta, 9), return_counts=True)
    assert counts.tolist() == sizes


@pytest.mark.sampled(4)
@pytest.mark.parametrize("n", _COUNTS)
def test_backbone_is_an_arc(n: int, rng: np.random.Generator) -> None:
    """Equal steps between neighbours, momentum met, TC against pinv."""
    constraint = nm.guarantee.create("backbone", n=n)
    h = _plane(rng, 0.999 * n)
    delta, array = constraint.gimbal_angles(h), constraint.array()
    assert np.abs(array.momentum(delta) - h).max() < 1e-9
    assert np.ptp(np.diff(delta, axis=1), axis=1).max() < 1e-9
    expected = 1 / _rows(array.jacobian(delta)).max(axis=-1)
    assert np.abs(constraint.torque_capability(h) / expected - 1).max() < 1e-9


def test_gain_over_the_backbone() -> None:
    """(TC - TC_bb)/TC: 25.00 % static (n = 5), 34.15 % declining (n = 8, H = .99 n)."""

    def gain(n: int, H: np.ndarray) -> np.ndarray:
        h = np.stack([H, 0 * H], axis=1)
        mine, theirs = (
            nm.guarantee.create(c, n=n).torque_capability(h) for c in ("planar", "backbone")
        )
        return 100 * (mine - theirs) / mine

    assert gain(5, np.linspace(0, 3.449, 4001)).max() == pytest.approx(25.00, abs=0.05)
    assert gain(8, np.array([0.99 * 8]))[0] == pytest.approx(34.15, abs=0.1)
    for n in range(4, 10):
        assert gain(n, np.linspace(1e-6, 0.99 * n, 2001)).min() > -1e-9


@pytest.mark.parametrize("name", _SPATIAL)
def test_spatial_constraints_meet_momentum(name: str, rng: np.random.Generator) -> None:
    """h(delta) = h; the Jacobian of the angles against differences; TC from its rows (Eq 49)."""
    constraint = nm.guarantee.create(name)
    h = _inside(name, rng)
    assert len(h) > 40
    delta, array = constraint.gimbal_angles(h), constraint.array()
    assert np.abs(array.momentum(delta) - h).max() < 1e-12
    step = 1e-6
    for point in h[:10]:
        sides = [constraint.gimbal_angles(point + s * step * np.eye(3)) for s in (1, -1)]
        numeric = (np.array(sides[0]) - np.array(sides[1])).T / (2 * step)
        exact = constraint.gimbal_jacobian(point)
        assert np.abs(exact - numeric).max() < 1e-5 * (1 + np.abs(exact).max() ** 2)
        assert np.abs(array.jacobian(constraint.gimbal_angles(point)) @ exact - np.eye(3)).max() < (
            1e-9
        )
        capability = 1 / np.linalg.norm(exact, axis=1).max()
        assert constraint.torque_capability(point) == pytest.approx(capability, rel=1e-9)


def _augmented(constraint: object, delta: np.ndarray, bias: object) -> np.ndarray:
    """Return J_t^-1 of Eq 12 with Eq 50's gradient by central differences."""
    array = constraint.array()

    def residual(delta: np.ndarray) -> float:
        h = array.momentum(delta)
        return float(np.cos(delta[0]) + np.cos(delta[1]) - (h[0] - bias(h)) / 2)

    step = 1e-6
    slope = [
        (residual(delta + step * e) - residual(delta - step * e)) / (2 * step) for e in np.eye(4)
    ]
    return np.linalg.inv(np.vstack([array.jacobian(delta), slope]))


def test_cubic_equals_the_printed_augmented_jacobian(rng: np.random.Generator) -> None:
    """Eqs 49-51 typed again: J_t inverted by LAPACK; det J_t = sin(d1-d2) sin(d3-d4)."""

    def bias(h: np.ndarray) -> float:
        x, y, z = h
        P = -67 / 3840 * x**8 + x**6 / 6 - 11 / 24 * x**4 + 47 / 60 * x**2
        b = 4 * np.sqrt(6) / 3
        return float(b * (1 - x**2 / 4) * (1 - y**2 / 4) * (1 - z**2 / 4) + P)

    constraint = nm.guarantee.create("box90-cubic")
    for h in _inside("box90-cubic", rng)[:30]:
        delta = constraint.gimbal_angles(h)
        inverse = _augmented(constraint, delta, bias)
        capability = 1 / np.linalg.norm(inverse[:, :3], axis=1).max()
        assert constraint.torque_capability(h) == pytest.approx(capability, rel=1e-6)
        printed = abs(np.sin(delta[0] - delta[1]) * np.sin(delta[2] - delta[3]))
        assert abs(1 / np.linalg.det(inverse)) == pytest.approx(printed, rel=1e-5)
    assert constraint.torque_capability(np.zeros(3)) == pytest.approx(4 / 3, abs=1e-12)
    assert constraint.bias(np.array([2.0, 0, 0]))[0] == pytest.approx(2.0, abs=1e-12)


def test_spherical_is_the_printed_one(rng: np.random.Generator) -> None:
    """Eq 162 typed again."""
    constraint = nm.guarantee.create("box90-spherical")
    for h in rng.uniform(-1, 1, (20, 3)):
        x = h[0]
        P = x**8 / 32 - 3 / 20 * x**6 + 9 / 40 * x**4
        expected = 4 * np.sqrt(6) / 3 * np.sqrt(1 - h @ h / 4) + P
        assert constraint.bias(h)[0] == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize("name", nm.guarantee.names())
def test_outside_the_envelope(name: str) -> None:
    """TC is 0.0 and the angles are refused; never a number that looks right."""
    constraint = nm.guarantee.create(name)
    far = np.full(constraint.array().m, 1.01 * constraint.reach)
    assert constraint.torque_capability(far) == 0.0
    with pytest.raises(InputError, match="inside the envelope"):
        constraint.gimbal_angles(far)


def test_bad_input() -> None:
    """One message each, with the key, the value and what is allowed."""
    for name in ("planar", "backbone"):
        with pytest.raises(InputError, match="n = 2: a whole number from 3"):
            nm.guarantee.create(name, n=2)
    with pytest.raises(UnknownNameError, match="box90-cubic"):
        nm.guarantee.create("box90-cubik")
    with pytest.raises(UnknownNameError, match="allowed: n"):
        nm.guarantee.create("planar", m=3)
    with pytest.raises(InputError, match="3 components"):
        nm.guarantee.create("box90-cubic").torque_capability([0.1, 0.2])
    with pytest.raises(InputError, match="finite"):
        nm.guarantee.create("box90-cubic").torque_capability([0.1, np.nan, 0])
    with pytest.raises(InputError, match="polynomial"):
        nm.guarantee.create("box90-cubic", polynomial=(1.0, "x"))
    with pytest.raises(InputError, match="three powers"):
        nm.guarantee.create("roof6", terms=((1, 2, 3),))


def test_batches_and_a_lost_cmg() -> None:
    """Leading axes are kept; a planar array that loses a CMG has the closed form of n - 1."""
    constraint = nm.guarantee.create("planar", n=5)
    h = np.zeros((2, 3, 2))
    assert constraint.gimbal_angles(h).shape == (2, 3, 5)
    assert constraint.torque_capability(h).shape == (2, 3)
    assert isinstance(float(constraint.torque_capability(h[0, 0])), float)
    assert constraint.without(1) == nm.guarantee.create("planar", n=4)
    with pytest.raises(InputError, match="from 3"):
        nm.guarantee.create("planar", n=3).without(0)
    with pytest.raises(InputError, match="failed CMG"):
        nm.guarantee.create("box90-cubic").without(0)
