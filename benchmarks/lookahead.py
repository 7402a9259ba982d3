"""Looking ahead: what a sample of the law `receding-horizon` takes, and the solver's share."""

from __future__ import annotations

import dataclasses
import time

import numpy as np
from common import Row

import nullmotion as nm
from nullmotion import qp
from nullmotion.law import Observation
from nullmotion.qp.solver import Solver

PERIOD = 0.01


class _Clocked:
    """A solver that adds up its time and keeps what it was asked."""

    def __init__(self, solver: Solver) -> None:
        self.solver, self.seconds = solver, 0.0
        self.asked: list[tuple[qp.Problem, qp.Solution | None]] = []

    def solve(self, problem: qp.Problem, start: qp.Solution | None = None) -> qp.Solution:
        found = self.solver.solve(problem, start)
        self.seconds += found.seconds
        self.asked.append((problem, start))
        return found


def fly(samples: int) -> tuple[np.ndarray, np.ndarray, _Clocked]:
    """Return the seconds of each sample and the solver's, through the elliptic singularity."""
    array = nm.layouts.pyramid(skew=np.radians(54.73), rate_limit=1.5)
    law, hdot = nm.laws.create("receding-horizon"), np.array([-0.75, 0.0, 0.0])
    solver = _Clocked(qp.create(law.solver, iteration_limit=law.iteration_limit))
    object.__setattr__(law, "_search", _search(law, solver))
    delta, state = np.zeros(array.n), law.init(array, np.zeros(array.n))
    law.step(array, Observation(delta, hdot, 0.0, PERIOD), state)  # compiles
    total, solving = [], []
    for k in range(samples):
        seen, before = Observation(delta, hdot, k * PERIOD, PERIOD), solver.seconds
        begin = time.perf_counter()
        rates, state = law.step(array, seen, state)
        total.append(time.perf_counter() - begin)
        solving.append(solver.seconds - before)
        delta = delta + PERIOD * rates
    return np.array(total), np.array(solving), solver


def _search(law, solver):
    how = dataclasses.replace(law)._search()._replace(solver=solver)
    return lambda: how


def rows(quick: bool) -> list[Row]:
    """Measure everything."""
    total, solving, clocked = fly(60 if quick else 330)
    out = [
        Row("sample, N = 15, median", 1e3 * np.median(total), "ms", at_most=3.0),
        Row("sample, N = 15, 99th percentile", 1e3 * np.percentile(total, 99), "ms", at_most=8.0),
        Row("of it DAQP (two programs), median", 1e3 * np.median(solving), "ms"),
        Row("all but the solver, median", 1e3 * np.median(total - solving), "ms"),
    ]
    some = clocked.asked[:: 40 if quick else 15]
    for name in qp.names():
        solver = qp.create(name)
        found = [solver.solve(problem, start) for problem, start in some]
        share = np.mean([f.solved for f in found])
        out.append(
            Row(
                f"{name}: one program of 45 variables, median",
                1e6 * float(np.median([f.seconds for f in found])),
                "us",
                note=f"{share:.0%} within 1e-6 of KKT",
            )
        )
    return out


if __name__ == "__main__":
    for row in rows(quick=False):
        print(row.markdown())
