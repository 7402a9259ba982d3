"""Solves of the collocation program: bounds, guesses and what comes back."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from nullmotion.rover import collocation
from nullmotion.rover.collocation_rows import SOFT
from nullmotion.rover.interrupt import interruptible
from nullmotion.rover.settings import Settings
from nullmotion.rover.step_model import StepModel
from nullmotion.rover.watch import Progress

_CLOSED = 1e-6  # rows that miss their bounds by less hold
Tick = Callable[[int], None]


class Task(NamedTuple):
    """A step to be planned.

    Attributes:
        model: Its constants.
        turn: Angle of the whole step [rad].
        rate: Limit of the gimbal rate [rad/s].
        settings: Limits and how to solve.
        branch: Sign of o . r.
    """

    model: StepModel
    turn: float
    rate: float
    settings: Settings
    branch: int

    @property
    def limits(self) -> tuple[float, ...]:
        """Limits in the order of `SOFT`."""
        s = self.settings
        return self.rate, s.acceleration, s.body_rate, s.longest, s.authority


class Solution(NamedTuple):
    """What a solve came to.

    Attributes:
        x: Trajectories theta, theta', theta'', delta, delta', delta'' at the nodes and midway
            between them, (6, 2 n - 1).
        t_f: Time of the step [s].
        c: Least margin over S.
        soft: Shares by which limits are passed (elastic program only), (7,).
        closed: Whether all rows hold.
    """

    x: np.ndarray
    t_f: float
    c: float
    soft: np.ndarray
    closed: bool


def solve(task: Task, start: Solution, elastic: bool = False, tick: Tick | None = None) -> Solution:
    """Solve from a start with as many nodes as the start has."""
    nodes = start.x.shape[1] // 2 + 1
    program = collocation.program(nodes, elastic)
    lower, upper = _bounds(task, nodes, elastic)
    parameters = [*task.model.numbers, task.branch, task.settings.regularisation, *task.limits]
    rest = [start.t_f, start.c, *np.zeros(len(SOFT) * elastic)]
    first = np.concatenate([start.x[:, ::2].ravel(), start.x[2, 1::2], rest])
    bounds = {"lbx": lower, "ubx": upper, "lbg": 0.0, "ubg": program.upper}
    with interruptible(None) as look:
        program.watch.start(_both(look, tick))
        found = program.solver(x0=first, p=parameters, **bounds)
        program.watch.finish()
    row = np.asarray(found["x"])[:, 0]
    rows = np.asarray(found["g"])[:, 0]
    miss = np.maximum(-rows, rows - program.upper).max()
    t_f, c, *soft = row[7 * nodes - 1 :].tolist()
    x = collocation.trajectories(row, nodes)
    return Solution(x, t_f, c, np.array(soft), bool(miss < _CLOSED))


def _both(look: Progress | None, tick: Tick | None) -> Tick:
    """Return what an iteration does: look for Ctrl-C, then tell the count."""

    def iterated(count: int) -> None:
        if look is not None:
            look(0.0)
        if tick is not None:
            tick(count)

    return iterated


def guess(task: Task, nodes: int, duration: float) -> Solution:
    """Return a versine of the body with the gimbal where it drives most, at rest."""
    points = 2 * nodes - 1
    s = np.pi * np.linspace(0.0, 1.0, points)
    size = task.turn / 2
    rate = np.pi / duration
    drive = task.branch * np.array([task.model.o0[1], -task.model.s0[1]])
    delta = np.full(points, np.arctan2(drive[1], drive[0]))
    still = np.zeros(points)
    body = [size * (1 - np.cos(s)), size * rate * np.sin(s), size * rate**2 * np.cos(s)]
    return Solution(np.array([*body, delta, still, still]), duration, 0.1, np.zeros(0), False)


def resampled(solution: Solution, nodes: int) -> Solution:
    """Return a solution on another number of nodes, as a start."""
    old = np.linspace(0.0, 1.0, solution.x.shape[1])
    new = np.linspace(0.0, 1.0, 2 * nodes - 1)
    return solution._replace(x=np.array([np.interp(new, old, row) for row in solution.x]))


def _bounds(task: Task, nodes: int, elastic: bool) -> tuple[np.ndarray, np.ndarray]:
    """Return lower and upper bounds of the unknowns."""
    rate, acceleration, body_rate, longest, _ = task.limits
    free = np.inf
    ends = [free] * 5 if elastic else [body_rate, free, free, rate, acceleration]
    lower = np.repeat([0.0, *(-v for v in ends)], nodes).reshape(6, nodes)
    upper = np.repeat([task.turn, *ends], nodes).reshape(6, nodes)
    upper[0, 0], lower[0, -1] = 0.0, task.turn
    for k in (0, -1):
        lower[1, k] = upper[1, k] = 0.0
    soft, middle = np.zeros(len(SOFT) * elastic), np.full(nodes - 1, free)
    low = [task.settings.shortest, 0.0 if elastic else -free]
    high = [free, 0.0] if elastic else [longest, free]
    return np.r_[lower.ravel(), -middle, low, soft], np.r_[upper.ravel(), middle, high, soft + free]
