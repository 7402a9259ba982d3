"""One state looked at from all sides: against known states and what each part says by itself."""

from __future__ import annotations

import json

import numpy as np
import pytest

import nullmotion as nm
from nullmotion import atlas

PYRAMID = nm.layouts.pyramid(skew=np.radians(54.73))
STEEP = nm.layouts.pyramid(skew=np.arcsin(0.8))
BOX = nm.layouts.box90()
TRIANGLE = nm.layouts.triangle()
IDLE = nm.CmgArray(PYRAMID.gimbal_axes, PYRAMID.spin_axes, [0.0, 1.0, 1.0, 1.0])
PRINTED = [63.434949, 110.323137, -70.346176, -102.528808]

# array, angles, type, singular directions, can go on by null motion, along u, against u, escapes
STATES = [
    (PYRAMID, [-90, 0, 90, 0], "elliptic", 1, False, False, True, False),
    (PYRAMID, [0, 0, 0, 0], "regular", 0, True, None, None, True),
    (PYRAMID, [-90, 180, 90, 0], "saturation", 1, False, False, True, False),
    (STEEP, PRINTED, "hyperbolic", 1, True, True, True, True),
    (BOX, [30, 210, 40, 220], "degenerate-hyperbolic", 1, False, False, False, True),
    (BOX, [90, 90, 90, 90], "saturation", 2, False, False, True, False),
    (BOX, [90, -90, 90, -90], "hyperbolic", 2, True, True, True, True),
    (TRIANGLE, [-120, 0, 300], "hyperbolic", 1, True, True, True, True),
    (nm.layouts.planar(n=2), [0, 180], "degenerate-hyperbolic", 1, False, False, False, False),
    (PYRAMID.without(0), [10, 20, 30], "regular", 0, True, None, None, True),
    (PYRAMID.without([0, 1]), [0, 0], "elliptic", 1, False, False, False, False),
    (nm.layouts.pyramid(n=6), [0, 0, 0, 0, 0, 0], "regular", 0, True, None, None, True),
    (IDLE, [0, 10, 20, 30], "regular", 0, True, None, None, True),
]  # fmt: skip


@pytest.mark.sampled(2)
@pytest.mark.parametrize(
    ("array", "delta", "kind", "directions", "leaves", "along", "against", "escapes"), STATES
)
def test_known_states(
    array: nm.CmgArray,
    delta: list[float],
    kind: str,
    directions: int,
    leaves: bool,
    along: bool | None,
    against: bool | None,
    escapes: bool,
) -> None:
    angles = np.radians(delta)
    state = atlas.inspect(array, angles)
    assert (state.kind, state.directions) == (kind, directions)
    assert (state.passable, state.escapable) == (leaves, escapes)
    assert (state.passable_along, state.passable_against) == (along, against)
    assert kind == nm.singularity.classify(array, angles)
    assert escapes == atlas.escapable(array, angles)
    assert leaves == atlas.passable(array, angles)
    assert state.momentum == pytest.approx(array.momentum(angles))
    assert state.measures == pytest.approx(nm.singularity.measures(array, angles))
    assert state.torque_capability == pytest.approx(
        nm.guarantee.torque_capability(array, angles, "optimal")
    )
    assert (state.u is None) == (state.signs is None) == (directions == 0)
    if state.u is not None and state.signs is not None:
        A = array.unit_jacobian(angles)
        assert np.linalg.norm(state.u) == pytest.approx(1.0)
        assert np.abs(state.u @ A).max() < 1e-6
        side = array.rotor_momenta(angles) @ state.u
        assert (np.sign(side)[np.abs(side) > 1e-5] == state.signs[np.abs(side) > 1e-5]).all()
        assert kind != "saturation" or (state.signs >= 0).all()
    assert state.component.distance(np.where(array.h0 > 0, angles, 0.0)) < 1e-2
    best = [c.best["sigma_min"].value for c in state.components]
    assert best == sorted(best, reverse=True)
    assert state.component.best["sigma_min"].value >= state.measures["sigma_min"] - 1e-9
    json.dumps(state.as_dict(), allow_nan=False)


def test_the_elliptic_state_is_alone_and_others_of_its_momentum_are_not_singular() -> None:
    state = atlas.inspect(PYRAMID, np.radians([-90, 0, 90, 0]))
    assert state.u == pytest.approx([1, 0, 0], abs=1e-9)
    assert state.signs is not None and state.signs.tolist() == [1, -1, 1, 1]
    assert np.linalg.norm(state.momentum) == pytest.approx(1.155, abs=5e-4)
    assert state.component.best["sigma_min"].value == pytest.approx(0.0, abs=1e-6)
    assert state.here > 0 and state.components[0].best["sigma_min"].value > 0.9
    kept = state.as_dict()
    assert kept["gimbal_deg"] == pytest.approx([-90, 0, 90, 0])
    assert kept["kind"] == "elliptic" and kept["signs"] == [1, -1, 1, 1]
    assert kept["on_component"] == state.here
    assert len(kept["components"]) == len(state.components)
    first = kept["components"][0]["best"]["sqrt_det_AAT"]
    again = nm.singularity.measures(PYRAMID, np.radians(first["gimbal_deg"]))
    assert first["value"] == pytest.approx(again["sqrt_det_AAT"])


@pytest.mark.slow
def test_the_singular_direction_is_the_blocked_one_inwards_or_outwards() -> None:
    array, rng = PYRAMID.without(0), np.random.default_rng(6)
    seen = []
    for u, signs in zip(rng.normal(size=(6, 3)), rng.choice([-1, 1], (6, 3)), strict=True):
        point = atlas.singular_points(array, u, signs)
        if nm.singularity.classify(array, point.delta) == "elliptic":
            state = atlas.inspect(array, point.delta)
            assert state.u is not None
            assert np.abs(state.u @ point.u) == pytest.approx(1.0)
            assert (state.passable_along, state.passable_against) == (False, True)
            seen.append(state.u @ state.momentum > 0)
    assert any(seen) and not all(seen)


def test_a_rotor_on_neither_side() -> None:
    """Where u is along the first gimbal axis."""
    array = PYRAMID.without(3)
    point = atlas.singular_points(array, array.gimbal_axes[0], [1, 1, -1], array.spin_axes[0])
    state = atlas.inspect(array, point.delta)
    assert state.signs is not None and state.signs[0] == 0
    assert sorted(np.abs(state.signs)) == [0, 1, 1]


def test_progress_and_bad_angles() -> None:
    shares: list[float] = []
    atlas.inspect(TRIANGLE, np.zeros(3), shares.append)
    assert shares == sorted(shares) and shares[-1] == 1.0
    for delta in (np.zeros(2), np.zeros((1, 3)), np.full(3, np.nan)):
        with pytest.raises(nm.InputError, match="delta"):
            atlas.inspect(TRIANGLE, delta)
