"""Papakonstantinou et al. (2021): the heuristic's expansions and sequences, the exact optima."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from nullmotion import plan
from nullmotion.plan import enumerate, exact, skip
from nullmotion.scenario import build, load_scenario

PRINTED = {
    "roll": [1, 1, 0, -1, 0, 0, 0, 0, 0, 0],
    "three-axis": [0, -1, 1, 0, 0, 0, 0, 0, 1, -1],
    "kinematic": [-1, 1, 1, 1, 1, 0, -1, 0, 0, -1],
}
BEST = {
    "roll": [1, 0, -1, -1, 0, 0, 0, 0, 0, 0],
    "three-axis": [1, 1, 1, 0, 0, 0, 0, 0, 0, 0],
    "kinematic": [1, 1, 1, 1, 0, -1, 0, 0, 0, 0],
}
cases = pytest.mark.parametrize("case", PRINTED)


@cache
def rollouts(case):
    from nullmotion.plan.from_scenario import setup_of

    setup, wanted = setup_of(f"papakonstantinou-{case}")
    wanted.pop("levels")
    return plan.prepared(setup, **wanted | {"lag": case != "kinematic"})


def gains(case, knots):
    """Return the change of CF, of w, T_w, error and T_sat in percent, and T_w, T_sat."""
    run = rollouts(case)
    totals = run.totals([[0.0] * 10, knots])
    values, parts = run.judged(totals), run.cost.parts(totals, run.steps)
    change = [100 * (x[1] / x[0] - 1) for x in (values, *parts.values())]
    low, high = parts["samples_of_low_manipulability"], parts["samples_of_rate_excess"]
    return change, low.tolist(), high.tolist()


@pytest.mark.parametrize(
    ("case", "printed", "low", "high"),
    [
        ("roll", [99.26, 85.07, -50.0, None, 47.06], [26, 13], [17, 25]),
        ("three-axis", [103.41, 67.03, -90.32, -0.003, 114.29], [31, 3], [14, 30]),
        ("kinematic", [1806.5, 411.01, None, 0.638, 235.71], [57, 10], [14, 47]),
    ],
)
def test_the_printed_sequences_change_the_terms_as_printed(case, printed, low, high):
    change, found_low, found_high = gains(case, PRINTED[case])
    for a, b in zip(change, printed, strict=True):
        assert b is None or a == pytest.approx(b, abs=0.05)
    assert (found_low, found_high) == (low, high)


def test_the_baseline_of_the_roll():
    run = rollouts("roll")
    totals = run.totals(np.zeros(10))
    assert totals[0, 0] / 70 == pytest.approx(0.603939, abs=1e-6)


@pytest.mark.parametrize(
    ("case", "expansions"), [("roll", 308), ("three-axis", 330), ("kinematic", 268)]
)
def test_the_heuristic_expands_as_often_as_printed(case, expansions):
    found = skip.search(rollouts(case))  # kinematic model: 284 are printed
    assert found.rollouts == expansions
    assert not found.proven
    if case != "kinematic":
        assert found.knots == tuple(PRINTED[case])


@pytest.mark.parametrize(
    ("case", "gain", "rank"),
    [("roll", 103.01, 4), ("three-axis", 216.58, 336), ("kinematic", 2670.69, 2191)],
)
def test_the_exact_optimum(case, gain, rank):
    run = rollouts(case)
    found = exact.search(run)
    assert found.proven and found.knots == tuple(BEST[case])
    assert gains(case, found.knots)[0][0] == pytest.approx(gain, abs=0.05)
    negative = tuple(-k + 0.0 for k in found.knots)
    assert found.ties == ([negative] if case == "kinematic" else [])
    assert found.rollouts < 200
    values = enumerate.all_values(run)
    assert values.max() == found.value
    assert (values > run.values(PRINTED[case])[0] * (1 + 1e-9)).sum() + 1 == rank


@cases
def test_more_knots_and_more_levels_gain_more(case):
    run = rollouts(case)
    ternary = exact.search(run)
    for other, levels in ((run, 7), (run.of_depth(16), 3)):
        found = exact.search(other, levels)
        assert found.proven and found.value > ternary.value
        counts = found.certificate
        settled = counts["leaves_evaluated"] + counts["pruned_sequences"]
        assert settled == counts["sequences"] == levels**other.depth


def test_a_scenario_s_plan_section_is_used():
    scenario = load_scenario("papakonstantinou-kinematic", {"plan.depth": 4, "plan.duration_s": 3})
    found = plan.search(scenario)
    assert (found.depth, found.duration_s, found.levels) == (4, pytest.approx(3.0), 3)
    assert found.cost_parameters["weights"] == (300.0, 50.0, 4.0, 6.0)
    assert found.cost_parameters["index"] == "det"
    assert plan.search(scenario, depth=3).depth == 3
    assert plan.search(build.setup(scenario)).depth == 10
