"""A smooth stand-in for the value of a course, and its gradient with respect to the knots.

Counts and extremes make the value of a plan a staircase: its gradient says nothing of the
count of samples near singularity. Here each term of the cost is smoothed by a width eps,

    count of a < b      sum_k 1 / (1 + exp(-m_k / eps)),    m = (b - a) / (|a| + |b|)
    greatest x          x* + tau log sum_k exp((x_k - x*) / tau),     tau = eps |x*|

with x* the true extreme. The value is the cost's own function of these totals. As eps
shrinks it becomes the true value, up to counts of samples that are exactly on the edge.

The totals' derivatives come from the tape: the simulation's own stages, differentiated
(`nullmotion.compile.loop_tangent`), one lane of the kernel for each knot.
"""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np

from nullmotion.compile import llvm
from nullmotion.compile.kernel import LoopKernel
from nullmotion.compile.loop_tangent import differentiated
from nullmotion.plan.rollout import Rollouts
from nullmotion.plan.segment import LEAVES
from nullmotion.plan.smooth_terms import SIGN, Margin, smoothed
from nullmotion.sim.run import schedule
from nullmotion.sim.stages import reductions

_LANES = 320  # lanes that go through all segments together: their state stays in the cache
_STEP = 1e-6  # relative, of the totals in differences of the cost's value


class SmoothValue:
    """Smoothed values of courses and their gradients.

    Args:
        rollouts: The manoeuvre, its cost and its knots.
    """

    def __init__(self, rollouts: Rollouts) -> None:
        """Differentiate and compile the manoeuvre."""
        self.rollouts = rollouts
        terms = [Margin(term, r) for term, r in reductions(rollouts.setup.metrics)]
        self._signs = np.array([SIGN.get(t.reduction, 0.0) for t in terms])
        what, seeded = smoothed(replace(rollouts.setup, metrics=tuple(terms)), terms)
        self.kernel = LoopKernel(differentiated(what, seeded), width=llvm.host().lanes)
        self._rows = schedule(rollouts.setup)

    def gradient(self, knots: np.ndarray, width: float) -> tuple[np.ndarray, np.ndarray]:
        """Return smoothed values (runs,) and their gradients (runs, depth) at courses.

        A run that is not finite has the value -inf and no gradient.
        """
        rollouts = self.rollouts
        extremes = rollouts.totals(knots)
        rate = 1.0 / (width * np.maximum(np.abs(extremes), 1e-9))
        sums, slopes = self._sums(knots, width, extremes, rate)
        sign = self._signs[:, None]
        with np.errstate(all="ignore"):
            smooth = extremes + sign * np.log(sums) / rate
            totals = np.where(sign, smooth, sums)
            moves = np.where(sign[:, None], (sign / (sums * rate))[:, None] * slopes, slopes)
            values, partials = self._value(totals)
            gradient = np.einsum("tr,tkr->rk", partials, moves)
        fine = np.isfinite(values) & np.isfinite(gradient).all(axis=1)
        return np.where(fine, values, -np.inf), np.where(fine[:, None], gradient, 0.0)

    def _value(self, totals: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the cost's value and its derivatives by the totals, by central differences."""
        cost, steps = self.rollouts.cost, self.rollouts.steps
        partials = np.empty_like(totals)
        for i, row in enumerate(totals):
            size = _STEP * np.maximum(np.abs(row), 1.0)
            above, below = totals.copy(), totals.copy()
            above[i], below[i] = row + size, row - size
            partials[i] = (cost.value(above, steps) - cost.value(below, steps)) / (2.0 * size)
        return np.asarray(cost.value(totals, steps)), partials

    def _sums(
        self, knots: np.ndarray, width: float, extremes: np.ndarray, rate: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return the terms' sums (terms, runs) and their derivatives (terms, depth, runs)."""
        runs, depth = knots.shape
        lanes = np.arange(runs * depth)
        run, knot = lanes // depth, lanes % depth
        fixed = np.concatenate([np.full((1, len(lanes)), width), extremes[:, run], rate[:, run]])
        found = np.empty((2 * len(extremes), len(lanes)))
        chunks = [slice(i, min(i + _LANES, len(lanes))) for i in range(0, len(lanes), _LANES)]

        def go(chunk: slice) -> None:
            ends = knots[run[chunk]].T
            found[:, chunk] = self._pass(ends, np.eye(depth)[knot[chunk]].T, fixed[:, chunk])

        with ThreadPoolExecutor(self.rollouts.threads or os.cpu_count()) as pool:
            list(pool.map(go, chunks))
        shaped = found.reshape(2, len(extremes), runs, depth)
        return shaped[0, :, :, 0], shaped[1].transpose(0, 2, 1)

    def _pass(self, ends: np.ndarray, seeds: np.ndarray, fixed: np.ndarray) -> np.ndarray:
        """Take lanes through all segments; return sums and tangents."""
        kernel, rollouts, lanes = self.kernel, self.rollouts, ends.shape[1]
        padded = -(-lanes // kernel.width) * kernel.width
        values = np.zeros((LEAVES + len(fixed) + 2, padded))
        values[LEAVES:-2, :lanes] = fixed
        state = np.zeros((kernel.carried, padded))
        out = np.zeros((kernel.outputs + len(kernel.flags), padded))
        length, none = rollouts.duration / rollouts.segments, np.empty(1)
        for i in range(rollouts.segments):
            j = min(i + 1, rollouts.depth - 1)
            values[2], values[3] = i * length, 1.0 / length
            values[[0, 1, -2, -1], :lanes] = ends[i], ends[j], seeds[i], seeds[j]
            k0, k1 = rollouts.edges[i], rollouts.edges[i + 1]
            kernel.run(state, values, self._rows, none, out, 0, padded, k0, k1, True)
        return out[: kernel.outputs, :lanes]
