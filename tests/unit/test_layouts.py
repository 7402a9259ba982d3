"""Every registered layout: makers by name and alias, home states, and the printed geometries."""

from __future__ import annotations

import dataclasses
import subprocess
import sys

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import nullmotion as nm

NAMES = nm.layouts.names()
SHARED = {"box90", "orthogonal_pairs", "planar", "pyramid", "roof", "roof6", "scissored_pairs"}


def test_the_catalogue_holds_the_layouts_of_the_design() -> None:
    assert SHARED | {"triangle"} <= set(NAMES)


@pytest.mark.parametrize("name", NAMES)
def test_a_layout_makes_an_array(name: str) -> None:
    array = getattr(nm.layouts, name)(h0=2.5, rate_limit=3.0)
    assert isinstance(array, nm.CmgArray) and array.label == name
    assert np.all(array.h0 == 2.5) and np.all(array.rate_limit == 3.0)
    again = nm.layouts.create(name, h0=2.5, rate_limit=3.0)
    assert np.array_equal(array.gimbal_axes, again.gimbal_axes)


@pytest.mark.parametrize("name", NAMES)
def test_home_has_no_momentum_and_a_regular_jacobian(name: str) -> None:
    array, home = nm.layouts.create(name), nm.layouts.home(name)
    assert home.shape == (array.n,)
    assert np.linalg.norm(array.momentum(home)) < 1e-12
    assert np.linalg.svd(array.unit_jacobian(home))[1][-1] > 0.3


@pytest.mark.parametrize("name", NAMES)
def test_a_layout_is_documented_and_frozen(name: str) -> None:
    cls = nm.layouts.get(name)
    assert cls.full_name and cls.citation and cls.__doc__
    assert dataclasses.is_dataclass(cls) and cls.__dataclass_params__.frozen
    for alias in cls.aliases:
        assert nm.layouts.get(alias) is cls
        assert getattr(nm.layouts, alias)().label == name


@pytest.mark.parametrize("name", NAMES)
def test_a_maker_is_not_hidden_by_its_module(name: str) -> None:
    code = (
        f"import nullmotion.array.layouts.{name}\n"
        f"import nullmotion as nm\n"
        f"assert nm.layouts.{name}().n == nm.layouts.{name}().n\n"
    )
    if name in ("pyramid", "box90"):  # each costs a new interpreter
        subprocess.run([sys.executable, "-c", code], check=True)
    assert callable(getattr(nm.layouts, name))


@pytest.mark.parametrize(
    ("name", "parameters"),
    [("roof", {"n": n, "skew": s}) for n in (4, 6, 8, 10) for s in (0.3, 0.7, 1.2)]
    + [("planar", {"n": n}) for n in (3, 4, 5, 6, 12)]
    + [("pyramid", {"n": n}) for n in (3, 4, 5, 6, 8)],
)
def test_home_over_parameters(name: str, parameters: dict[str, float]) -> None:
    array = nm.layouts.create(name, **parameters)
    home = nm.layouts.home(name, **parameters)
    assert array.n == parameters["n"]
    assert np.linalg.norm(array.momentum(home)) < 1e-12
    assert np.linalg.svd(array.unit_jacobian(home))[1][-1] > 0.3


def rotors(name: str, angle: float, **parameters: float) -> np.ndarray:
    """Return each CMG's unit momentum with all gimbals at one angle."""
    array = nm.layouts.create(name, **parameters)
    return array.rotor_momenta(np.full(array.n, angle))


def test_box90_planes() -> None:
    c, s = np.cos(0.4), np.sin(0.4)
    assert np.allclose(rotors("box-90", 0.4), [[c, s, 0], [c, s, 0], [c, 0, s], [c, 0, s]])


def test_box90_home_is_the_best_of_its_kind() -> None:
    array = nm.layouts.box90()
    sigma = np.linalg.svd(array.jacobian(nm.layouts.home("box90")))[1]
    assert np.allclose(sigma, 2 / np.sqrt(3))  # trace(A A^T) = 4: nothing can beat it


def test_roof_at_45_deg_is_box90_turned() -> None:
    turn = Rotation.from_euler("x", -45, degrees=True)
    for four, six in (("box90", "roof"), ("roof6", "roof")):
        box = nm.layouts.create(four)
        roof = nm.layouts.create(six, n=box.n)
        assert np.allclose(turn.apply(box.gimbal_axes), roof.gimbal_axes)
        assert np.allclose(turn.apply(box.spin_axes), roof.spin_axes)


def test_roof_planes_are_inclined_by_the_skew() -> None:
    up, down = rotors("roof", np.pi / 2, skew=0.3)[[2, 0]]
    assert np.allclose(up, [0, np.cos(0.3), np.sin(0.3)])
    assert np.allclose(down, [0, np.cos(0.3), -np.sin(0.3)])


def test_roof6_planes() -> None:
    c, s = np.cos(0.4), np.sin(0.4)
    assert np.allclose(rotors("roof6", 0.4), [[c, s, 0]] * 3 + [[c, 0, s]] * 3)


def test_planar_rotors() -> None:
    array = nm.layouts.planar(n=5)
    assert array.m == 2 and np.allclose(
        rotors("planar", 0.4, n=5), [[np.cos(0.4), np.sin(0.4)]] * 5
    )


def test_triangle_columns_and_momentum() -> None:
    """Pereira Eq 7 (momentum, alpha = 30 deg) and its derivative."""
    gamma, alpha = np.array([0.3, -1.1, 2.2]), np.pi / 6
    array = nm.layouts.triangle(h0=2.0)
    t = gamma + np.array([2, 0, -2]) * np.pi / 3
    assert np.allclose(array.jacobian(gamma), 2.0 * np.stack([np.cos(t), np.sin(t)]))
    printed = [
        np.cos(alpha + gamma[0]) + np.sin(gamma[1]) - np.cos(alpha - gamma[2]),
        np.sin(alpha + gamma[0]) - np.cos(gamma[1]) + np.sin(alpha - gamma[2]),
    ]
    assert np.allclose(array.momentum(gamma), 2.0 * np.array(printed))


@pytest.mark.parametrize("pair", [0, 1, 2])
def test_a_scissored_pair_moves_along_one_axis(pair: int) -> None:
    array, delta = nm.layouts.scissored_pairs(h0=3.0), np.zeros(6)
    delta[2 * pair], delta[2 * pair + 1] = 0.7, -0.7
    expected = np.zeros(3)
    expected[pair] = 2 * 3.0 * np.sin(0.7)
    assert np.allclose(array.momentum(delta), expected, atol=1e-14)


def test_orthogonal_pairs_planes() -> None:
    c, s = np.cos(0.4), np.sin(0.4)
    expected = [[c, s, 0], [0, c, s], [s, 0, c]]
    assert np.allclose(rotors("orthogonal_pairs", 0.4), np.repeat(expected, 2, axis=0))


@pytest.mark.parametrize(
    ("name", "parameters"),
    [
        ("pyramid", {"skew": 0.0}),
        ("pyramid", {"skew": 2.0}),
        ("pyramid", {"skew": np.nan}),
        ("pyramid", {"n": 2}),
        ("roof", {"skew": 0.0}),
        ("roof", {"skew": np.pi / 2}),
        ("roof", {"skew": -0.3}),
        ("roof", {"skew": np.nan}),
        ("roof", {"n": 5}),
        ("roof", {"n": 2}),
        ("planar", {"n": 1}),
        ("planar", {"n": 0}),
        ("planar", {"n": 4.5}),
        ("pyramid", {"n": 4.5}),
    ],
)
def test_impossible_parameters_are_refused(name: str, parameters: dict[str, float]) -> None:
    ((key, value),) = parameters.items()
    with pytest.raises(nm.InputError) as caught:
        nm.layouts.create(name, **parameters)
    assert caught.value.key == f"array.{key}"
    assert caught.value.value is value and caught.value.allowed in str(caught.value)


def test_unknown_names_are_refused_with_the_nearest() -> None:
    with pytest.raises(nm.InputError, match="pyramid"):
        nm.layouts.create("piramid")
    with pytest.raises(nm.InputError, match="skew"):
        nm.layouts.create("pyramid", skw=0.3)
    with pytest.raises(AttributeError):
        nm.layouts.octahedron
