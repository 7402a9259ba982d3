"""The paper's skip rule on a tree small enough to follow by hand."""

from __future__ import annotations

import numpy as np
import pytest

from nullmotion.plan import skip
from nullmotion.plan.enumerate import course


class Table:
    """Nine courses of two knots with given values, and what was asked."""

    depth = 2

    def __init__(self, values):
        self._values = np.array(values, float)

    def values(self, knots):
        place = np.rint(np.asarray(knots) + 1) @ [3, 1]
        return self._values[place.astype(int)]


def test_courses_come_in_the_order_of_the_tree():
    found = course(np.arange(9), 2, 3).tolist()
    assert found[:4] == [[-1, -1], [-1, 0], [-1, 1], [0, -1]]
    assert found[-1] == [1, 1]


def test_by_hand():
    # leaf 0 is the first and best; 1 is worse: skip 2, so 2 and 3 are passed; 4 is better: skip
    # nothing; 5 is worse: skip 6 and 7; 8 is better
    found = skip.search(Table([1, 0, 9, 9, 2, 0, 9, 9, 3]), step=2, most=4)
    assert found.rollouts == 5
    assert found.knots == (1.0, 1.0) and found.value == 3.0
    assert not found.proven


def test_the_skip_has_a_limit_and_equal_is_not_better():
    # 0; 1 equal: skip 1 (2); 3 worse: skip 2 (4, 5); 6 worse: skip 2 (7, 8)
    found = skip.search(Table([5, 5, 9, 1, 4, 9, 1, 9, 9]), step=1, most=2)
    assert found.rollouts == 4
    assert found.knots == (-1.0, -1.0)


def test_never_worse_than_no_null_motion():
    # leaf 4 is no null motion; the rule passes it by
    found = skip.search(Table([1, 0, 0, 0, 7, 0, 0, 0, 0]), step=10, most=250)
    assert found.knots == (0.0, 0.0) and found.value == 7.0
    assert found.certificate["heuristic_knots"] == [-1.0, -1.0]
    assert found.certificate["heuristic_value"] == 1.0
    assert "no better than no null motion" in found.remarks[0]


@pytest.mark.parametrize("ahead", [1, 2, 64])
def test_what_is_evaluated_ahead_does_not_count(monkeypatch, ahead):
    monkeypatch.setattr(skip, "_AHEAD", ahead)
    rng = np.random.default_rng(3)
    for _ in range(50):
        values = rng.integers(0, 9, 9)
        found = skip.search(Table(values), step=1, most=3)
        assert (found.rollouts, found.certificate["heuristic_value"]) == by_rule(values, 1, 3)


def by_rule(values, step, most):
    place, skipped, count, best = 0, 0, 0, -np.inf
    while place < len(values):
        count += 1
        skipped = 0 if values[place] > best else min(skipped + step, most)
        best = max(best, values[place])
        place += 1 + skipped
    return count, best
