"""Certificates: what they prove, what they refuse, and that a file can be trusted."""

from __future__ import annotations

import dataclasses
import json

import numpy as np
import pytest

import nullmotion as nm
from nullmotion.errors import InputError
from nullmotion.guarantee import certificate


@pytest.mark.parametrize(("radius", "capability"), [(1.38, 0.5), (0.73, 1.0)])
def test_the_cubic_bias_is_proven(radius: float, capability: float) -> None:
    """The dissertation's radii, as theorems."""
    found = nm.guarantee.create("box90-cubic").certificate(radius, capability)
    assert found.proven and found.boxes > 100
    assert f"{radius:g}" in found.statement and f"{found.boxes:,} boxes" in found.statement


@pytest.mark.slow
@pytest.mark.parametrize(("radius", "capability"), [(1.38, 0.5), (0.73, 1.0)])
def test_the_checker_confirms(radius: float, capability: float) -> None:
    """Every box again, in ball arithmetic."""
    assert nm.guarantee.create("box90-cubic").certificate(radius, capability).check()


@pytest.mark.sampled(2)
@pytest.mark.parametrize(
    "planted",
    [
        {"b": 3.0},
        {"polynomial": (47 / 66, -11 / 24, 1 / 6, -67 / 3840)},
        {"polynomial": (47 / 60, 11 / 24, 1 / 6, -67 / 3840)},
        {"polynomial": (47 / 60, -11 / 24, -1 / 6, -67 / 3840)},
        {"polynomial": (47 / 60, -11 / 24, 1 / 6, 67 / 3840)},
    ],
)
def test_a_planted_error_makes_the_proof_fail(planted: dict) -> None:
    """With a momentum that refutes the claim: NumPy agrees."""
    constraint = nm.guarantee.create("box90-cubic", **planted)
    found = constraint.certificate(1.38, 0.5)
    assert not found.proven and not found and "false" in found.statement
    assert np.linalg.norm(found.counterexample) <= 1.38
    delta = constraint.gimbal_angles(found.counterexample)
    step = 1e-6 * np.eye(3)
    sides = [constraint.gimbal_angles(found.counterexample + s * step) for s in (1, -1)]
    rows = np.linalg.norm((sides[0] - sides[1]) / 2e-6, axis=0)
    assert np.isfinite(delta).all() and 1 / rows.max() < 0.5
    assert found.counterexample_capability == pytest.approx(1 / rows.max(), rel=1e-6)


@pytest.mark.slow
def test_just_beyond_the_true_radius() -> None:
    """1.3913 is where TC falls below 0.5: 1.39 is proven, 1.393 refuted."""
    constraint = nm.guarantee.create("box90-cubic")
    assert constraint.certificate(1.393, 0.5).counterexample is not None
    assert constraint.certificate(1.39, 0.5).proven


def test_no_internal_singularity() -> None:
    """Up to |h| = 1.94 the cubic bias is singular by saturation only; beyond 1.95 it is not."""
    constraint = nm.guarantee.create("box90-cubic")
    assert constraint.certificate(1.94).proven
    found = constraint.certificate(1.96)
    assert not found.proven
    assert constraint.torque_capability(found.counterexample) < 0.01


@pytest.mark.sampled(2)
@pytest.mark.parametrize("name", ["planar", "backbone"])
@pytest.mark.parametrize("n", [3, 5, 8])
def test_planar_certificates(name: str, n: int) -> None:
    """TC a little below its least value up to a radius is proven, a little above refuted."""
    constraint = nm.guarantee.create(name, n=n)
    radius = 0.9 * n
    sizes = np.linspace(0, radius, 2000)
    least = constraint.torque_capability(np.stack([sizes, 0 * sizes], axis=1)).min()
    good, bad = (constraint.certificate(radius, least * f) for f in (0.998, 1.005))
    assert good.proven and good.check()
    assert not bad.proven and np.linalg.norm(bad.counterexample) <= radius * (1 + 1e-12)
    assert constraint.torque_capability(bad.counterexample) < least * 1.005


@pytest.mark.sampled(2)
@pytest.mark.parametrize(
    "name", [n for n in nm.guarantee.names() if n not in ("planar", "backbone", "box90-cubic")]
)
def test_every_constraint_can_be_proven(name: str) -> None:
    """Somewhere; and nothing beyond its reach."""
    constraint = nm.guarantee.create(name)
    home = constraint.torque_capability(np.zeros(3))
    assert constraint.certificate(0.3, 0.7 * home).proven
    assert not constraint.certificate(1.01 * constraint.reach, 0.01).proven


def test_a_file_can_be_checked_and_not_forged(tmp_path) -> None:
    """Saved and loaded it says the same; with anything changed the check fails."""
    made = nm.guarantee.create("box90-cubic").certificate(0.3, 1.1)
    file = tmp_path / "certificate.json"
    made.save(file)
    loaded = certificate.load(file)
    assert loaded.check() and loaded.statement == made.statement
    forged = (
        {"radius": 0.9},
        {"torque_capability": 1.3},
        {"parameters": {"b": 2.0, "polynomial": [0.9]}},
        {"tree": made.tree[:-1]},
        {"tree": made.tree.replace("p", "o", 1)},
        {"tree": ""},
    )
    for change in forged:
        assert not dataclasses.replace(loaded, **change).check(), change


def test_bad_files_and_claims(tmp_path) -> None:
    """One message each."""
    constraint = nm.guarantee.create("box90-cubic")
    for radius, capability in ((-1.0, 0.5), (np.nan, 0.5), (1.0, -0.5), (1.0, np.inf)):
        with pytest.raises(InputError, match="finite number above 0"):
            constraint.certificate(radius, capability)
    file = tmp_path / "x.json"
    for text in ("", "[]", json.dumps({"format": "other"})):
        file.write_text(text)
        with pytest.raises(InputError, match="certificate"):
            certificate.load(file)
