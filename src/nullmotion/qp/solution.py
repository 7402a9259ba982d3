"""What a solver answers."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

import numpy as np


class Status(StrEnum):
    """How a solve ended."""

    SOLVED = "solved"  # the problem's own residuals are within the tolerance
    INACCURATE = "inaccurate"  # the solver was content, the residuals are not within it
    INFEASIBLE = "infeasible"
    ITERATION_LIMIT = "iteration limit"
    TIME_LIMIT = "time limit"
    FAILED = "failed"


@dataclass(frozen=True, eq=False)
class Solution:
    """Answer to a `Problem`.

    Attributes:
        x: The point, (n,); the solver's last one if it did not get there, NaN without one.
        multipliers: Of the bounds on x and then of the rows of A, (n + k,).
        status: How the solve ended.
        iterations: As the solver counts them.
        seconds: Wall time of the solver alone, set-up included.
        residual: The worst KKT residual (`Residuals.worst`).
        solver: Name of the solver.
    """

    x: np.ndarray
    multipliers: np.ndarray
    status: Status
    iterations: int
    seconds: float
    residual: float
    solver: str = ""

    @property
    def solved(self) -> bool:
        """Whether the point can be used."""
        return self.status is Status.SOLVED
