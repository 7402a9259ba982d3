"""Waiting times: compiling a law, one call of a prepared law, the command line from cold."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import timeit
from pathlib import Path

import numpy as np
from common import LAWS, Row, median_time

import nullmotion as nm
from nullmotion.compile import llvm
from nullmotion.compile.kernel import LoopKernel
from nullmotion.sim import Setup
from nullmotion.sim.stages import loop


def compiling(law: str, rounds: int) -> float:
    """Seconds to trace a law in its batch loop on four CMGs and make machine code of it."""
    setup = Setup(
        nm.layouts.pyramid(rate_limit=np.pi), nm.laws.create(law), np.zeros(4), np.ones(3)
    )
    lanes = llvm.host().lanes

    def once() -> None:
        llvm.machine.cache_clear()
        LoopKernel(loop(setup, varying(setup)), width=lanes)

    once()
    return median_time(once, rounds)


def varying(setup: Setup) -> tuple[bool, ...]:
    """Mark start angles and command as different in each run."""
    from nullmotion import tree
    from nullmotion.sim.stages import parameters

    own = parameters(setup)
    first = len(tree.flatten(own[: own._fields.index("delta")]))
    last = len(tree.flatten(own[: own._fields.index("hdot") + 1]))
    return tuple(first <= i < last for i in range(len(tree.flatten(own))))


def calling(law: str, repeats: int) -> float:
    """Microseconds of one prepared call from Python."""
    prepared = nm.prepare(nm.laws.create(law), nm.layouts.pyramid(rate_limit=np.pi))
    delta, hdot = np.array([0.1, 0.2, 0.3, 0.4]), np.array([1.0, 0.2, 0.1])
    times = timeit.repeat(lambda: prepared(delta, hdot, 0.1), number=2000, repeat=repeats)
    return float(np.median(times)) / 2000 * 1e6


def command(arguments: list[str], rounds: int) -> float:
    """Seconds of a fresh process of the command line."""
    with tempfile.TemporaryDirectory() as folder:
        call = [sys.executable, "-m", "nullmotion", *arguments]
        quiet = {
            "stdout": subprocess.DEVNULL,
            "check": True,
            "cwd": folder,
            "env": dict(os.environ),
        }
        subprocess.run(call, **quiet)  # warms the file cache only
        return median_time(lambda: subprocess.run(call, **quiet), rounds)


def rows(quick: bool) -> list[Row]:
    """Measure everything."""
    laws = LAWS[:1] + LAWS[-1:] if quick else LAWS
    rounds = 2 if quick else 7
    out = [
        Row(f"compile {law}, four CMGs", compiling(law, rounds), "s", at_most=0.6) for law in laws
    ]
    out += [Row(f"prepared call of {law}", calling(law, rounds), "us", at_most=3.0) for law in laws]
    scenario = str(Path(__file__).parent / "thousand_steps.toml")
    out.append(Row("nullmotion --help, cold", command(["--help"], rounds), "s", at_most=0.5))
    out.append(
        Row(
            "nullmotion run, 1000 steps, cold, files on disk",
            command(["run", scenario, "--out", "r"], rounds),
            "s",
            at_most=3.0,
        )
    )
    return out
