"""Direct collocation of a step: the program that IPOPT solves.

Between n even nodes, h = t_f / (n - 1), the body's acceleration is quadratic through its value b_k
midway, the gimbal's linear (q):

    max  c - weight * integral(q^2)
    theta'_k+1 = theta'_k + h (a_k + 4 b_k + a_k+1) / 6
    theta_k+1  = theta_k + h theta'_k + h^2 (a_k + 2 b_k) / 6
    delta'_k+1 = delta'_k + h (q_k + q_k+1) / 2
    delta_k+1  = delta_k + h delta'_k + h^2 (2 q_k + q_k+1) / 6
    N theta'' + T.r = M (cm/o x g).r                                at nodes and midway
    tau_DTa - tau_off >= c S,  tau_off - tau_DTb >= c S,  tau_DTa >= 0 >= tau_DTb,  S = M g L/2
    +-(o . r) >= authority;  |delta'|, |q|, |theta'|, t_f within limits,  0 <= theta <= turn

(Elliott 2019, Eq 84 and Table 1). c may be negative: then no step keeps both spikes down. The
elastic program makes each of Table 1's limits soft by a share of its own and minimises their sum:
it tells which limit stands in the way, and by how much.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from nullmotion.rover import collocation_rows as rows
from nullmotion.rover import step_dynamics as step
from nullmotion.rover import step_model
from nullmotion.rover.collocation_rows import LIMITS, SOFT
from nullmotion.rover.step_model import StepModel
from nullmotion.rover.watch import Watch, callback, casadi

_IPOPT = {"print_level": 0, "sb": "yes", "mu_strategy": "adaptive", "tol": 1e-7, "max_iter": 250}


@dataclass(frozen=True, eq=False)
class Program:
    """A program for a number of nodes; the step's model, branch, weight and limits are parameters.

    Attributes:
        solver: CasADi's solver.
        upper: Upper bounds of the rows; the lower ones are 0.
        watch: Told of each iteration.
        held: What the solver calls but does not keep alive.
    """

    solver: Any
    upper: np.ndarray
    watch: Watch
    held: Any


@lru_cache(maxsize=8)
def program(nodes: int, elastic: bool = False) -> Program:
    """Return the program for a number of nodes; it is made once."""
    ca = casadi()
    x = ca.SX.sym("x", rows.unknowns_count(nodes, elastic))
    p = ca.SX.sym("p", step_model.SIZE + 2 + LIMITS)
    model, (branch, weight, *limits) = _parameters(p)
    found = rows.unknowns(x, nodes)
    soft = found.soft if elastic else [0.0] * len(SOFT)
    h = found.t_f / (nodes - 1)
    between = rows.between(found, h)
    every = step.State(*(ca.vertcat(*pair) for pair in zip(found.state, between, strict=True)))
    theta_ddot = ca.vertcat(found.theta_ddot, found.middle)
    equal = [rows.motion(model, every, theta_ddot), *rows.steps(found, h)]
    bounds = rows.margins(model, every, theta_ddot, found.c, branch, limits[-1], soft)
    bounds += rows.limits(found, limits, soft) if elastic else []
    q = found.state.delta_ddot
    squares = (q[:-1] ** 2 + q[:-1] * q[1:] + q[1:] ** 2) / 3
    rough = weight * ca.sum1(squares) * h
    aim = sum(soft) + 1e-3 * rough if elastic else rough - found.c
    g = ca.vertcat(*equal, *bounds)
    equations = sum(part.shape[0] for part in equal)
    upper = np.where(np.arange(g.shape[0]) < equations, 0.0, np.inf)
    watch = Watch()
    held = callback(watch, x.shape[0], g.shape[0])
    options = {"ipopt": _IPOPT, "print_time": False, "iteration_callback": held}
    solver = ca.nlpsol("step", "ipopt", {"x": x, "f": aim, "g": g, "p": p}, options)
    return Program(solver, upper, watch, held)


def trajectories(x: np.ndarray, nodes: int) -> np.ndarray:
    """Return theta, its rates, delta, its rates at nodes and midway, (6, 2 n - 1)."""
    found = rows.unknowns(x, nodes)
    between = rows.between(found, found.t_f / (nodes - 1))
    points = np.empty((6, 2 * nodes - 1))
    for part, state, theta_ddot in (
        (points[:, ::2], found.state, found.theta_ddot),
        (points[:, 1::2], between, found.middle),
    ):
        part[:2], part[2], part[3:] = state[:2], theta_ddot, state[2:]
    return points


def _parameters(p: Any) -> tuple[StepModel, list[Any]]:
    size = step_model.SIZE
    return step_model.from_numbers(p), [p[i] for i in range(size, p.shape[0])]
