"""Clarabel: conic interior point; slow on small problems, a reference for the others."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from nullmotion.qp.problem import Problem
from nullmotion.qp.solution import Solution, Status
from nullmotion.qp.solver import Raw, Solver


@dataclass(frozen=True)
class Clarabel(Solver):
    """Goulart & Chen (2024). Has no warm start."""

    name: ClassVar[str] = "clarabel"
    package: ClassVar[str] = "clarabel"

    def run(self, problem: Problem, start: Solution | None) -> Raw:
        """Solve with one row for each finite side of a bound and one for each equation."""
        from scipy import sparse

        clarabel, n = self.module(), problem.variables
        rows = np.concatenate([np.eye(n), problem.A])
        low = np.concatenate([problem.x_lower, problem.lower])
        high = np.concatenate([problem.x_upper, problem.upper])
        equal = low == high
        up, down = np.isfinite(high) & ~equal, np.isfinite(low) & ~equal
        stacked = np.concatenate([rows[equal], rows[up], -rows[down]])
        bounds = np.concatenate([high[equal], high[up], -low[down]])
        cones = [
            clarabel.ZeroConeT(int(equal.sum())),
            clarabel.NonnegativeConeT(int(up.sum() + down.sum())),
        ]
        settings = clarabel.DefaultSettings()
        settings.verbose = False
        settings.max_iter = self.iteration_limit
        if np.isfinite(self.time_limit_s):
            settings.time_limit = self.time_limit_s
        own = 1e-3 * self.tolerance
        settings.tol_feas = settings.tol_gap_abs = settings.tol_gap_rel = own
        upper = sparse.csc_matrix(np.triu(problem.H))
        solver = clarabel.DefaultSolver(
            upper, np.array(problem.g), sparse.csc_matrix(stacked), bounds, cones, settings
        )
        found = solver.solve()
        code = clarabel.SolverStatus
        known = (
            (code.Solved, Status.SOLVED),
            (code.AlmostSolved, Status.INACCURATE),
            (code.PrimalInfeasible, Status.INFEASIBLE),
            (code.AlmostPrimalInfeasible, Status.INFEASIBLE),
            (code.MaxIterations, Status.ITERATION_LIMIT),
            (code.MaxTime, Status.TIME_LIMIT),
        )
        status = next((s for c, s in known if found.status == c), Status.FAILED)
        z = np.array(found.z)
        y = np.zeros(len(rows))
        first, second = int(equal.sum()), int(equal.sum() + up.sum())
        y[equal] = z[:first]
        y[up] += z[first:second]
        y[down] -= z[second:]
        return Raw(np.array(found.x), y, status, int(found.iterations))
