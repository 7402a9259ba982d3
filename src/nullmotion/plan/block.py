"""Memory of rollouts, and which numbers of a manoeuvre differ between them."""

from __future__ import annotations

from typing import Any

import numpy as np

from nullmotion import tree
from nullmotion.compile.kernel import LoopKernel
from nullmotion.errors import InputError
from nullmotion.plan.segment import LEAVES
from nullmotion.sim.setup import Setup
from nullmotion.sim.state import parameters


class Block:
    """Memory of runs that advance together.

    Attributes:
        state: What the runs carry, (carried, lanes).
        values: What differs between them: a, b, t0, 1/T, start angles; (4 + n, lanes).
        out: Totals of the cost's terms, then status flags, (terms + flags, lanes).
    """

    def __init__(self, kernel: LoopKernel, n: int, lanes: int) -> None:
        """Reserve memory for at least so many runs."""
        self.lanes = -(-lanes // kernel.width) * kernel.width
        self.state = np.zeros((kernel.carried, self.lanes))
        self.values = np.zeros((LEAVES + n, self.lanes))
        self.out = np.zeros((kernel.outputs + len(kernel.flags), self.lanes))


def checked_depth(depth: int, steps: int) -> int:
    """Return a number of knots that leaves no segment without a step."""
    whole = isinstance(depth, (int, np.integer)) and not isinstance(depth, bool)
    if not whole or not 1 <= depth <= steps + 1:
        raise InputError("depth", depth, f"a whole number of knots from 1 to {steps + 1}")
    return int(depth)


def checked_unit(k_max: float) -> float:
    """Return a unit of the knots that is a number above 0."""
    number = isinstance(k_max, (int, float, np.number)) and not isinstance(k_max, bool)
    if not (number and np.isfinite(k_max) and k_max > 0):
        raise InputError("k_max", k_max, "a finite number above 0 (rad/s)")
    return float(k_max)


def finite(values: Any) -> np.ndarray:
    """Return values with -inf for what is not a number."""
    return np.where(np.isnan(values), -np.inf, values)


def varying(setup: Setup) -> tuple[bool, ...]:
    """Mark the ends of the segment and the start angles."""
    own = parameters(setup)

    def first(name: str) -> int:
        return len(tree.flatten(own[: own._fields.index(name)]))

    law, delta = first("law"), first("delta")
    chosen = {*range(law, law + LEAVES), *range(delta, delta + setup.array.n)}
    return tuple(i in chosen for i in range(len(tree.flatten(own))))
