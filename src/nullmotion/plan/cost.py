"""What a cost of a plan is: terms summed up in the kernel, a value, and an upper bound."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from typing import Any, ClassVar

import numpy as np

from nullmotion.array.model import CmgArray
from nullmotion.metrics.base import Metric
from nullmotion.plan.terms import Index
from nullmotion.sim.setup import Setup

_STOPPED = 1e-9  # share of momentum that still counts as working
_ROUNDING = 1.0 + 1e-12  # a computed measure may pass its bound by its last digits


@dataclass(frozen=True)
class Cost:
    """Base of costs: one file under ``plan/costs/`` with one frozen dataclass.

    Its `terms` are measured over the samples before each step of a run, `value` makes one
    number of them (the greater the better), and `bound` says how good a run can still get
    whose first samples are known. That a bound is never below the value of any completion
    is what a proof of optimality rests on.

    Class attributes:
        name: Name on the command line and in files.
        title: Label of tables.
        citation: Where it comes from.
    """

    name: ClassVar[str] = ""
    title: ClassVar[str] = ""
    citation: ClassVar[str] = ""

    def terms(self, setup: Setup) -> tuple[Metric, ...]:
        """Return what is measured on the way, each with one reduction."""
        raise NotImplementedError

    def value(self, totals: np.ndarray, samples: int) -> Any:
        """Return the value of whole runs.

        Args:
            totals: A row for each term: sums of ``mean`` terms, the extremes of others,
                (terms, ...).
            samples: Number of samples.
        """
        raise NotImplementedError

    def bound(self, totals: np.ndarray, done: int, samples: int, array: CmgArray) -> Any:
        """Return a number that no completion of runs exceeds.

        Args:
            totals: As for `value`, over the first ``done`` samples.
            done: Samples that are known.
            samples: Samples of a whole run.
            array: The array that really turns; see `widest_array`.
        """
        raise NotImplementedError

    def parts(self, totals: np.ndarray, samples: int) -> dict[str, Any]:
        """Return what the value is made of, by name."""
        return {}

    def remarks(self, totals: np.ndarray, samples: int) -> list[str]:
        """Return what has to be said about the value of a run."""
        return []


def widest_array(setup: Setup) -> CmgArray:
    """Return the true array at the moment when its manipulability can be greatest.

    A wheel that spins down takes part with less of the mean momentum, the others with more.
    The bound of `greatest_manipulability` is quasi-convex in the momenta: its greatest value
    is at a corner, where each such wheel has all or the least of its momentum.
    """
    array = setup.true_array
    left = np.ones(array.n)
    for event in setup.events:
        if event.kind == "spin-down":
            left[event.cmg] *= event.final_fraction
    corners = [
        np.asarray(array.h0) * np.where(corner, np.maximum(left, _STOPPED), 1.0)
        for corner in product(*[(False, True) if share < 1 else (False,) for share in left])
    ]
    arrays = [array.altered(h0=h0) for h0 in corners]
    return max(arrays, key=lambda a: greatest_manipulability(a, "det"))


def greatest_manipulability(array: CmgArray, index: Index) -> float:
    """Return a bound of the manipulability over all gimbal angles.

    The columns of A / mean momentum are at most h0_i / mean momentum long, so that the
    trace of A A^T is at most the sum S of their squares, and of all m x m matrices of this
    trace the multiple of I has the greatest determinant: det(A A^T) <= (S / m)^m. For n
    equal CMGs, sqrt(det) <= (n / m)^(m / 2).
    """
    relative = np.asarray(array.h0, float) / float(array.mean_momentum)
    det = float(relative @ relative / array.m) ** array.m
    return (np.sqrt(det) if index == "sqrt-det" else det) * _ROUNDING
