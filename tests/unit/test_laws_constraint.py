"""The constraint laws: Eq 12 solved as it stands, the trim, the status, failed CMGs."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import nullmotion as nm
from nullmotion import Observation, guarantee, laws, layouts
from nullmotion.errors import InputError
from nullmotion.guarantee.tracking import tracking
from nullmotion.sim import Setup, run, run_batch
from nullmotion.spacecraft import Event

CONSTRAINTS = [
    ("box90-cubic", {}),
    ("box90-designed", {}),
    ("box90-spherical", {}),
    ("roof6", {}),
    ("scissored-pairs", {}),
    ("orthogonal-pairs", {}),
    *[("planar", {"n": n}) for n in (3, 4, 5, 7)],
    ("backbone", {"n": 5}),
]
KINDS = ("constraint", "constraint-feedback")


def rates(law: Any, array: Any, delta: Any, hdot: Any) -> np.ndarray:
    return np.asarray(law.step(array, Observation(delta, np.asarray(hdot, float)), ())[0], float)


def momenta(constraint: Any, rng: np.random.Generator, count: int) -> np.ndarray:
    """Return momenta well inside, none of them near zero."""
    h = rng.uniform(-0.45, 0.45, (100, constraint.m)) * constraint.reach
    good = (constraint.torque_capability(h) > 0.3) & (np.linalg.norm(h, axis=1) > 0.1)
    return h[good][:count]


def wrap(angle: Any) -> Any:
    return (angle + np.pi) % (2 * np.pi) - np.pi


@pytest.mark.parametrize(("name", "own"), CONSTRAINTS)
@pytest.mark.sampled(6)
def test_rates_solve_equation_12(name: str, own: Any, rng: np.random.Generator) -> None:
    """[A; J_c] by central differences of any n - m functions that vanish on the constraint."""
    constraint = guarantee.create(name, **own)
    array = constraint.array(h0=3.0)
    law = laws.create("constraint", constraint=name, constraint_parameters=own)
    n, m = array.n, array.m
    mix = rng.normal(size=(n - m, n))
    for h in momenta(constraint, rng, 5):
        delta = constraint.gimbal_angles(h)
        steps = np.concatenate([np.eye(n), -np.eye(n)]) * 1e-6
        near = delta + steps
        beside = wrap(constraint.gimbal_angles(array.momentum(near) / 3.0) - near) @ mix.T
        J_c = (beside[:n] - beside[n:]).T / 2e-6
        hdot = rng.normal(size=m)
        wanted = np.linalg.solve(
            np.concatenate([array.jacobian(delta), J_c]), np.concatenate([hdot, np.zeros(n - m)])
        )
        got = rates(law, array, delta, hdot)
        np.testing.assert_allclose(got, wanted, atol=1e-6 * (1 + abs(wanted).max()))
        np.testing.assert_allclose(array.jacobian(delta) @ got, hdot, atol=1e-13)


def test_box90_keeps_the_published_bias(rng: np.random.Generator) -> None:
    """Eqs 50-51 written out: the planes' difference along x stays Psi to first order."""

    def beside(h_all: Any) -> Any:
        x, y, z = h_all.sum(axis=0) / 2
        bias = 4 * np.sqrt(6) / 3 * (1 - x**2) * (1 - y**2) * (1 - z**2)
        bias += 47 / 15 * x**2 - 22 / 3 * x**4 + 32 / 3 * x**6 - 67 / 15 * x**8
        return h_all[2:, 0].sum() - h_all[:2, 0].sum() - bias

    law = laws.create("constraint", constraint="box90-cubic")
    array, constraint = layouts.box90(), guarantee.create("box90-cubic")
    for h in momenta(constraint, rng, 10):
        delta = constraint.gimbal_angles(h)
        assert abs(beside(array.rotor_momenta(delta))) < 1e-12
        way = 1e-5 * rates(law, array, delta, rng.normal(size=3))
        moved = [beside(array.rotor_momenta(delta + s * way)) for s in (1, -1)]
        assert abs(moved[0] - moved[1]) < 1e-12


@pytest.mark.parametrize("name", KINDS)
@pytest.mark.parametrize(("layout", "own"), [("box90", {}), ("planar", {"n": 6}), ("roof6", {})])
def test_torque_is_exact_off_the_constraint(
    name: str, layout: str, own: Any, rng: np.random.Generator
) -> None:
    array, law = layouts.create(layout, h0=7.0, **own), laws.create(name)
    for _ in range(20):
        delta, hdot = rng.uniform(-np.pi, np.pi, array.n), rng.normal(size=array.m)
        A = array.jacobian(delta)
        if np.linalg.svd(A / 7.0, compute_uv=False)[-1] > 0.05:
            np.testing.assert_allclose(A @ rates(law, array, delta, hdot), hdot, atol=1e-12)


@pytest.mark.parametrize("trim", [0.2, 1.0])
def test_trim_is_a_bandwidth(trim: float) -> None:
    """At rest the distance from the constraint falls as exp(-trim t), at constant momentum."""
    constraint, array = guarantee.create("box90-cubic"), layouts.box90()
    h = np.array([0.3, -0.2, 0.4])
    delta = constraint.gimbal_angles(h)
    null = np.linalg.svd(array.jacobian(delta))[2][-1]
    law = laws.create("constraint", constraint="box90-cubic", trim=trim)
    result = run(Setup(array, law, delta + 0.02 * null, np.zeros(3), dt=0.01, steps=500))
    found = array.momentum(result.delta) - array.momentum(result.delta[0])
    assert abs(found).max() < 1e-6  # rates are held for 10 ms
    away = np.linalg.norm(
        wrap(result.delta - constraint.gimbal_angles(array.momentum(result.delta))), axis=1
    )
    np.testing.assert_allclose(away / away[0], np.exp(-trim * result.t), rtol=0.02 + 0.1 * trim)


@pytest.mark.slow
def test_without_trim_the_array_stays_on_the_constraint_as_in_the_dissertation() -> None:
    """Section 4.4: steps of 1 ms along straight lines between momenta inside."""
    constraint, array = guarantee.create("box90-cubic"), layouts.box90()
    law = laws.create("constraint", constraint="box90-cubic", trim=0.0)
    rng = np.random.default_rng(1)
    points = rng.uniform(-1.3, 1.3, (200, 3))
    points = points[constraint.torque_capability(points) > 0.3][:20]
    starts = np.tile(constraint.gimbal_angles(np.zeros(3)), (len(points), 1))
    base = Setup(array, law, starts[0], np.zeros(3), dt=1e-3, steps=2000, integrator="euler")
    for k in range(3):
        ends = points if k == 0 else np.roll(points, 1, axis=0) if k == 1 else 0 * points
        hdot = (ends - array.momentum(starts)) / 2.0
        batch = run_batch(base, delta=starts, hdot=hdot)
        starts = batch.final_gimbal_rad
    aim = constraint.gimbal_angles(array.momentum(starts))
    assert abs(wrap(starts - aim)).max() < 5e-3


FLAGS = [
    ("box90", {}, np.zeros(4), [0.1, 0, 0], {"outside-constraint"}),  # h = (4, 0, 0)
    ("box90", {}, [0.0, 0.1, 0.2, 0.3], [0.0, 0, 0.1], {"outside-constraint"}),
    ("box90", {}, None, [0.3, 0.3, 0.3], set()),
    ("box90", {}, None, [3.0, 0, 0], {"torque-beyond-guarantee"}),
    ("planar", {"n": 5}, [3e-4, 0.0], [0.0, 0.3], {"algorithmic-singularity"}),
    ("planar", {"n": 5}, [0.0, 0.0], [0.0, 0.3], {"algorithmic-singularity"}),
    ("planar", {"n": 5}, [1.0, 0.0], [0.0, 0.3], set()),
    ("planar", {"n": 5}, [0.1, 0.0, 0.3, 1.0, 2.0], [0.0, 0.3], {"off-constraint"}),
]


@pytest.mark.parametrize(("layout", "own", "state", "hdot", "flags"), FLAGS)
def test_status_says_what_does_not_hold(
    layout: str, own: Any, state: Any, hdot: Any, flags: set[str]
) -> None:
    """Rates stay finite and give the torque where the array can."""
    array = layouts.create(layout, rate_limit=1.0, **own)
    constraint = guarantee.create("planar" if own else "box90-designed", **own)
    delta = np.zeros(constraint.m) if state is None else np.array(state, float)
    if len(delta) == array.m:
        delta = constraint.gimbal_angles(delta)
    prepared = nm.prepare(laws.create("constraint"), array, limited=False)
    got = prepared(delta, np.array(hdot, float))
    assert set(prepared.status) == flags
    assert np.isfinite(got).all()
    A = array.jacobian(delta)
    if np.linalg.svd(A, compute_uv=False)[-1] > 1e-3:
        np.testing.assert_allclose(A @ got, hdot, atol=1e-11)
    assert abs(got).max() < 50.0


def test_the_planar_constraint_turns_too_fast_at_zero_momentum() -> None:
    """A run past zero momentum raises the flags and gives the torque all the same."""
    array, constraint = layouts.planar(n=5), guarantee.create("planar", n=5)
    delta = constraint.gimbal_angles(np.array([-1.0, 0.002]))
    setup = Setup(array, laws.create("constraint"), delta, np.array([0.5, 0.0]), steps=400)
    result = run(setup)
    assert {"algorithmic-singularity", "off-constraint"} <= set(result.status)
    np.testing.assert_allclose(result.momentum[-1], [1.0, 0.002], atol=0.01)


@pytest.mark.parametrize("name", KINDS)
@pytest.mark.parametrize(
    ("own", "key"),
    [
        ({"constraint": "box9"}, "law.constraint"),
        ({"constraint": 3}, "law.constraint"),
        ({"constraint_parameters": {"b": 1.0}}, "law.constraint_parameters"),
        ({"constraint_parameters": 3}, "law.constraint_parameters"),
        (
            {"constraint": "box90-cubic", "constraint_parameters": {"c": 1.0}},
            "law.constraint_parameters.c",
        ),
        (
            {"constraint": "box90-cubic", "constraint_parameters": {"b": -1.0}},
            "law.constraint_parameters.b",
        ),
    ],
)
def test_bad_parameters_are_named(name: str, own: Any, key: str) -> None:
    with pytest.raises(InputError) as caught:
        laws.create(name, **own)
    assert caught.value.key == key


@pytest.mark.parametrize(
    ("name", "own"), [("constraint", {"trim": -1.0}), ("constraint-feedback", {"K": -1.0}),
                      ("constraint-feedback", {"relabel": "any"}),
                      ("constraint-feedback", {"turn_above": 0.0})]
)  # fmt: skip
def test_bad_gains_are_refused(name: str, own: Any) -> None:
    with pytest.raises(InputError, match=f"law.{next(iter(own))}"):
        laws.create(name, **own)


@pytest.mark.slow
def test_parameters_of_the_constraint_may_differ_between_runs() -> None:
    array, start = layouts.box90(), np.array([0.6, -0.6, 2.5, 3.7])
    made = [
        laws.create("constraint", constraint="box90-cubic", constraint_parameters={"b": b})
        for b in (3.0, 3.3)
    ]
    setups = [Setup(array, law, start, np.array([0.1, 0.2, 0.0]), steps=50) for law in made]
    batch = run_batch(setups[0], setups=setups)
    for i, setup in enumerate(setups):
        np.testing.assert_allclose(batch.final_gimbal_rad[i], run(setup).delta[-1], atol=1e-12)
    assert abs(np.diff(batch.final_gimbal_rad, axis=0)).max() > 1e-4


@pytest.mark.parametrize("name", KINDS)
def test_a_planar_array_goes_over_to_the_closed_form_of_those_that_work(name: str) -> None:
    """A gimbal sticks, with its momentum; four of five take the angles for four."""
    array, four = layouts.planar(n=5, h0=3.0, rate_limit=1.0), guarantee.create("planar", n=4)
    start = guarantee.create("planar", n=5).gimbal_angles(np.array([0.5, 0.3]))
    event = Event("stuck", 2, 1.0, 0.5)
    law, hdot = laws.create(name), np.array([0.15, 0.3])
    result = run(Setup(array, law, start, hdot, dt=0.02, steps=700, events=(event,)))
    assert "no-constraint" not in result.status
    assert (result.rates_asked[75:-1, 2] == 0).all() and abs(result.rates_asked[:75, 2]).min() > 0
    left = array.without(2)
    others = np.delete(result.delta, 2, axis=1)
    h = left.momentum(others[-1]) / 3.0
    capability = guarantee.torque_capability(left, others[-1])
    np.testing.assert_allclose(capability, four.torque_capability(h), rtol=0.03)
    aim = np.sort(wrap(others[-1] - four.gimbal_angles(h)[:, None]), axis=0)
    assert abs(aim).min(axis=0).max() < 0.2
    torque = np.diff(result.momentum[75:], axis=0) / 0.02
    assert abs(torque - hdot).max() < 1e-2


def test_an_array_without_a_cmg_has_the_smaller_constraint() -> None:
    for gone, counts in ((2, [4, 3]), ([0, 3], [3])):
        found = tracking(None, {}, layouts.planar(n=5).without(gone, 0.3))
        assert not isinstance(found, str)
        assert [c.n for c in found.constraints] == counts  # type: ignore[attr-defined]
    stopped = layouts.planar(n=5, h0=[1.0, 0.0, 1.0, 1.0, 1.0])
    found = tracking(None, {}, stopped)
    assert not isinstance(found, str)
    delta = np.array([0.2, 9.0, 1.4, 2.9, 4.6])
    aim = found.target(stopped, delta)
    less = layouts.planar(n=5).without(1)
    same = tracking(None, {}, less)
    assert not isinstance(same, str)
    np.testing.assert_allclose(
        np.delete(aim.way, 1), same.target(less, np.delete(delta, 1)).way, atol=1e-12
    )
    assert aim.way[1] == 0.0


def test_a_box90_that_loses_a_cmg_says_so() -> None:
    what = Setup(
        layouts.box90(), laws.create("constraint"), layouts.home("box90"),
        np.array([0.05, 0.02, 0.02]), steps=200, events=(Event("stuck", 2, 1.0, 0.2),),
    )  # fmt: skip
    assert "no-constraint" in run(what).status
