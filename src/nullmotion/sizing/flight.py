"""Fly many slews of one kind through the closed loop: one kernel, everything else by run.

The body is turned, not the axis: in a body frame B' in which the slew is about x, all runs
follow the same reference, whose table the kernel's runs share; their arrays and inertias
differ. The array's torque axes turn along, so that a law sees what it sees in B.
"""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np

from nullmotion import tree
from nullmotion.array.model import CmgArray
from nullmotion.compile import llvm
from nullmotion.compile.kernel import LoopKernel
from nullmotion.law import Law
from nullmotion.sim.run import schedule
from nullmotion.sim.stages import loop, passes
from nullmotion.sim.state import parameters
from nullmotion.sizing.one_flight import marked, setup
from nullmotion.sizing.profile import RateProfile
from nullmotion.sizing.requirement import Requirement

_BLOCK = 32  # vectors in a block of runs


class Flights:
    """Slews of a requirement with one law and arrays of as many CMGs as a given one.

    Args:
        requirement: What is flown.
        array: An array that the law steers.
        law: The law.
        substeps: Integration steps in a period of the law.

    Attributes:
        flown: Number of flights so far.
    """

    def __init__(
        self, requirement: Requirement, array: CmgArray, law: Law, substeps: int = 1
    ) -> None:
        """Compile the loop."""
        self.requirement, self.flown = requirement, 0
        self.setup = setup(requirement, array, law, substeps)
        self.times = np.arange(0, self.setup.steps, substeps) * self.setup.dt
        varying = tuple(bool(np.isnan(v)) for v in tree.flatten(marked(parameters(self.setup))))
        what = replace(loop(self.setup, varying), outputs=lambda s, p: s.sums, record=None)
        self.kernel = LoopKernel(what, width=llvm.host().lanes)

    def fly(
        self, profile: RateProfile, C: np.ndarray, columns: tuple[np.ndarray, ...]
    ) -> np.ndarray:
        """Return when each run has settled [s], (runs,); infinite if it has not.

        Args:
            profile: Rate about each axis.
            C: Rotations from B to B', (runs, 3, 3).
            columns: Gimbal axes and spin axes in B (runs, n, 3), h0 [N m s] and rate limit
                [rad/s] of each CMG (runs,), start angles [rad] (runs, n).
        """
        gimbal, spin, h0, rate, delta = columns
        runs, n = delta.shape
        J, turned = self.requirement.inertia, C.transpose(0, 2, 1)
        own = [gimbal @ turned, spin @ turned, _each(h0, n), _each(rate, n), turned, delta]
        own.append(C @ J @ turned)
        if self.setup.disturbance is not None:
            own.append(C @ self.setup.disturbance.constant)
        table = np.concatenate([part.reshape(runs, -1) for part in own], axis=1).T
        rows = schedule(replace(self.setup, reference=profile.reference(self.times)))
        self.flown += runs
        late: np.ndarray = self._run(table, rows)
        end = self.setup.steps * self.setup.dt
        return np.where(np.isfinite(late) & (late <= end), late, np.inf)

    def _run(self, table: np.ndarray, rows: np.ndarray) -> np.ndarray:
        """Return the metric of all runs, blocks of them over threads."""
        kernel, runs = self.kernel, table.shape[1]
        padded = -(-runs // kernel.width) * kernel.width
        values = np.ascontiguousarray(np.pad(table, ((0, 0), (0, padded - runs)), mode="edge"))
        out, none = np.zeros((kernel.outputs + len(kernel.flags), padded)), np.empty(1)
        total, lanes = passes(self.setup, False), _BLOCK * kernel.width

        def block(start: int) -> None:
            count = min(lanes, padded - start)
            state = np.zeros((kernel.carried, count))
            kernel.run(state, values, rows, none, out, start, count, 0, total, True)

        with ThreadPoolExecutor(os.cpu_count() or 1) as pool:
            try:
                list(pool.map(block, range(0, padded, lanes)))
            except BaseException:  # Ctrl-C does not wait for the other blocks
                pool.shutdown(wait=False, cancel_futures=True)
                raise
        return out[0, :runs]


def _each(values: np.ndarray, n: int) -> np.ndarray:
    return np.repeat(values[:, None], n, axis=1)
