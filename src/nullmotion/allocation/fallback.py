"""What an allocation remembers, and what it does when there is no solution in time."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from nullmotion import linalg, qp
from nullmotion.allocation.limits import Limits
from nullmotion.array.model import CmgArray

_SIGMA_FLOOR = 1e-4  # as in the law pseudo-inverse


class Memory(NamedTuple):
    """What goes from sample to sample.

    Attributes:
        plan: Rates for the coming moves as planned at the sample before [rad/s], (N, n).
        planned: Number of its rows that come from a solution.
        rates: Rates of the sample before [rad/s], (n,).
        normal: Direction away from the nearest singular configuration, (n,).
        fallbacks: How often the plan stood in for a solution, and the pseudo-inverse.
    """

    plan: np.ndarray
    planned: int
    rates: np.ndarray
    normal: np.ndarray
    fallbacks: tuple[int, int] = (0, 0)

    @classmethod
    def empty(cls, n: int, moves: int) -> Memory:
        """Return the memory before the first sample."""
        return cls(np.zeros((moves, n)), 0, np.zeros(n), np.zeros(n))

    def solved(self, moves: np.ndarray, normal: np.ndarray) -> Memory:
        """Return the memory after a solution: its moves shifted by one, the last one doubled."""
        plan = np.concatenate([moves[1:], moves[-1:]])
        return Memory(plan, len(moves) - 1, moves[0], normal, self.fallbacks)

    def counts(self) -> Mapping[str, int]:
        """Return how often each fall-back was taken."""
        return dict(zip(("fell_back_to_plan", "fell_back_to_inverse"), self.fallbacks, strict=True))


def fall_back(
    array: CmgArray, obs: Any, memory: Memory, before: Any, limits: Limits, normal: Any
) -> tuple[np.ndarray, Memory]:
    """Return the rates planned before, else those of the limited pseudo-inverse."""
    plans, inverses = memory.fallbacks
    if memory.planned:
        wanted, planned, counts = memory.plan[0], memory.planned - 1, (plans + 1, inverses)
    else:
        wanted, planned, counts = least(array, obs), 0, (plans, inverses + 1)
    rates = limits.held(wanted, before, obs.delta, obs.period)
    plan = np.concatenate([memory.plan[1:], memory.plan[-1:]])
    return rates, Memory(plan, planned, rates, normal, counts)


def least(array: CmgArray, obs: Any) -> np.ndarray:
    """Return the least rates that give hdot [rad/s], (n,); finite at singular states."""
    rows = linalg.rows(array.unit_jacobian(obs.delta), obs.hdot / array.mean_momentum)
    return np.asarray(rows.solve(np.maximum(rows.squares, _SIGMA_FLOOR**2)))


@lru_cache(maxsize=16)
def solver(name: str, time_limit_s: float | None) -> qp.Solver:
    """Return a solver with its limit of time [s]; none if None."""
    limits = {} if time_limit_s is None else {"time_limit_s": time_limit_s}
    return qp.create(name, **limits)
