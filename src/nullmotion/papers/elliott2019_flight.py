"""A compiled loop that flies the trajectories of Section 4.4 of Elliott 2019.

At every step the command points from the array's momentum to the next waypoint, with a random
length that is the same for all laws; a waypoint is reached when one step is enough, which is
then cut to end there. Gimbals move by explicit Euler steps, without a rate limit.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from nullmotion import linalg, ops, tree
from nullmotion.array.model import CmgArray
from nullmotion.compile import llvm
from nullmotion.compile.kernel import LoopKernel
from nullmotion.compile.loop import Loop, Stage
from nullmotion.law import Law, Observation
from nullmotion.papers.elliott2019_courses import DT, Course

_LEGS = 3.0


class _Given(NamedTuple):
    delta: Any
    waypoints: Any
    law: Law


class _State(NamedTuple):
    delta: Any
    leg: Any
    law: Any


class Flown(NamedTuple):
    """What a trajectory leaves: gimbal angles at every step, (steps, n), and whether it arrived."""

    delta: np.ndarray
    arrived: bool


class Flyer:
    """A compiled loop that flies trajectories under variants of one law, one variant a lane."""

    def __init__(self, array: CmgArray, laws: Sequence[Law], delta: np.ndarray) -> None:
        """Compile the loop; the laws differ in numbers only."""
        self.array, self._laws = array, laws
        example = _Given(np.asarray(delta, float), np.zeros((3, 3)), laws[0])
        fixed = len(tree.flatten(example[:2]))
        leaves = np.array([tree.flatten(law) for law in laws], float).reshape(len(laws), -1)
        differ = (leaves != leaves[0]).any(axis=0)
        self._leaves = leaves[:, differ].T
        width = min(llvm.host().lanes, 1 << (len(laws) - 1).bit_length())
        loop = Loop(
            start=lambda p: _State(p.delta, 0.0, p.law.init(array, p.delta)),
            stages=(Stage(self._step),),
            outputs=lambda s, p: (s.leg, s.delta),
            parameters=example,
            varying=(True,) * fixed + tuple(differ.tolist()),
            row=1,
            active=lambda s: ops.less(s.leg, _LEGS),
            record=lambda s: (s.delta, s.leg),
        )
        self._delta = np.asarray(delta, float)
        self.kernel = LoopKernel(loop, recording=True, width=width)

    def _step(self, k: Any, row: Any, s: _State, p: _Given) -> _State:
        first, second, last = p.waypoints
        later = ops.where(ops.less(s.leg, 1.5), second, last)
        way = ops.where(ops.less(s.leg, 0.5), first, later) - self.array.momentum(s.delta)
        left, length = linalg.norm(way), row[0]
        near = ops.less_equal(left, length * DT)
        factor = ops.where(near, 1.0 / DT, length / ops.where(near, 1.0, left))
        observation = Observation(delta=s.delta, hdot=factor * way, t=k * DT, period=DT)
        rates, law = p.law.step(self.array, observation, s.law)
        going = ops.less(s.leg, _LEGS)  # others of the same vector may still be
        return _State(
            ops.where(going, s.delta + DT * rates, s.delta),
            s.leg + ops.where(ops.logical_and(going, near), 1.0, 0.0),
            law,
        )

    def fly(self, course: Course) -> list[Flown]:
        """Fly one trajectory under every law."""
        kernel, steps = self.kernel, len(course.lengths)
        lanes = -(-len(self._laws) // kernel.width) * kernel.width
        given = np.concatenate([self._delta, course.waypoints.ravel()])
        own = np.pad(self._leaves, ((0, 0), (0, lanes - len(self._laws))), mode="edge")
        values = np.concatenate([np.repeat(given[:, None], lanes, axis=1), own])
        values = np.ascontiguousarray(values)
        state = np.zeros((kernel.carried, lanes))
        out = np.zeros((kernel.outputs + len(kernel.flags), lanes))
        history = np.full((steps, kernel.records, lanes), np.nan)
        rows = np.ascontiguousarray(course.lengths[:, None])
        kernel.run(state, values, rows, history, out, 0, lanes, 0, steps, True)
        flown = []
        for lane in range(len(self._laws)):
            delta, leg = history[:, :-1, lane], history[:, -1, lane]
            delta = np.concatenate([delta[leg < _LEGS], out[None, 1 : kernel.outputs, lane]])
            flown.append(Flown(delta, bool(out[0, lane] >= _LEGS)))
        return flown
