"""Roll out many courses of null motion at once, whole or a segment at a time."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from nullmotion.compile import llvm
from nullmotion.compile.kernel import LoopKernel
from nullmotion.errors import TraceError, UnsupportedArrayError
from nullmotion.law import Law
from nullmotion.laws.follow_plan import FollowPlan, without_null_motion
from nullmotion.plan import whole
from nullmotion.plan.block import Block, checked_depth, checked_unit, finite, varying
from nullmotion.plan.cost import Cost, widest_array
from nullmotion.plan.segment import LEAVES, SegmentLaw
from nullmotion.sim.run import schedule
from nullmotion.sim.setup import Setup
from nullmotion.sim.stages import loop

_HOST = "this law or this integrator runs in Python"


class Rollouts:
    """One manoeuvre under many courses of null motion.

    A course has ``depth`` knots k_0 ... in units of k_max, at equal distances from the start
    of the run to its end; between two knots, in a segment, k is linear. One kernel serves all
    segments: a run's state carries over, so that courses with the same first knots share
    the work up to where they part.

    Args:
        setup: The manoeuvre. Its stop conditions are left out, so that all courses are
            judged over the same time; of a law that follows a plan, the base is taken.
        cost: What is judged.
        depth: Number of knots.
        k_max: Unit of the knots [rad/s].
        lag: Whether the null vector is that of the sample before.
        threads: Threads for large batches of whole courses; one for each core by default.

    Attributes:
        segments: Number of segments: depth - 1, or 1.
        edges: First step of each segment, then the number of steps.
        steps: Number of steps of the run.
        duration: Time from the first knot to the last [s].
        base: Law whose rates come first.

    Raises:
        InputError: For a depth that leaves a segment without a step.
        UnsupportedArrayError: For an array without null motion.
        TraceError: For a law that cannot be compiled.
    """

    def __init__(
        self,
        setup: Setup,
        cost: Cost,
        depth: int = 10,
        k_max: float = 0.7,
        lag: bool = False,
        threads: int | None = None,
    ) -> None:
        """Compile the manoeuvre."""
        self.steps, self.depth = setup.steps, checked_depth(depth, setup.steps)
        self.base: Law = setup.law.base_law if isinstance(setup.law, FollowPlan) else setup.law
        reason = without_null_motion(setup.array)
        if reason:
            raise UnsupportedArrayError(FollowPlan.name, reason)
        if not self.base.traceable or setup.integrator == "dop853":
            raise TraceError(f"null motion is planned for compiled runs; {_HOST}")
        self.cost, self.k_max, self.lag, self.threads = cost, checked_unit(k_max), lag, threads
        law = SegmentLaw(0.0, 0.0, 0.0, 0.0, self.base, self.k_max, lag)
        self.setup = replace(setup, law=law, stop=(), metrics=cost.terms(setup))
        self.segments = max(self.depth - 1, 1)
        self.edges = [-(-j * self.steps // self.segments) for j in range(self.segments + 1)]
        self.duration = self.steps * setup.dt
        what = loop(self.setup, varying(self.setup))
        what = replace(what, outputs=lambda s, p: s.sums, record=None)
        self.kernel = LoopKernel(what, width=llvm.host().lanes)  # more lanes: slower to compile
        self.terms = len(self.setup.metrics)
        self._widest = widest_array(self.setup)
        self._rows = schedule(self.setup)
        self._history = np.empty(1)

    def of_depth(self, depth: int) -> Rollouts:
        """Return the same manoeuvre with another number of knots."""
        setup = replace(self.setup, law=self.base)
        return Rollouts(setup, self.cost, depth, self.k_max, self.lag, self.threads)

    def block(self, lanes: int) -> Block:
        """Return memory for so many runs, which start at the setup's angles."""
        made = Block(self.kernel, self.setup.array.n, lanes)
        made.values[LEAVES:] = self.setup.delta[:, None]
        return made

    def advance(self, block: Block, segment: int, runs: int, a: Any, b: Any) -> np.ndarray:
        """Take the first ``runs`` runs of a block through a segment; return their totals so far.

        Args:
            block: Holds the state in which the segment begins (at segment 0: the start
                angles) and then that in which it ends.
            segment: Which one, from 0.
            runs: Number of runs.
            a: k of each run at the segment's start, in units of k_max.
            b: And at its end.
        """
        length, values = self.duration / self.segments, block.values
        values[0, :runs], values[1, :runs] = a, b
        values[2], values[3] = segment * length, 1.0 / length
        lanes = -(-runs // self.kernel.width) * self.kernel.width
        self.kernel.run(
            block.state,
            values,
            self._rows,
            self._history,
            block.out,
            0,
            lanes,
            self.edges[segment],
            self.edges[segment + 1],
            True,
        )
        return block.out[: self.terms, :runs]

    def values(self, knots: Any, delta: np.ndarray | None = None) -> np.ndarray:
        """Return the value of whole courses, (runs,); -inf where a run is not finite.

        Args:
            knots: In units of k_max, (runs, depth), or (depth,) for all runs alike.
            delta: Start angles [rad], (runs, n); the setup's if None.
        """
        return self.judged(self.totals(knots, delta))

    def judged(self, totals: np.ndarray) -> np.ndarray:
        """Return the value of whole runs by their totals; -inf where they are not finite."""
        with np.errstate(all="ignore"):
            return finite(self.cost.value(totals, self.steps))

    def bounds(self, totals: np.ndarray, done: int) -> np.ndarray:
        """Return what no completion of runs exceeds whose first ``done`` samples are known."""
        with np.errstate(all="ignore"):
            return finite(self.cost.bound(totals, done, self.steps, self._widest))

    def totals(self, knots: Any, delta: np.ndarray | None = None) -> np.ndarray:
        """Return the totals of the cost's terms over whole courses, (terms, runs)."""
        return whole.totals(self, knots, delta)
