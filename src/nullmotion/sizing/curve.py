"""The trade between momentum and gimbal rate: the least momentum that flies at each rate."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from nullmotion.sizing import boundary
from nullmotion.sizing.cases import Cases
from nullmotion.sizing.demand import demand
from nullmotion.sizing.trial import Trial

_HOLDS, _TURNS = 1.5, 0.8  # momentum and torque of a usual array over one CMG's
_ABOVE, _STEP = 1.4, 1.25  # where the search of a momentum starts, over a guess, and its steps
_RAISE = 1.1  # steps upwards where slews were taken in that do not fly


class Design(NamedTuple):
    """Momentum [N m s] and largest gimbal rate [rad/s] of each CMG."""

    h0: float
    rate: float


class Curve:
    """Least momenta of one trial over gimbal rates.

    Args:
        trial: Layout, angle, law and coast.
        cases: Slews that have to be flown.
        rates: Largest gimbal rates [rad/s], increasing.
        tolerance: Relative tolerance of the momenta.

    Attributes:
        h0: Momentum at each rate [N m s]; infinite where none flies.
    """

    def __init__(self, trial: Trial, cases: Cases, rates: np.ndarray, tolerance: float) -> None:
        """Find the momenta."""
        self.trial, self.cases, self.rates, self.tolerance = trial, cases, rates, tolerance
        if trial.unsupported or trial.geometry.reason:
            self.h0 = np.full(len(rates), np.inf)
            return
        guess = self.guess()
        self.h0 = boundary.least(self._flies, _ABOVE * guess, _STEP, tolerance)

    def _flies(self, h0: np.ndarray, lanes: np.ndarray) -> np.ndarray:
        return self.trial.flies(self.cases, h0, self.rates[lanes])

    def guess(self) -> np.ndarray:
        """Return momenta of a usual array for the demand at each rate [N m s]."""
        r, c = self.trial.requirement, self.cases
        asked = demand(self.trial.profile, r.inertia, c.axis, c.bias, r.torque)
        h0 = asked.momenta.max() / _HOLDS
        found: np.ndarray = np.maximum(h0, asked.torques.max() / (_TURNS * self.rates))
        return found * (1.0 + r.margin.momentum)

    @property
    def worth(self) -> np.ndarray:
        """What is least at the knee: h0^weight times the rate, at each rate."""
        weight = self.trial.requirement.array.momentum_weight
        found: np.ndarray = self.h0**weight * self.rates
        return found

    @property
    def best(self) -> float:
        """Least worth."""
        return float(self.worth.min())

    @property
    def knee(self) -> Design:
        """Where the worth is least."""
        i = int(np.argmin(self.worth))
        return Design(float(self.h0[i]), float(self.rates[i]))

    def harden(self, cases: Cases) -> None:
        """Take more slews in; momenta rise where these do not fly."""
        self.cases = self.cases.joined(cases)
        lanes = np.flatnonzero(np.isfinite(self.h0))
        lanes = lanes[~self.trial.flies(cases, self.h0[lanes], self.rates[lanes])]
        if not len(lanes):
            return
        rates = self.rates[lanes]
        self.h0[lanes] = boundary.least(
            lambda h0, which: self.trial.flies(cases, h0, rates[which]),
            self.h0[lanes],
            _RAISE,
            self.tolerance,
        )


def rates(trial_range: tuple[float, float], count: int) -> np.ndarray:
    """Return gimbal rates from the least to the greatest [rad/s], evenly in their logarithm."""
    low, high = trial_range
    return np.geomspace(low, high, count) if high > low else np.array([low])
