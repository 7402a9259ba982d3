"""Startup of variable-speed CMGs: one run of 70,000 steps, and a thousand at once."""

from __future__ import annotations

import os
import time
from dataclasses import replace

import numpy as np
from common import Row, median_time

import nullmotion as nm
from nullmotion.compile.kernel import LoopKernel
from nullmotion.scenario import build
from nullmotion.sim import batch
from nullmotion.sim.run import schedule
from nullmotion.sim.setup import Setup
from nullmotion.sim.stages import loop
from nullmotion.spacecraft import Spacecraft

SECONDS = 700.0


def single(setup: Setup, rounds: int) -> float:
    """Return the seconds of one compiled run with its metrics, one core."""
    kernel = LoopKernel(loop(setup), recording=False, width=1, level=2)
    rows, none, steps = schedule(setup), np.zeros((0, 1)), setup.steps + 1

    def run() -> None:
        state = np.zeros((kernel.carried, 1))
        out = np.zeros((kernel.outputs + len(kernel.flags), 1))
        kernel.run(state, none, rows, np.empty(1), out, 0, 1, 0, steps, True, 1)

    run()
    return median_time(run, rounds)


def together(base: Setup, setups: list[Setup]) -> float:
    """Return the seconds of many compiled runs on all cores."""
    table, varying = batch.values(base, {}, setups)
    job = batch._Job(LoopKernel(loop(base, varying)), base, table, 0)
    begin = time.perf_counter()
    batch._spread(job, len(setups), os.cpu_count() or 1, None)
    return time.perf_counter() - begin


def rows(quick: bool) -> list[Row]:
    """Measure both drives."""
    found = []
    for drive in ("rate", "torque"):
        changes = {"simulation.duration_s": 20.0 if quick else SECONDS, "vscmg.drive": drive}
        scenario = nm.load_scenario("vscmg-startup", values=changes)
        setup = build.setup(scenario)
        one = single(setup, 3 if quick else 9)
        runs = 32 if quick else 1000
        spread = np.random.default_rng(0).uniform(0.9, 1.1, (runs, 3))
        inertia = np.array(scenario.spacecraft.inertia_kg_m2) * spread
        q = setup.spacecraft.q_BN
        bodies = [Spacecraft(np.diag(moments), q_BN=q) for moments in inertia]
        each = together(setup, [replace(setup, spacecraft=body) for body in bodies]) / runs
        begin = time.perf_counter()
        nm.simulate_batch(scenario, inertia_kg_m2=inertia)
        whole = (time.perf_counter() - begin) / runs
        name = f"startup, {setup.steps:,} steps, {drive}-driven"
        found += [
            Row(f"{name}: one run, one core, compiled before", one, "s", at_most=1.0),
            Row(f"{name}: {runs} compiled runs against it", one / each, "times", at_least=10.0),
            Row(f"{name}: the same with set-up and compilation", one / whole, "times"),
        ]
    return found
