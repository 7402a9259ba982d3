"""Searches for the best course: exact against all courses, its bounds and its certificate."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

import nullmotion as nm
from nullmotion import laws, plan
from nullmotion.errors import InputError, TraceError, UnknownNameError, UnsupportedArrayError
from nullmotion.metrics.momentum import Momentum
from nullmotion.plan import Rollouts, costs, enumerate, exact, frontier
from nullmotion.plan.best import TIE
from nullmotion.plan.cost import greatest_manipulability, widest_array
from nullmotion.sim import Setup, Stop, run
from nullmotion.spacecraft import Event, Spacecraft, controllers

ARRAYS = {
    "pyramid": nm.layouts.pyramid(rate_limit=0.9),
    "box90": nm.layouts.box90(rate_limit=1.2),
    "planar": nm.layouts.planar(n=5, rate_limit=0.7),
    "unequal": nm.layouts.pyramid(h0=np.array([0.5, 1.0, 1.5, 1.0]), rate_limit=0.9),
    "roof6": nm.layouts.roof6(rate_limit=1.0),
}
LAWS = (
    laws.create("sr", lambda0=0.5, mu=0.2, schedule="exponential"),
    laws.create("pseudo-inverse"),
    laws.create("vcbsae"),
)


def setup_of(seed, steps=40, **more):
    """Return a random momentum-rate, momentum or attitude manoeuvre."""
    rng = np.random.default_rng(seed)
    array = list(ARRAYS.values())[seed % len(ARRAYS)]
    hdot = rng.normal(size=array.m)
    fields = {"dt": 0.05, "steps": steps, "integrator": "semi-implicit-euler"}
    if seed % 3 == 1:
        fields["momentum_target"] = rng.normal(size=array.m)
    if seed % 3 == 2 and array.m == 3:
        turn = rng.normal(size=4)
        body = Spacecraft(np.ones(3), momentum_coupling=bool(seed % 2))
        control = controllers.create("quaternion-feedback", kp=4.0, kw=6.0)
        fields |= {"spacecraft": body, "controller": control, "target": turn}
    law, start = LAWS[seed % len(LAWS)], rng.uniform(-1.5, 1.5, array.n)
    return Setup(array, law, start, hdot, **(fields | more))


def cost_of(seed):
    names = costs.names()
    return costs.create(names[seed % len(names)])


def brute(rollouts, levels):
    knots = enumerate.course(np.arange(levels**rollouts.depth), rollouts.depth, levels)
    return knots, rollouts.values(knots)


@pytest.mark.parametrize("seed", range(12))
@pytest.mark.sampled(5)
def test_exact_is_the_best_of_all_courses(seed):
    depth, levels = (1 + seed % 5, 3) if seed % 4 else (3, 5)
    rollouts = Rollouts(setup_of(seed), cost_of(seed), depth, k_max=0.5, lag=bool(seed % 2))
    knots, values = brute(rollouts, levels)
    found = exact.search(rollouts, levels, most_ties=levels**depth, lanes=8)
    top = values.max()
    assert found.proven and found.ties_complete
    assert found.value == pytest.approx(top, rel=1e-12)
    ties = {tuple(row) for row in knots[values >= top - TIE * abs(top)]}
    assert {found.knots, *found.ties} == ties
    certificate = found.certificate
    parts = certificate["leaves_evaluated"] + certificate["pruned_sequences"]
    assert parts == certificate["sequences"] == levels**depth
    assert certificate["largest_pruned_bound"] <= found.value + TIE * abs(found.value)
    shared = enumerate.search(rollouts, levels, most_ties=levels**depth)
    assert {shared.knots, *shared.ties} == ties
    assert shared.knots == found.knots


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.sampled(3)
def test_courses_that_share_their_start_get_the_same_bits(seed):
    rollouts = Rollouts(setup_of(seed), cost_of(seed), 5, k_max=0.5)
    np.testing.assert_array_equal(
        enumerate.all_values(rollouts, shared=True), enumerate.all_values(rollouts, shared=False)
    )


def faults():
    return (
        Event("spin-down", 1, at=0.2, time_constant=0.3, final_fraction=0.05),
        Event("spin-down", 2, at=0.1, time_constant=0.2, final_fraction=0.3),
    )


@pytest.mark.parametrize("seed", range(16))
@pytest.mark.sampled(4)
def test_no_completion_beats_its_bound(seed, rng):
    setup = setup_of(seed)
    if seed >= 12 and setup.array.m == 3:
        setup = dataclasses.replace(setup, events=faults())
    rollouts = Rollouts(setup, cost_of(seed // 2), depth=6, k_max=1.5)
    runs = 200
    knots = rng.choice([-1.0, 0.0, 1.0], (runs, 6))
    values = rollouts.values(knots)
    block, before = rollouts.block(runs), np.full(runs, np.inf)
    for segment in range(rollouts.segments):
        totals = rollouts.advance(block, segment, runs, knots[:, segment], knots[:, segment + 1])
        bounds = rollouts.bounds(totals, rollouts.edges[segment + 1])
        assert (bounds >= values - 1e-12 * np.abs(values)).all()
        assert (bounds <= before + 1e-12 * np.abs(bounds)).all()  # a child is no better
        before = bounds
    np.testing.assert_allclose(before, values, rtol=1e-12)  # nothing left to hope for


@pytest.mark.parametrize("array", ARRAYS.values(), ids=ARRAYS)
def test_no_configuration_beats_the_greatest_manipulability(array, rng):
    A = array.unit_jacobian(rng.uniform(-np.pi, np.pi, (20000, array.n)))
    det = np.linalg.det(A @ A.transpose(0, 2, 1))
    assert det.max() <= greatest_manipulability(array, "det")
    assert np.sqrt(det.max()) <= greatest_manipulability(array, "sqrt-det")
    equal = nm.layouts.pyramid()
    assert greatest_manipulability(equal, "sqrt-det") == pytest.approx((4 / 3) ** 1.5)


def test_wheels_that_spin_down_widen_the_bound(rng):
    setup = dataclasses.replace(setup_of(0), events=faults())
    wide = greatest_manipulability(widest_array(setup), "det")
    for _ in range(300):
        share = np.array([1.0, rng.uniform(0.05, 1), rng.uniform(0.3, 1), 1.0])
        array = setup.array.altered(h0=setup.array.h0 * share)
        assert greatest_manipulability(array, "det") <= wide


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.sampled(2)
def test_a_flight_of_the_plan_has_the_value_that_was_promised(seed):
    setup = setup_of(seed, steps=60)
    cost = costs.create("papakonstantinou", manipulability_threshold=0.8)
    found = plan.search(setup, cost=cost, depth=4, k_max=0.6, lag=bool(seed % 2))
    follow = laws.create(
        "follow-plan",
        base=setup.law.name,
        base_parameters={f.name: getattr(setup.law, f.name) for f in dataclasses.fields(setup.law)},
        knots=found.knots,
        duration_s=found.duration_s,
        k_max=found.k_max,
        lag=found.lag,
    )
    flight = run(dataclasses.replace(setup, law=follow))
    assert judged(setup, flight) == pytest.approx(found.value, rel=1e-9)
    assert judged(setup, run(setup)) == pytest.approx(found.baseline_value, rel=1e-9)


def judged(setup, flight):
    """Return Eq 25 of a history, by NumPy and SciPy."""
    from scipy.spatial.transform import Rotation

    array, delta = setup.array, flight.delta[:-1]
    A = array.unit_jacobian(delta)
    w = np.sqrt(np.linalg.det(A @ A.transpose(0, 2, 1)))
    high = (np.abs(flight.rates_asked[:-1]) > array.rate_limit).any(axis=1)
    if setup.spacecraft is not None:
        pointing = Rotation.from_quat(flight.q_BN[:-1], scalar_first=True)
        wanted = Rotation.from_quat(setup.target, scalar_first=True)
        error = (wanted.inv() * pointing).as_euler("ZYX")
    elif setup.momentum_target is not None:
        error = setup.momentum_target - array.momentum(delta)
    else:
        error = flight.torque[:-1] - flight.hdot[:-1]
    worst = np.linalg.norm(np.abs(error).max(axis=0))
    return 50 * w.mean() / max(5 * (w < 0.8).sum() + 4 * worst + 6 * high.sum(), 1e-9)


def still(steps=30, **more):
    """Return a manoeuvre in which nothing is asked."""
    return Setup(ARRAYS["pyramid"], LAWS[1], np.zeros(4), np.zeros(3), steps=steps, **more)


def test_where_nothing_is_better_there_is_no_null_motion():
    found = plan.search(still(), cost="peak-rate", depth=6)
    assert found.knots == (0.0,) * 6 and found.value == 0.0 and found.proven
    assert found.ties == [] and found.ties_complete


def test_ties_beyond_what_is_kept_are_said_to_be_missing():
    rollouts = Rollouts(setup_of(0), costs.create("min-manipulability"), 6)
    every = enumerate.search(rollouts, most_ties=729)
    found = exact.search(rollouts, most_ties=3)
    assert len(every.ties) > 3 and not found.ties_complete
    assert found.value == every.value and found.proven
    assert found.knots in {every.knots, *every.ties}
    assert sum(map(abs, found.knots)) <= min(sum(map(abs, k)) for k in found.ties)


def test_a_denominator_of_nothing_is_said():
    cost = costs.create("papakonstantinou", manipulability_threshold=0.1)
    found = plan.search(still(), cost=cost, depth=3)
    assert np.isfinite(found.value)
    assert any("denominator" in remark for remark in found.remarks)


def hard():
    return Rollouts(setup_of(0, steps=60), costs.create("papakonstantinou"), 20)


def test_ctrl_c_keeps_the_best_so_far(monkeypatch):
    monkeypatch.setattr(exact, "_REPORT", -1.0)
    calls = []

    def stop(share):
        calls.append(share)
        if len(calls) > 30:
            raise KeyboardInterrupt

    rollouts = hard()
    found = exact.search(rollouts, 9, progress=stop)
    assert not found.proven and "interrupted" in found.remarks[0]
    assert found.value == rollouts.values(found.knots)[0] >= rollouts.values(np.zeros(20))[0]
    counts = found.certificate
    assert counts["leaves_evaluated"] + counts["pruned_sequences"] < counts["sequences"]
    assert calls == sorted(calls)


def test_the_time_limit_keeps_the_best_so_far():
    found = exact.search(hard(), 9, time_limit=0.0)
    assert not found.proven and "ended after" in found.remarks[0]
    assert found.value >= hard().values(np.zeros(20))[0]


@pytest.mark.parametrize("method", ["enumerate", "skip"])
def test_ctrl_c_ends_the_other_methods_likewise(method):
    def stop(share):
        raise KeyboardInterrupt

    found = plan.search(setup_of(0), method, depth=8, progress=stop)
    assert not found.proven and any("interrupted" in r for r in found.remarks)
    assert found.value >= found.baseline_value


def test_bookkeeping_of_batches(monkeypatch):
    """Whatever the size of a batch, the same optimum and a certificate that adds up."""
    rollouts = Rollouts(setup_of(2), costs.create("papakonstantinou"), 7)
    for lanes, first in ((3, 3), (10, 96), (3000, 3)):
        monkeypatch.setattr(frontier, "_FIRST", first)
        found = exact.search(rollouts, lanes=lanes)
        counts = found.certificate
        assert counts["leaves_evaluated"] + counts["pruned_sequences"] == 3**7
        assert found.knots == enumerate.search(rollouts).knots
        assert found.rollouts <= 3**7 * 1.5


@pytest.mark.parametrize(
    ("arguments", "key"),
    [
        ({"depth": 0}, "depth"),
        ({"depth": 42}, "depth"),
        ({"depth": 2.5}, "depth"),
        ({"levels": 4}, "levels"),
        ({"levels": 1}, "levels"),
        ({"k_max": 0.0}, "k_max"),
        ({"duration": 3.0}, "duration"),
        ({"duration": float("inf")}, "duration"),
        ({"method": "enumerate", "depth": 30}, "depth"),
        ({"method": "skip", "depth": 41}, "depth"),
    ],
)
def test_what_cannot_be_searched_is_refused(arguments, key):
    with pytest.raises(InputError) as error:
        plan.search(setup_of(0), **arguments)
    assert error.value.key == key


def test_unknown_names_and_arrays_without_null_motion_are_refused():
    with pytest.raises(UnknownNameError, match="exact"):
        plan.search(setup_of(0), "exactly")
    with pytest.raises(UnknownNameError, match="energy"):
        plan.search(setup_of(0), cost="energie")
    three = Setup(nm.layouts.pyramid(n=3), LAWS[0], np.zeros(3), np.zeros(3))
    with pytest.raises(UnsupportedArrayError, match="null motion"):
        plan.search(three)
    with pytest.raises(TraceError, match="compiled"):
        plan.search(dataclasses.replace(setup_of(0), integrator="dop853"))


@pytest.mark.parametrize(
    "fields",
    [
        {"weights": (1, 2, 3)},
        {"weights": (1, 2, 3, -1)},
        {"manipulability_threshold": 0.0},
        {"rate_threshold": float("nan")},
        {"index": "det(A)"},
    ],
)
def test_costs_refuse_what_cannot_be(fields):
    with pytest.raises(InputError):
        costs.create("papakonstantinou", **fields)


def test_a_plan_may_be_shorter_than_the_run_and_ignores_stop_conditions():
    setup = setup_of(0)
    assert plan.search(setup, depth=4, duration=1.0).duration_s == pytest.approx(1.0)
    stopped = dataclasses.replace(setup, stop=(Stop(Momentum(), 0.0, below=False),))
    found, other = plan.search(setup, depth=4), plan.search(stopped, depth=4)
    assert other.knots == found.knots and other.value == found.value
    assert "stop conditions" in other.remarks[0] and not found.remarks


def test_law_periods_delays_and_schedules_are_searched_too():
    rng = np.random.default_rng(5)
    setup = Setup(
        ARRAYS["pyramid"],
        LAWS[0],
        rng.uniform(-1, 1, 4),
        rng.normal(size=(9, 3)),
        dt=0.05,
        steps=45,
        period_steps=5,
        delay_steps=7,
    )
    cost = costs.create("papakonstantinou", manipulability_threshold=0.8)
    rollouts = Rollouts(setup, cost, 5)
    found = exact.search(rollouts)
    assert found.value == brute(rollouts, 3)[1].max()
    follow = laws.create(
        "follow-plan",
        base="sr",
        base_parameters=dataclasses.asdict(LAWS[0]),
        knots=found.knots,
        duration_s=2.25,
    )
    flight = run(dataclasses.replace(setup, law=follow))
    assert judged(setup, flight) == pytest.approx(found.value, rel=1e-9)
