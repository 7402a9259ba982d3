"""Batched closed loops against C, Basilisk, Numba and NumPy; threads; ratios in one run."""

from __future__ import annotations

import statistics
import sys
import time
from pathlib import Path

import numpy as np
from common import Row

sys.path.insert(0, str(Path(__file__).parent / "closed_loop"))

TARGETS = {"sr": (0.85, 500.0), "sr+gradient": (0.85, 500.0), "svd": (0.8, 150.0)}


def closed_loop(quick: bool) -> tuple[list[Row], str]:
    """Return ratios and the full table of the closed-loop workload."""
    import closed_loop as bench
    import workload

    laws = list(workload.LAWS)
    found = bench.entries()
    steps, count = (100, 4) if quick else (1000, 12)
    bench.verify(found, laws, steps, count)
    bench.measure(found, laws, 2 if quick else 15)
    by_name = {entry.name: entry for entry in found if entry.run}
    ours = by_name["nullmotion"]
    rows = []
    for law, (share, factor) in TARGETS.items():
        if bench.YARDSTICK in by_name:
            rows.append(
                Row(
                    f"{law}: nullmotion / hand-written SIMD C",
                    bench.ratio(ours, by_name[bench.YARDSTICK], law),
                    at_least=share,
                )
            )
        if "Basilisk" in by_name:
            note = (
                "richer model: torque-driven VSCMGs with mass and inertia, messages between modules"
            )
            rows.append(
                Row(
                    f"{law}: nullmotion / Basilisk",
                    bench.ratio(ours, by_name["Basilisk"], law),
                    at_least=factor,
                    note=note,
                )
            )
        if bench.YARDSTICK in by_name and "C, scalar build" in by_name:
            scalar = bench.ratio(by_name[bench.YARDSTICK], by_name["C, scalar build"], law)
            rows.append(Row(f"{law}: SIMD C / its own scalar build", scalar, at_least=5.0))
    return rows, bench.table(found, laws)


def threads(quick: bool) -> list[Row]:
    """Wall time of one batch on one thread and on two, side by side."""
    import nullmotion as nm
    from nullmotion.sim import Setup, run_batch

    rng = np.random.default_rng(3)
    runs = 2_000 if quick else 40_000
    setup = Setup(
        nm.layouts.pyramid(rate_limit=np.pi),
        nm.laws.create("sr"),
        np.zeros(4),
        np.ones(3),
        steps=2000,
    )
    delta, hdot = rng.uniform(-1, 1, (runs, 4)), rng.normal(size=(runs, 3))
    ratios, rates = [], []
    run_batch(setup, delta=delta[:64], hdot=hdot[:64])
    for _ in range(2 if quick else 7):
        walls = []
        for count in (1, 2):
            begin = time.perf_counter()
            run_batch(setup, delta=delta, hdot=hdot, threads=count)
            walls.append(time.perf_counter() - begin)
        ratios.append(walls[0] / walls[1])
        rates.append(runs * setup.steps / walls[0] / 1e6)
    rate = statistics.median(rates)
    return [
        Row(
            "two threads / one (momentum-rate batch, sr)",
            statistics.median(ratios),
            at_least=1.65,
            note=f"one thread: {rate:.0f} million steps/s",
        )
    ]
