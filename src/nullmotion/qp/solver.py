"""What a solver is, and the one place where its answers are judged."""

from __future__ import annotations

import importlib
import time
from dataclasses import dataclass
from types import ModuleType
from typing import Any, ClassVar, NamedTuple

import numpy as np

from nullmotion.errors import InputError
from nullmotion.qp.problem import Problem
from nullmotion.qp.solution import Solution, Status
from nullmotion.registry import Registry


class Raw(NamedTuple):
    """A solver's own words: a point and multipliers (None without), a status, a count."""

    x: np.ndarray | None
    multipliers: np.ndarray | None
    status: Status
    iterations: int


@dataclass(frozen=True)
class Solver:
    """Base of solvers: one file under ``qp/solvers`` with one frozen dataclass.

    Args:
        tolerance: KKT residual (`Residuals.worst`) up to which a problem counts as solved.
        iteration_limit: Most iterations, as the solver counts them.
        time_limit_s: Most wall time [s]; a solver without a clock is judged when it is done.

    Class attributes:
        name: Name in the registry.
        package: What is imported; installed by `install`.
        install: What to type where it is missing.
    """

    name: ClassVar[str] = ""
    package: ClassVar[str] = ""
    install: ClassVar[str] = "pip install 'nullmotion[qp]'"

    tolerance: float = 1e-6
    iteration_limit: int = 1000
    time_limit_s: float = float("inf")

    def __post_init__(self) -> None:
        """Check the limits and that the package is there."""
        for key in ("tolerance", "iteration_limit", "time_limit_s"):
            if not getattr(self, key) > 0:
                raise InputError(f"solver.{key}", getattr(self, key), "above 0")
        self.module()

    @classmethod
    def module(cls) -> ModuleType:
        """Return the solver's package.

        Raises:
            InputError: When it is not installed; says what to install.
        """
        try:
            return importlib.import_module(cls.package)
        except ImportError as error:
            allowed = f"an installed solver: {cls.install}"
            raise InputError("solver", cls.name, allowed) from error

    def solve(self, problem: Problem, start: Solution | None = None) -> Solution:
        """Return the solution of a problem, or why there is none.

        Args:
            problem: What to solve.
            start: Solution of a problem of the same shape close to this one.
        """
        if start is not None and not _fits(start, problem):
            start = None
        begin = time.perf_counter()
        raw = self.run(problem, start)
        seconds = time.perf_counter() - begin
        x = np.full(problem.variables, np.nan) if raw.x is None else raw.x
        y = raw.multipliers
        if y is None:
            y = np.full(problem.variables + problem.rows, np.nan)
        worst = problem.residuals(x, y).worst
        status = raw.status
        if status is Status.SOLVED and not worst <= self.tolerance:
            status = Status.INACCURATE
        if status is Status.SOLVED and seconds > self.time_limit_s:
            status = Status.TIME_LIMIT
        return Solution(x, y, status, raw.iterations, seconds, worst, self.name)

    def run(self, problem: Problem, start: Solution | None) -> Raw:
        """Ask the package; never raises for a problem that cannot be solved."""
        raise NotImplementedError


def _fits(start: Solution, problem: Problem) -> bool:
    n = problem.variables
    same = start.x.shape == (n,) and start.multipliers.shape == (n + problem.rows,)
    return same and bool(np.isfinite(start.x).all() and np.isfinite(start.multipliers).all())


registry = Registry("solver", "nullmotion.qp.solvers", "nullmotion.qp.solver.Solver")
names = registry.names


def create(name: str = "daqp", **limits: Any) -> Solver:
    """Return a solver by name; see `Solver` for its limits.

    Raises:
        UnknownNameError: For an unknown solver or limit.
        InputError: For a solver that is not installed.
    """
    made: Solver = registry.create(name, **limits)
    return made


def solve(
    problem: Problem, solver: str = "daqp", start: Solution | None = None, **limits: Any
) -> Solution:
    """Return a problem's solution by the solver of that name."""
    return create(solver, **limits).solve(problem, start)
