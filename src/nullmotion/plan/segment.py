"""The law of one segment of a plan: null motion along a line whose ends differ between runs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from nullmotion.array.model import CmgArray
from nullmotion.law import Law, Observation
from nullmotion.laws.follow_plan import with_null_motion

LEAVES = 4  # numbers that come first among the law's and differ between runs


@dataclass(frozen=True)
class SegmentLaw(Law):
    """Rates of a base law and null motion 4 k_max k(t) n with k(t) = a + (b - a)(t - t0) / T.

    Args:
        a: k at the segment's start.
        b: k at its end.
        t0: Time of its start [s].
        inverse: 1 / T [1/s].
        base: Law whose rates come first.
        k_max: Unit of a and b [rad/s].
        lag: Take n at the sample before.
    """

    a: float
    b: float
    t0: float
    inverse: float
    base: Law
    k_max: float
    lag: bool

    def init(self, array: CmgArray, delta: Any) -> Any:
        """Return the base law's state and the null vector of the sample before."""
        return self.base.init(array, delta), np.zeros(array.n) if self.lag else ()

    def step(self, array: CmgArray, obs: Observation, state: Any) -> tuple[Any, Any]:
        """Return the base law's rates and the null motion."""
        rates, carried = self.base.step(array, obs, state[0])
        k = self.k_max * (self.a + (self.b - self.a) * ((obs.t - self.t0) * self.inverse))
        return with_null_motion(array, obs, rates, carried, state[1], k)
