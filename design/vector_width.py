"""From how many operations a step on two vectors side by side are slower than one.

Two hide the latency of small loops and of long chains (singular values: up to 1.6 times faster); in
large loops their values no longer fit the registers. Each line: the operations of a loop, and
the time of a run's step with one vector and with two (CPU time, one thread). From about 2,500
operations on, one was never slower.
"""

from __future__ import annotations

import dataclasses
import time

import numpy as np

import nullmotion as nm
from nullmotion.compile import llvm
from nullmotion.compile.kernel import LoopKernel
from nullmotion.scenario import build
from nullmotion.sim import Setup
from nullmotion.sim.batch import values
from nullmotion.sim.run import schedule
from nullmotion.sim.stages import loop

RUNS, STEPS = 64, 2000
CASES = (
    ("elliptic-singularity", "sr", ("momentum_Nms",)),
    ("elliptic-singularity", "gsr", ("sigma_min",)),
    ("elliptic-singularity", "vcbsae", None),
    ("attitude-slew", "sr", ("settling_time_s",)),
    ("attitude-slew", "pseudo-inverse", ("settling_time_s",)),
    ("attitude-slew", "sda", ("settling_time_s",)),
    ("attitude-slew", "dsea", ("settling_time_s",)),
    ("attitude-slew", "sr", None),
    ("attitude-slew", "vcbsae", ("settling_time_s",)),
    ("attitude-slew", "vcbsae", None),
    ("vscmg-startup", "vscmg-weighted", None),
)


def step_time(base: Setup, width: int, rng: np.random.Generator) -> tuple[int, float]:
    """Return the operations of a step and its time for one run [ns]."""
    shape = (RUNS, base.array.n)
    starts = base.delta + rng.uniform(-0.1, 0.1, shape)
    table, varying = values(base, {"delta": starts}, None)
    kernel = LoopKernel(loop(base, varying), width=width)
    steps, found = min(base.steps, STEPS), []
    for _ in range(5):
        state = np.zeros((kernel.carried, RUNS))
        out = np.zeros((kernel.outputs + len(kernel.flags), RUNS))
        begin = time.thread_time()
        kernel.run(state, table, schedule(base), np.empty(1), out, 0, RUNS, 0, steps, False, 1)
        found.append(time.thread_time() - begin)
    return kernel.operations, 1e9 * min(found) / RUNS / steps


def main() -> None:
    rng = np.random.default_rng(0)
    print("scenario, law                            operations  one vector  two vectors")
    for name, law, metrics in CASES:
        scenario = nm.load_scenario(name, {"law.name": law})
        base = dataclasses.replace(build.setup(scenario, metrics), stop=())
        lanes = llvm.host().lanes
        (operations, one), (_, two) = (step_time(base, w, rng) for w in (lanes, 2 * lanes))
        print(f"{name + ', ' + law:40s} {operations:10d} {one:8.1f} ns {two:9.1f} ns")


if __name__ == "__main__":
    main()
