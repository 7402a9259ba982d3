"""Improve plans, compare them and find new ones; the compiled parts of one shape of array."""

from __future__ import annotations

import threading
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from nullmotion import qp
from nullmotion.array.model import CmgArray
from nullmotion.compile.function import CompiledFunction, compile_function
from nullmotion.lookahead import knots, program
from nullmotion.lookahead.layout import Layout
from nullmotion.lookahead.path import Envelope, Path

# null motion of the seeds of one side, per unit of momentum: along the null vector, up the slope
_SIDE = ((0.4, 0.0), (1.2, 0.0), (0.1, 1.0), (0.3, 0.4))
_SEEDS = np.array([*_SIDE, *((-push, climb) for push, climb in _SIDE)])
_PARTS = 2  # steps of a seed from knot to knot
_MISSED = 200.0  # price of momentum that a plan does not have where it should
_FASTEST = 1e3  # rad/s; stands for no rate limit

_planners = threading.local()  # buffers serve one thread


class Weights(NamedTuple):
    """Prices of a plan: w, rho and sigma_ref of `lookahead.program`."""

    effort: float
    price: float
    reference: float


class Task(NamedTuple):
    """One sample's problem: where from, along which path, within which moves [rad], (n, N)."""

    start: np.ndarray
    path: Path
    limit: np.ndarray
    weights: Weights


@lru_cache
def _compiled(n: int, m: int) -> tuple[CompiledFunction, CompiledFunction, CompiledFunction]:
    angles, momentum, frame = np.zeros(n), np.zeros(m), np.zeros((n, m))
    null, free = np.zeros((n, n - m)), np.zeros(n - m)
    links = program.Links(
        (angles, angles, angles), (null, null), free, 0.0, (0.0, 0.0), 0.0, angles, 0.0, 0.0
    )
    return (
        compile_function(knots.knot, angles, momentum, frame, frame),
        compile_function(knots.moved, angles, momentum, 0.0, 0.0, frame, frame),
        compile_function(program.node, links),
    )


def planner(array: CmgArray, count: int) -> Planner:
    """Return this thread's planner for an array and a number of knots."""
    known: dict[tuple[int, int, int], Planner] = _planners.__dict__.setdefault("known", {})
    shape = (array.n, array.m, count)
    if shape not in known:
        known[shape] = Planner(*shape)
    known[shape].take(array)
    return known[shape]


class Planner:
    """Compiled functions with their buffers, and what they need to know of the array.

    Attributes:
        mean: Mean momentum [N m s].
        rate_limit: Rate limits, finite [rad/s], (n,).
        envelope: What the array can hold.
    """

    def __init__(self, n: int, m: int, count: int) -> None:
        """Make the buffers."""
        knot, moved, node = _compiled(n, m)
        self._knots, self._scored = knot.bound(count), knot.bound(count * len(_SEEDS))
        self._roll, self._last = moved.bound(len(_SEEDS)), moved.bound(1)
        self._node = node.bound(count)
        self._layout = Layout(n, n - m, self._node.numbered())
        self._array: CmgArray | None = None
        self.mean, self.rate_limit = 1.0, np.full(n, _FASTEST)

    def take(self, array: CmgArray) -> None:
        """Serve this array from now on."""
        if array is self._array:
            return
        self._array, self.mean = array, float(array.mean_momentum)
        zero = np.zeros(array.n)
        self._spin = array.rotor_momenta(zero) / self.mean
        self._torque = array.unit_jacobian(zero).T
        for bound in (self._knots, self._scored, self._roll, self._last):
            bound.arguments[-2][...] = self._spin[:, :, None]
            bound.arguments[-1][...] = self._torque[:, :, None]
        self.rate_limit = np.minimum(array.rate_limit, _FASTEST)
        self.envelope = Envelope(array)

    def momentum(self, delta: np.ndarray) -> np.ndarray:
        """Return the momentum of the gimbals over the mean momentum, without bias, (m,)."""
        found: np.ndarray = np.cos(delta) @ self._spin + np.sin(delta) @ self._torque
        return found

    def linearised(self, points: np.ndarray, task: Task) -> knots.Knot:
        """Return the knots of a plan (N, n), each value with the knot as last axis."""
        delta, target, *_ = self._knots.arguments
        delta[...] = points.T
        target[...] = task.path.target.T
        found: knots.Knot = self._knots()
        return found

    def improved(
        self, found: knots.Knot, task: Task, solver: qp.Solver, start: qp.Solution | None
    ) -> tuple[np.ndarray, qp.Solution]:
        """Return the plan (N, n) that solves the program at linearised knots, and its solution.

        Without a solution the plan is the knots at their momenta, without null motion.
        """
        links: program.Links = self._node.arguments[0]
        point, before, after = links.point
        point[...], before[:, 0], before[:, 1:] = found.point, task.start, found.point[:, :-1]
        after[:, :-1] = found.point[:, 1:]
        step, limit, weights = task.path.step, task.limit, task.weights
        unit = np.minimum(1.0, np.sqrt(step / step[1]))  # of lambda: a short step is stiff
        null = found.null * unit
        links.null[0][...], links.null[1][:, :, 1:] = null, null[:, :, :-1]
        links.slope[...], links.ahead[...] = found.slope * unit, found.ahead
        links.weight[0][...], links.weight[1][:-1] = (
            weights.effort / step,
            weights.effort / step[1:],
        )
        links.step[...], links.limit[...] = step, limit
        links.price[...], links.reference[...] = weights.price, weights.reference
        self._node()
        solution = solver.solve(self._layout.problem(self._node.values), start)
        plan = found.point.T.copy()
        if solution.solved:
            shape = (self._layout.count, self._layout.free)
            motion = solution.x[: shape[0] * shape[1]].reshape(shape)
            plan += np.einsum("ifk,kf->ki", null, motion)
        return plan, solution

    def seeds(self, task: Task) -> np.ndarray:
        """Return plans (8, N, n) with null motion to either side, the first half to one."""
        delta, target, push, climb, *_ = self._roll.arguments
        delta[...] = task.start[:, None]
        plans = np.empty((len(_SEEDS), len(task.path.step), len(task.start)))
        last = self.momentum(task.start)
        for k, (wanted, step) in enumerate(zip(task.path.target, task.path.step, strict=True)):
            push[...], climb[...] = (step / _PARTS * _SEEDS).T
            for part in range(1, _PARTS + 1):
                target[...] = (last + part / _PARTS * (wanted - last))[:, None]
                delta[...] = self._roll()
            plans[:, k], last = delta.T, wanted
        return plans

    def costs(self, plans: np.ndarray, task: Task) -> np.ndarray:
        """Return the costs of plans (S, N, n), S up to 8."""
        count, (effort, price, reference) = len(plans), task.weights
        delta, target, *_ = self._scored.arguments
        lanes = count * len(task.path.step)
        delta[:, :lanes] = plans.reshape(lanes, -1).T
        target[:, :lanes] = np.tile(task.path.target, (count, 1)).T
        found = self._scored()
        level = found.level[:lanes].reshape(count, -1)
        step = task.path.step
        lacking = np.maximum(reference - level, 0.0)
        moves = plans - np.concatenate([np.broadcast_to(task.start, plans[:, :1].shape),
                                        plans[:, :-1]], axis=1)  # fmt: skip
        late = np.maximum((np.abs(moves) / task.limit.T).max(axis=2) - 1.0, 0.0)
        cost = 0.5 * effort * ((moves * moves).sum(axis=2) / step).sum(axis=1)
        cost += 0.5 * price * (lacking * lacking) @ step + program.LATE * late @ step
        cost += _MISSED * found.miss[:lanes].reshape(count, -1) @ step
        return cost

    def exact(self, delta: np.ndarray, target: np.ndarray) -> np.ndarray:
        """Return gimbal angles near ``delta`` that have the momentum ``target``."""
        place, wanted, *_ = self._last.arguments
        place[:, 0], wanted[:, 0] = delta, target
        found: np.ndarray = self._last()[:, 0].copy()
        return found
