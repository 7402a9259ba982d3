"""Closed-loop speed: every implementation of one workload, in interleaved rounds in one process.

    python closed_loop.py [--quick] [--json FILE] [--rounds N] [--laws sr svd]

First every implementation must end where numpy_loop ends (TOLERANCE, on runs that stay clear of
singular states); then each is timed once a round, in CPU seconds of this one thread, and ratios
are taken within a round, so that a machine that slows down slows all of them. Medians are printed.
"""

from __future__ import annotations

import argparse
import json
import platform
import statistics
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parent))

import c_reference
import nullmotion_loop
import numpy_loop
import workload
from workload import Array, Batch

TOLERANCE = 1e-9  # largest difference of any state component after the last step
CLEAR_OF_SINGULAR = 0.2  # least sigma_min(A) / h0 of the runs compared
YARDSTICK = "C, SIMD"
Run = Callable[[str, Array, Array, Array, int], Batch]


@dataclass
class Entry:
    """One implementation: how to call it and how much work a round gives it."""

    name: str
    run: Run | None
    runs: int
    steps: int
    note: str = ""
    compared: bool = True
    rates: dict[str, list[float]] = field(default_factory=dict)  # law -> million steps/s per round


def c_entry(name: str, width: int, runs: int, extra: tuple[str, ...] = ()) -> Entry:
    """The hand-written C at one width, compiled now."""
    try:
        for law in workload.LAWS:
            c_reference.library(width, c_reference.TILE[width][law], extra)
    except c_reference.NoCompilerError as error:
        return Entry(name, None, 0, 0, f"not built: {error}"[:100])

    def run(law: str, q: Array, omega: Array, delta: Array, steps: int) -> Batch:
        return c_reference.run(law, q, omega, delta, steps, width, extra)

    return Entry(name, run, runs, 1000)


def nullmotion_entry() -> Entry:
    """The project's own kernel, once nullmotion_loop.build is filled."""
    try:
        loops = {law: nullmotion_loop.build(law) for law in workload.LAWS}
    except (NotImplementedError, ImportError) as error:
        return Entry("nullmotion", None, 0, 0, f"not built: {error}")

    def run(law: str, q: Array, omega: Array, delta: Array, steps: int) -> Batch:
        return loops[law](q, omega, delta, steps)

    return Entry("nullmotion", run, 960, 1000)


def numba_entry() -> Entry:
    """Numba, if installed."""
    try:
        import numba_loop
    except ImportError:
        return Entry("Numba, batch", None, 0, 0, "not installed")
    for law in workload.LAWS:  # compiled before nullmotion sets LLVM's options for this process
        numba_loop.run(law, *workload.initial_states(1), 1)
    return Entry("Numba, batch", numba_loop.run, 24, 1000)


def basilisk_entry() -> Entry:
    """Basilisk, if installed; a richer model, so its states are not compared."""
    try:
        import basilisk_loop
    except ImportError:
        return Entry("Basilisk", None, 0, 0, "not installed", compared=False)
    basilisk_loop.check()
    loop = basilisk_loop.Loop()

    def run(law: str, q: Array, omega: Array, delta: Array, steps: int) -> Batch:
        loop.advance(steps)
        return Batch(q, omega, delta)

    note = "four VSCMGs, its own steering law; richer model, order of magnitude only"
    return Entry("Basilisk", run, 1, 500, note, compared=False)


def entries() -> list[Entry]:
    """All implementations, the yardstick first."""
    width = c_reference.native_width()
    found = [c_entry(YARDSTICK, width, 960)]
    if width == 8:
        found.append(c_entry("C, SIMD, IEEE sqrt and /", width, 960, c_reference.EXACT))
        found.append(c_entry("C, AVX2", 4, 480))
    numba = numba_entry()
    found += [c_entry("C, scalar build", 1, 96), nullmotion_entry(), numba]
    found += [Entry("NumPy, one run", numpy_loop.run, 1, 100), basilisk_entry()]
    return found


def clear_runs(law: str, steps: int, count: int) -> tuple[Batch, Array]:
    """Initial states of runs that stay clear of singular states, and where NumPy ends."""
    start = workload.initial_states(count)
    end, nearest = numpy_loop.watch(law, *start, steps)
    keep = nearest > CLEAR_OF_SINGULAR
    return Batch(*(x[:, keep] for x in start)), np.concatenate([x[:, keep] for x in end])


def verify(found: list[Entry], laws: list[str], steps: int, count: int) -> dict[str, float]:
    """Largest difference from NumPy's final state; refuses to go on above TOLERANCE."""
    worst: dict[str, float] = {}
    for law in laws:
        start, truth = clear_runs(law, steps, count)
        for entry in (e for e in found if e.run and e.compared):
            end = np.concatenate(entry.run(law, *start, steps))
            worst[entry.name] = max(worst.get(entry.name, 0.0), float(np.abs(end - truth).max()))
    wrong = {name: value for name, value in worst.items() if not value <= TOLERANCE}
    if wrong:
        raise SystemExit(f"final states differ from NumPy's by more than {TOLERANCE}: {wrong}")
    return worst


def time_once(entry: Entry, law: str, start: Batch) -> float:
    """Million closed-loop steps a second of one call."""
    assert entry.run is not None
    begin = time.process_time()
    entry.run(law, *start, entry.steps)
    return entry.runs * entry.steps / (time.process_time() - begin) / 1e6


def measure(found: list[Entry], laws: list[str], rounds: int) -> None:
    """Interleaved rounds; the first call of each is thrown away."""
    ready = [e for e in found if e.run]
    starts = {e.name: workload.initial_states(e.runs) for e in ready}
    for law in laws:
        for turn in range(rounds + 1):
            for entry in ready:
                rate = time_once(entry, law, starts[entry.name])
                if turn:
                    entry.rates.setdefault(law, []).append(rate)


def ratio(entry: Entry, base: Entry, law: str) -> float:
    """Median over rounds of the ratio within a round."""
    pairs = zip(entry.rates[law], base.rates[law], strict=True)
    return statistics.median(a / b for a, b in pairs)


def table(found: list[Entry], laws: list[str]) -> str:
    """Markdown: million steps a second and ratio to the yardstick, per law."""
    head = ["implementation", *(f"{law}: M steps/s | ratio" for law in laws), "note"]
    lines = ["| " + " | ".join(head) + " |", "|---" * (2 + 2 * len(laws)) + "|"]
    base = found[0] if found[0].run else None
    for entry in found:
        cells = [entry.name]
        for law in laws:
            if not entry.run:
                cells += ["-", "-"]
                continue
            cells.append(f"{statistics.median(entry.rates[law]):.4g}")
            cells.append(f"{ratio(entry, base, law):.3g}" if base else "-")
        lines.append("| " + " | ".join([*cells, entry.note]) + " |")
    return "\n".join(lines)


def report(found: list[Entry], laws: list[str], worst: dict[str, float]) -> dict[str, object]:
    """Everything measured, for --json."""
    base = found[0] if found[0].run else None
    rows = [
        {
            "implementation": e.name,
            "law": law,
            "million_steps_per_s": statistics.median(e.rates[law]),
            "rounds": e.rates[law],
            "ratio_to_simd_c": ratio(e, base, law) if base else None,
            "max_difference_from_numpy": worst.get(e.name),
            "note": e.note,
        }
        for e in found
        for law in laws
        if e.run
    ]
    missing = {e.name: e.note for e in found if not e.run}
    return {
        "rows": rows,
        "missing": missing,
        "tolerance": TOLERANCE,
        "width": c_reference.native_width(),
        "tile": c_reference.TILE,
        "machine": platform.machine(),
        "python": platform.python_version(),
        "numpy": np.__version__,
    }


def main() -> None:
    """Verify, measure, print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="smoke run, under 20 s")
    parser.add_argument("--json", type=Path, metavar="FILE")
    parser.add_argument("--rounds", type=int, default=15)
    parser.add_argument("--laws", nargs="+", choices=workload.LAWS, default=list(workload.LAWS))
    args = parser.parse_args()
    found = entries()
    steps, count = (100, 4) if args.quick else (1000, 12)
    worst = verify(found, args.laws, steps, count)
    measure(found, args.laws, 2 if args.quick else args.rounds)
    print(table(found, args.laws))
    print(f"\nLargest difference from NumPy after {steps} steps (allowed {TOLERANCE:g}):")
    print(", ".join(f"{name} {value:.1e}" for name, value in worst.items()))
    if args.json:
        args.json.write_text(json.dumps(report(found, args.laws, worst), indent=1))


if __name__ == "__main__":
    main()
