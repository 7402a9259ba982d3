"""Small dense quadratic programs: problem and solution are data, the problem judges the answer.

    minimise 1/2 x^T H x + g^T x    with    lower <= A x <= upper,  x_lower <= x <= x_upper

    problem = qp.Problem(H, g, A, lower, upper, x_lower, x_upper)    # None: no such thing
    solution = qp.solve(problem)                                     # DAQP
    solver = qp.create("piqp", tolerance=1e-7, iteration_limit=50)   # a solver and its limits
    solution = solver.solve(problem, start=solution)                 # warm
    solution.x, solution.multipliers, solution.status, solution.iterations, solution.seconds
    problem.residuals(solution.x, solution.multipliers).worst        # how well KKT holds

Multipliers y come as one vector: those of the bounds on x first, then those of the rows of A;
y > 0 pushes against an upper bound, y < 0 against a lower one, so that

    H x + g + [I; A]^T y = 0.

Bounds may be infinite; a row with lower == upper is an equation. `Status.SOLVED` says that
the KKT residuals, taken by the problem itself, are within the solver's tolerance. What goes wrong
is a status and never an exception: x is then the solver's last point (NaN without one). `softened`
lets rows be violated at a price. A new solver is one file under ``qp/solvers``.
"""

from nullmotion.qp.problem import Problem, Residuals
from nullmotion.qp.soft import softened
from nullmotion.qp.solution import Solution, Status
from nullmotion.qp.solver import Solver, create, names, registry, solve

__all__ = [
    "Problem",
    "Residuals",
    "Solution",
    "Solver",
    "Status",
    "create",
    "names",
    "registry",
    "softened",
    "solve",
]
