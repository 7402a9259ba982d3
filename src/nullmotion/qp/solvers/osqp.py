"""OSQP: operator splitting, polished."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from nullmotion.qp.problem import Problem
from nullmotion.qp.solution import Solution, Status
from nullmotion.qp.solver import Raw, Solver


@dataclass(frozen=True)
class Osqp(Solver):
    """Stellato et al., Math. Prog. Comp. 12 (2020).

    Its own tolerance is a thousandth of ours; it needs that (at 1e-4 the plans of a
    receding horizon are of no use) and thousands of iterations.
    """

    name: ClassVar[str] = "osqp"
    package: ClassVar[str] = "osqp"

    iteration_limit: int = 20_000

    def run(self, problem: Problem, start: Solution | None) -> Raw:
        """Solve with the bounds on x as the first rows; matrices are copies, it scales them."""
        from scipy import sparse

        osqp, n = self.module(), problem.variables
        solver = osqp.OSQP()
        options: dict[str, Any] = {"max_iter": self.iteration_limit, "verbose": False}
        options |= {"eps_abs": 1e-3 * self.tolerance, "eps_rel": 1e-3 * self.tolerance}
        if np.isfinite(self.time_limit_s):
            options["time_limit"] = self.time_limit_s
        solver.setup(
            sparse.csc_matrix(np.array(problem.H)),
            np.array(problem.g),
            sparse.csc_matrix(np.concatenate([np.eye(n), problem.A])),
            np.concatenate([problem.x_lower, problem.lower]),
            np.concatenate([problem.x_upper, problem.upper]),
            polishing=True,
            **options,
        )
        if start is not None:
            solver.warm_start(x=start.x, y=start.multipliers)
        found = solver.solve(raise_error=False)
        code, flag = osqp.SolverStatus, found.info.status_val
        status = {
            code.OSQP_SOLVED: Status.SOLVED,
            code.OSQP_SOLVED_INACCURATE: Status.INACCURATE,
            code.OSQP_PRIMAL_INFEASIBLE: Status.INFEASIBLE,
            code.OSQP_PRIMAL_INFEASIBLE_INACCURATE: Status.INFEASIBLE,
            code.OSQP_MAX_ITER_REACHED: Status.ITERATION_LIMIT,
            code.OSQP_TIME_LIMIT_REACHED: Status.TIME_LIMIT,
        }.get(flag, Status.FAILED)
        return Raw(np.array(found.x), np.array(found.y), status, int(found.info.iter))
