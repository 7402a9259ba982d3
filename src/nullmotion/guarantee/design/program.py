"""Linear programs with many inequalities of which few matter."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.optimize import linprog

_FIRST = 400  # inequalities to begin with
_MORE = 250  # added at a time
_ROUNDS = 60
_HELD = 1e-8


class Step(NamedTuple):
    """Solution: change of the coefficients, of the radii, and the slack."""

    change: np.ndarray
    radii: np.ndarray
    slack: float


class Program:
    """Steps x of n coefficients and y of m radii that maximise gain . x + weight . y - penalty e.

    With e >= 0, |x| <= size, -1 <= y <= ceiling and any number of

        value + slope . x + rate y_k (+ e) >= 0
    """

    def __init__(self, n: int, m: int) -> None:
        """Begin without inequalities."""
        self.n, self.m = n, m
        self._slopes: list[np.ndarray] = [np.empty((0, n + m + 1))]
        self._values: list[np.ndarray] = [np.empty(0)]

    def need(
        self,
        values: np.ndarray,
        slopes: np.ndarray,
        rates: np.ndarray | None = None,
        radius: int = 0,
        elastic: bool = False,
    ) -> None:
        """Add inequalities; what is not a number is left out.

        Args:
            values: Values now, (k,).
            slopes: Slopes over the coefficients, (k, n).
            rates: Slopes over one of the radii, (k,).
            radius: Which one.
            elastic: Whether the slack helps.
        """
        rows = np.zeros((len(values), self.n + self.m + 1))
        rows[:, : self.n] = slopes
        if rates is not None:
            rows[:, self.n + radius] = rates
        rows[:, -1] = float(elastic)
        good = np.isfinite(values) & np.isfinite(rows).all(axis=1)
        self._slopes.append(rows[good])
        self._values.append(values[good])

    def solve(
        self, gain: np.ndarray, weight: np.ndarray, penalty: float, size: float, ceiling: np.ndarray
    ) -> Step | None:
        """Return the best step; None where there is none.

        By HiGHS on the inequalities that come closest, with those added that its answer
        breaks, until it breaks none.
        """
        slopes, values = np.concatenate(self._slopes), np.concatenate(self._values)
        reach = np.abs(slopes[:, : self.n]).sum(axis=1) * size
        matters = (values < reach) | slopes[:, self.n : -1].any(axis=1)
        slopes, values, reach = slopes[matters], values[matters], reach[matters]
        active = np.zeros(len(values), bool)
        active[_least(values / np.maximum(reach, _HELD), _FIRST)] = True
        cost = np.concatenate([-gain, -weight, [penalty]])
        bounds = [(-size, size)] * self.n + [(-1.0, c) for c in ceiling] + [(0.0, None)]
        for _ in range(_ROUNDS):
            found = linprog(cost, -slopes[active], values[active], bounds=bounds, method="highs")
            if found.x is None:
                return None
            broken = np.where(active, 0.0, -(values + slopes @ found.x))
            worst = _least(-broken, _MORE)
            worst = worst[broken[worst] > _HELD]
            if not len(worst):
                break
            active[worst] = True
        x = found.x
        return Step(x[: self.n], x[self.n : -1], float(x[-1]))


def _least(values: np.ndarray, count: int) -> np.ndarray:
    """Return where the least of values are."""
    return np.argpartition(values, count)[:count] if count < len(values) else np.arange(len(values))
