"""DAQP: dual active set; the fastest on dense problems of this size, and exact."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from nullmotion.qp.problem import Problem
from nullmotion.qp.solution import Solution, Status
from nullmotion.qp.solver import Raw, Solver

_STATUS = {
    1: Status.SOLVED,
    2: Status.SOLVED,
    -1: Status.INFEASIBLE,
    -4: Status.ITERATION_LIMIT,
    -7: Status.TIME_LIMIT,
}
_ACTIVE, _EQUATION = 1, 5


@dataclass(frozen=True)
class Daqp(Solver):
    """Arnstrom, Bemporad & Axehill, IEEE Trans. Automatic Control 67 (2022)."""

    name: ClassVar[str] = "daqp"
    package: ClassVar[str] = "daqp"
    install: ClassVar[str] = "pip install daqp"

    def run(self, problem: Problem, start: Solution | None) -> Raw:
        """Solve with the bounds on x before the rows, as DAQP wants them."""
        upper = np.concatenate([problem.x_upper, problem.upper])
        lower = np.concatenate([problem.x_lower, problem.lower])
        sense = np.where(lower == upper, _EQUATION, 0).astype(np.int32)
        options: dict[str, Any] = {"iter_limit": self.iteration_limit}
        options["primal_tol"] = 1e-3 * self.tolerance
        if np.isfinite(self.time_limit_s):
            options["time_limit"] = self.time_limit_s
        if start is not None:
            options |= {"primal_start": start.x, "dual_start": start.multipliers}
        H, g, A = (np.array(v) for v in (problem.H, problem.g, problem.A))  # it wants to write
        x, _, flag, info = self.module().solve(H, g, A, upper, lower, sense, **options)
        status = _STATUS.get(flag, Status.FAILED)
        # without a solution both are whatever stood in that memory
        found = status is Status.SOLVED
        multipliers = info["lam"] if found else None
        return Raw(x if found else None, multipliers, status, int(info["iterations"]))
