"""PIQP: proximal interior point."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from nullmotion.qp.problem import Problem
from nullmotion.qp.solution import Solution, Status
from nullmotion.qp.solver import Raw, Solver


@dataclass(frozen=True)
class Piqp(Solver):
    """Schwan, Jiang, Kuhn & Jones, IEEE CDC 2023. Has neither a warm start nor a clock."""

    name: ClassVar[str] = "piqp"
    package: ClassVar[str] = "piqp"

    def run(self, problem: Problem, start: Solution | None) -> Raw:
        """Solve; infinite bounds stay infinite (it fails with large numbers instead)."""
        piqp = self.module()
        equal = problem.lower == problem.upper
        solver = piqp.DenseSolver()
        solver.settings.eps_abs = solver.settings.eps_rel = 1e-3 * self.tolerance
        solver.settings.max_iter = self.iteration_limit
        A = np.asarray(problem.A)
        solver.setup(
            np.asfortranarray(problem.H),
            np.array(problem.g),
            np.asfortranarray(A[equal]),
            problem.lower[equal],
            np.asfortranarray(A[~equal]),
            problem.lower[~equal],
            problem.upper[~equal],
            np.array(problem.x_lower),
            np.array(problem.x_upper),
        )
        flag = solver.solve()
        status = {
            piqp.PIQP_SOLVED: Status.SOLVED,
            piqp.PIQP_MAX_ITER_REACHED: Status.ITERATION_LIMIT,
            piqp.PIQP_PRIMAL_INFEASIBLE: Status.INFEASIBLE,
        }.get(flag, Status.FAILED)
        found = solver.result
        y = np.zeros(problem.variables + problem.rows)
        y[: problem.variables] = found.z_bu - found.z_bl
        rows = y[problem.variables :]
        rows[equal], rows[~equal] = found.y, found.z_u - found.z_l
        return Raw(np.array(found.x), y, status, int(found.info.iter))
