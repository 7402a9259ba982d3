"""An array that is a constraint's own in another frame: found, steered, or refused."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import nullmotion as nm
from nullmotion import Observation, guarantee, laws, layouts
from nullmotion.errors import TraceError, UnsupportedArrayError
from nullmotion.guarantee.fit import Fit, fit
from nullmotion.guarantee.tracking import tracking
from nullmotion.sim import Setup, run, run_batch

CONSTRAINTS = [
    *[(n, {}) for n in guarantee.names() if n not in ("planar", "backbone")],
    *[("planar", {"n": n}) for n in (3, 6)],
]
KINDS = ("constraint", "constraint-feedback")


def rates(law: Any, array: Any, delta: Any, hdot: Any) -> np.ndarray:
    return np.asarray(law.step(array, Observation(delta, hdot), ())[0], float)


def moved(array: Any, rng: np.random.Generator) -> Any:
    """Return an array with axes turned, CMGs renumbered, zeros shifted, gimbal axes flipped."""
    n = array.n
    q, r = np.linalg.qr(rng.normal(size=(3, 3)))
    R = q * np.sign(np.diag(r))
    R = R * np.linalg.det(R)
    order, flip = rng.permutation(n), rng.choice([-1.0, 1.0], n)
    shift = rng.uniform(-np.pi, np.pi, n)[:, None]
    spin = np.cos(shift) * array.spin_axes + np.sin(shift) * array.transverse_axes
    gimbal = flip[:, None] * array.gimbal_axes
    return nm.CmgArray((gimbal @ R.T)[order], (spin @ R.T)[order], h0=2.0, label=array.label)


@pytest.mark.parametrize(("name", "own"), CONSTRAINTS)
def test_an_array_fits_however_it_is_turned(name: str, own: Any, rng: np.random.Generator) -> None:
    """The fit's angles hold the turned momentum, so that the constraint is met there."""
    constraint = guarantee.create(name, **own)
    model = constraint.array()
    for _ in range(5):
        array = moved(model, rng)
        found = fit(constraint, array)
        assert isinstance(found, Fit), found
        assert sorted(found.cmgs) == list(range(array.n))
        np.testing.assert_allclose(found.turn @ found.turn.T, np.eye(array.m), atol=1e-12)
        delta = rng.uniform(-np.pi, np.pi, (6, array.n))
        there = np.array([model.momentum(found.angles(d)) for d in delta])
        np.testing.assert_allclose(there, array.momentum(delta) @ found.turn.T / 2.0, atol=1e-12)


def test_the_roof_is_the_box90_turned(rng: np.random.Generator) -> None:
    found = fit(guarantee.create("box90-cubic"), layouts.roof())
    assert isinstance(found, Fit)
    assert found.cmgs == (0, 1, 2, 3) and (found.signs == 1).all() and (found.zeros == 0).all()
    roof, box = layouts.roof(), layouts.box90()
    delta, hdot = rng.uniform(-1, 1, 4) + layouts.home("box90"), rng.normal(size=3)
    for name in KINDS:
        law = laws.create(name)
        here = rates(law, box, delta, found.turn @ hdot)
        np.testing.assert_allclose(rates(law, roof, delta, hdot), here, atol=1e-12)


@pytest.mark.parametrize("name", KINDS)
def test_a_turned_array_is_steered_along_the_constraint(
    name: str, rng: np.random.Generator
) -> None:
    array, constraint = moved(layouts.box90(), rng), guarantee.create("box90-designed")
    how = tracking(None, {}, array)
    assert not isinstance(how, str)
    start = constraint.gimbal_angles(np.zeros(3))[np.argsort(how.fit.cmgs)]
    places = np.argsort(how.fit.cmgs)
    delta = (start - how.fit.zeros[places]) * how.fit.signs[places]
    result = run(Setup(array, laws.create(name), delta, np.array([0.2, -0.3, 0.35]), steps=300))
    assert result.status == []
    np.testing.assert_allclose(result.momentum[-1], [0.6, -0.9, 1.05], atol=5e-3)
    aim = how.target(array, result.delta[-1])
    assert abs(aim.way).max() < (0.01 if name == "constraint" else 0.5)


@pytest.mark.parametrize("name", KINDS)
@pytest.mark.parametrize(
    ("array", "own", "words"),
    [
        (layouts.pyramid(), {}, "no constraint function holds these 4 CMGs"),
        (layouts.box90(), {"constraint": "roof6"}, "roof6 holds 6 CMGs, not 4"),
        (layouts.pyramid(), {"constraint": "box90-cubic"}, "not those of box90"),
        (layouts.box90(h0=[1, 1, 1, 2]), {}, "equal momentum"),
        (layouts.box90(h0=[0, 1, 1, 1]), {}, "no constraint for 3 working CMGs"),
        (layouts.planar(n=2), {"constraint": "planar"}, "two CMGs have no null motion"),
        (layouts.planar(n=4), {"constraint": "planar", "constraint_parameters": {"n": 5}}, "5 CMG"),
    ],
)
def test_other_arrays_are_refused_with_a_reason(
    name: str, array: Any, own: Any, words: str
) -> None:
    law = laws.create(name, **own)
    assert words in law.supports(array)
    with pytest.raises(UnsupportedArrayError, match="does not support"):
        nm.prepare(law, array)


def test_axes_that_differ_between_runs_cannot_be_traced(rng: np.random.Generator) -> None:
    arrays = [layouts.box90(), moved(layouts.box90(), rng)]
    law, start = laws.create("constraint"), layouts.home("box90")
    setups = [Setup(array, law, start, np.array([0.1, 0.0, 0.0]), steps=5) for array in arrays]
    with pytest.raises(TraceError, match="run by run"):
        run_batch(setups[0], setups=setups)
