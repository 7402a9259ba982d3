"""Knots of any value: the smoothed value, its gradient, the evolution, the search."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from nullmotion import plan
from nullmotion.compile import derivatives
from nullmotion.plan import continuous, costs
from nullmotion.plan.best import INTERRUPTED
from nullmotion.plan.curves import random_curve, resample, shaken
from nullmotion.plan.evolution import Evolution
from nullmotion.plan.from_scenario import setup_of
from nullmotion.plan.smooth import SmoothValue

BEST = {
    "roll": [1, 0, -1, -1, 0, 0, 0, 0, 0, 0],
    "three-axis": [1, 1, 1, 0, 0, 0, 0, 0, 0, 0],
    "kinematic": [1, 1, 1, 1, 0, -1, 0, 0, 0, 0],
}
KNOWN = {"roll": 0.2630, "three-axis": 0.5829, "kinematic": 0.1890}  # over the best ternary one


@cache
def rollouts(case="roll", depth=10, cost=None):
    setup, wanted = setup_of(f"papakonstantinou-{case}")
    wanted.pop("levels")
    wanted |= {"depth": depth} | ({} if cost is None else {"cost": cost})
    return plan.prepared(setup, **wanted)


@cache
def smooth(case="roll", depth=10, cost=None):
    return SmoothValue(rollouts(case, depth, cost))


def curves(rng, depth, count=6):
    return np.array([random_curve(depth, rng) for _ in range(count)])


@pytest.mark.parametrize("case", BEST)
@pytest.mark.sampled(1)
def test_smoothed_values_come_to_the_true_ones(case, rng):
    knots = curves(rng, 10, 20)
    true = rollouts(case).values(knots)
    errors = [np.abs(smooth(case).gradient(knots, w)[0] / true - 1.0) for w in (0.3, 0.03, 1e-5)]
    assert np.median(errors[0]) > np.median(errors[1]) > np.median(errors[2])
    assert np.median(errors[2]) < 1e-4 and errors[1].max() < 0.1


@pytest.mark.parametrize("case", ["roll", "kinematic"])
@pytest.mark.sampled(1)
def test_gradients_of_counts_are_those_of_differences(case, rng):
    """Without the error, whose extreme the smoothed value takes from the true run."""
    weights = (50.0, 5.0, 0.0, 6.0)
    value = smooth(case, 6, costs.create("papakonstantinou", weights=weights))
    knots, step = curves(rng, 6), 1e-4

    def difference(move):
        return (value.gradient(knots + move, 0.1)[0] - value.gradient(knots - move, 0.1)[0]) / 2.0

    _, gradient = value.gradient(knots, 0.1)
    truth = np.zeros_like(gradient)
    for i, unit in enumerate(np.eye(6)):
        near, far = difference(step * unit) / step, difference(2.0 * step * unit) / (2.0 * step)
        truth[:, i] = (4.0 * near - far) / 3.0
    errors = np.abs(gradient - truth) / np.abs(gradient).max()
    # a few runs enter or leave the rate limit at some sample within a step
    assert np.median(errors) < 1e-9 and np.quantile(errors, 0.8) < 1e-7


@pytest.mark.parametrize("name", ["min-manipulability", "peak-rate", "energy"])
@pytest.mark.sampled(1)
def test_gradients_of_extremes_are_those_of_the_true_value(name, rng):
    """Extremes have a derivative wherever one sample alone holds them."""
    run, value = rollouts("three-axis", 6, name), smooth("three-axis", 6, name)
    knots, step = 0.2 * curves(rng, 6), 1e-5
    found, gradient = value.gradient(knots, 1e-5)
    np.testing.assert_allclose(found, run.values(knots), rtol=1e-3)
    near = np.zeros_like(gradient)
    for i, unit in enumerate(np.eye(6)):
        near[:, i] = (run.values(knots + step * unit) - run.values(knots - step * unit)) / (
            2 * step
        )
    size = np.abs(near).max(axis=1)
    agree = np.abs(gradient - near).max(axis=1) < 1e-3 * size + 1e-6
    assert agree.mean() > 0.6  # two samples that share an extreme, or a limit, are rare


@pytest.mark.parametrize("depth", [1, 2, 71])
def test_any_number_of_knots_has_a_gradient(depth, rng):
    values, gradient = smooth("kinematic", depth).gradient(curves(rng, depth, 3), 0.1)
    assert gradient.shape == (3, depth) and np.isfinite(values).all()
    assert np.abs(gradient).max() > 0


def test_runs_that_are_not_finite_have_no_gradient():
    values, gradient = smooth("kinematic", 2).gradient(np.array([[np.nan, 0.0], [0.5, 0.1]]), 0.1)
    assert values[0] == -np.inf and not gradient[0].any()
    assert np.isfinite(values[1]) and gradient[1].any()


def turned(n, rng):
    """Return a long, turned ellipsoid's value around a centre, partly outside the bounds."""
    axes = np.linalg.qr(rng.normal(size=(n, n)))[0]
    scales = np.logspace(0, 2, n)
    centre = rng.uniform(-0.7, 0.7, n)
    return centre, lambda x: -(((x - centre) @ axes * scales) ** 2).sum(axis=1)


def test_evolution_finds_the_top_of_a_turned_ridge(rng):
    centre, value = turned(8, rng)
    each = Evolution(np.zeros(8), 0.5, np.random.default_rng(1), 32)
    for _ in range(400):
        each.tell(value(each.ask()))
    assert each.settled
    np.testing.assert_allclose(each.knots, centre, atol=1e-4)


def test_evolution_stays_within_the_bounds_and_finds_corners():
    each = Evolution(np.zeros(5), 0.5, np.random.default_rng(1), 16)
    towards = np.array([1.0, -2.0, 3.0, -1.0, 0.5])
    while not each.settled:
        asked = each.ask()
        assert np.abs(asked).max() <= 1.0
        each.tell(asked @ towards)
    np.testing.assert_array_equal(each.knots, np.sign(towards))


def test_evolution_passes_over_what_is_not_finite():
    each = Evolution(np.zeros(3), 0.5, np.random.default_rng(1), 16)
    for _ in range(100):
        asked = each.ask()
        each.tell(np.where(asked[:, 0] > 0.5, -np.inf, -(asked**2).sum(axis=1)))
    assert np.abs(each.knots).max() < 1e-2


def test_curves_keep_their_shape_where_the_new_knots_can_hold_it(rng):
    knots = rng.uniform(-1, 1, 10)
    for alike in resample(knots, 19, 70):
        np.testing.assert_allclose(alike[::2], knots, atol=1e-12)
    np.testing.assert_allclose(resample(knots, 10, 70), [knots, knots], atol=1e-12)
    assert resample(np.array([0.3]), 4, 70)[0].tolist() == [0.3] * 4
    for drawn in (shaken(knots, 5.0, rng), random_curve(7, rng), random_curve(1, rng)):
        assert np.abs(drawn).max() <= 1.0


@pytest.mark.slow
def test_a_search_repeats_and_is_never_worse_than_its_start():
    start, shares = np.array(BEST["roll"], float), []
    found = continuous.search(rollouts(), start, seed=3, evaluations=5000, seconds=60.0)
    again = continuous.search(
        rollouts(), start, seed=3, evaluations=5000, seconds=60.0, progress=shares.append
    )
    assert found.knots == again.knots and found.value == again.value
    assert shares == sorted(shares) and shares[-1] == 1.0
    assert len(found.knots) == 20 and np.abs(found.knots).max() <= 1.0 and not found.proven
    assert found.value == rollouts(depth=20).values(np.array(found.knots))[0]
    best = found.certificate
    assert found.value > best["gradient_value"] > 1.2 * best["start_value"]
    best = np.array(found.knots)
    kept = continuous.search(rollouts(), best, 5, evaluations=0, seconds=60.0)
    assert kept.knots == found.knots and "nothing better" in kept.remarks[0]


def test_no_null_motion_is_always_a_candidate():
    worst = np.full(10, 1.0)
    still = rollouts("three-axis").values(np.zeros(10))[0]
    assert rollouts("three-axis").values(worst)[0] < still
    found = continuous.search(rollouts("three-axis"), worst, evaluations=0, seconds=0.0)
    assert found.value >= still and "clock" in found.remarks[0]


def test_ctrl_c_ends_a_search_with_the_best_so_far():
    def interrupt(share):
        if share > 0.2:
            raise KeyboardInterrupt

    start = np.array(BEST["kinematic"], float)
    found = continuous.search(rollouts("kinematic"), start, seconds=60.0, progress=interrupt)
    assert found.remarks == [INTERRUPTED]
    assert found.value > rollouts("kinematic").values(start)[0]


def test_without_a_derivative_there_is_still_the_evolution(monkeypatch):
    monkeypatch.delitem(derivatives.RULES, "sin")
    start = np.array(BEST["kinematic"], float)
    found = continuous.search(rollouts("kinematic"), start, evaluations=5000, seconds=60.0)
    assert found.remarks[0].startswith("no gradient: operation 'sin'")
    assert found.value > found.certificate["start_value"]


@pytest.mark.slow
@pytest.mark.parametrize("case", BEST)
def test_the_paper_s_manoeuvres_gain_what_is_known(case):
    start = np.array(BEST[case], float)
    before = rollouts(case).values(start)[0]
    found = continuous.search(rollouts(case), start, seconds=120.0)
    assert found.value / before - 1.0 >= 0.95 * KNOWN[case]


@pytest.mark.slow
def test_plans_of_any_method_come_by_the_same_call():
    result = plan.search("papakonstantinou-kinematic", "continuous", evaluations=20_000)
    assert result.method == "continuous" and result.levels is None and len(result.knots) == 20
    assert result.value > 25.0 * result.baseline_value
