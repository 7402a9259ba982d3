"""Mean manipulability over time near singularity, error and time at the rate limit."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from nullmotion.array.model import CmgArray
from nullmotion.errors import InputError
from nullmotion.metrics.base import Metric
from nullmotion.plan import terms
from nullmotion.plan.cost import Cost, greatest_manipulability
from nullmotion.sim.setup import Setup

_LEAST = 1e-9  # of the denominator


@dataclass(frozen=True)
class Papakonstantinou(Cost):
    """The paper's cost function, to be maximised.

        CF = g1 w_mean / (g2 T_w + g3 |e|_max + g4 T_sat)

    w_mean is the mean manipulability of A / mean momentum, T_w the number of samples with
    w below its threshold, T_sat the number with a rate above its threshold, before any
    limit. |e|_max is the norm of the greatest errors along each axis: of an attitude the
    3-2-1 angles of the error [rad], on the way to a momentum what is missing of it
    [N m s], else A delta_dot - hdot [N m]. A denominator below 1e-9 counts as 1e-9.

    Args:
        weights: g1 to g4; the printed CF needs g1 = 50 (Table 1 prints 300).
        manipulability_threshold: w_th.
        rate_threshold: Rate above which T_sat counts [rad/s]; None for the rate limits.
        index: w: the root of det(A A^T), or (kinematic model) the determinant.
    """

    name: ClassVar[str] = "papakonstantinou"
    title: ClassVar[str] = "CF"
    citation: ClassVar[str] = "Papakonstantinou et al. (2021), Eq 25"

    weights: tuple[float, float, float, float] = (50.0, 5.0, 4.0, 6.0)
    manipulability_threshold: float = 0.5
    rate_threshold: float | None = None
    index: terms.Index = "sqrt-det"

    def __post_init__(self) -> None:
        """Check the parameters."""
        given = np.asarray(self.weights, float)
        if given.shape != (4,) or not (np.isfinite(given).all() and (given >= 0).all()):
            raise InputError("plan.weights", self.weights, "four finite numbers from 0")
        object.__setattr__(self, "weights", tuple(given.tolist()))
        for key in ("manipulability_threshold", "rate_threshold"):
            value = getattr(self, key)
            if value is not None and not (np.isfinite(value) and value > 0):
                raise InputError(f"plan.{key}", value, "a finite number above 0")
        if self.index not in ("sqrt-det", "det"):
            raise InputError("plan.index", self.index, "'sqrt-det' or 'det'")

    def terms(self, setup: Setup) -> tuple[Metric, ...]:
        """Return w, the two counts, and the error along each axis."""
        return (
            terms.MeanManipulability(self.index),
            terms.LowManipulability(self.manipulability_threshold, self.index),
            terms.RateExcess(self.rate_threshold),
            *_errors(setup),
        )

    def value(self, totals: np.ndarray, samples: int) -> Any:
        """Return CF."""
        return self._ratio(totals[0] / samples, totals)

    def bound(self, totals: np.ndarray, done: int, samples: int, array: CmgArray) -> Any:
        """Return CF if w were greatest at all coming samples and nothing got worse."""
        best = greatest_manipulability(array, self.index)
        return self._ratio((totals[0] + (samples - done) * best) / samples, totals)

    def _ratio(self, mean: Any, totals: np.ndarray) -> Any:
        return self.weights[0] * mean / np.maximum(self._denominator(totals), _LEAST)

    def _denominator(self, totals: np.ndarray) -> Any:
        _, g2, g3, g4 = self.weights
        errors = np.maximum(totals[3:], 0.0)  # nothing measured yet: -inf
        return g2 * totals[1] + g3 * np.sqrt((errors * errors).sum(axis=0)) + g4 * totals[2]

    def parts(self, totals: np.ndarray, samples: int) -> dict[str, Any]:
        """Return the terms of Eq 25."""
        return {
            "mean_manipulability": totals[0] / samples,
            "samples_of_low_manipulability": totals[1],
            "greatest_error": np.sqrt((totals[3:] * totals[3:]).sum(axis=0)),
            "samples_of_rate_excess": totals[2],
        }

    def remarks(self, totals: np.ndarray, samples: int) -> list[str]:
        """Tell of a denominator that is nearly zero."""
        if self._denominator(totals) > _LEAST:
            return []
        return [f"the cost's denominator is below {_LEAST:g} and counts as {_LEAST:g}"]


def _errors(setup: Setup) -> tuple[Metric, ...]:
    if setup.spacecraft is not None:
        return tuple(terms.AttitudeError(axis) for axis in range(3))
    if setup.momentum_target is not None:
        return tuple(terms.MomentumLeft(i, float(h)) for i, h in enumerate(setup.momentum_target))
    return tuple(terms.TorqueError(axis) for axis in range(setup.array.m))
