"""Run many setups at once, one run a vector lane, blocks of runs over threads."""

from __future__ import annotations

import dataclasses
import os
import threading
from collections.abc import Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from dataclasses import dataclass
from typing import Any

import numpy as np

from nullmotion import tree
from nullmotion.compile import llvm
from nullmotion.compile.kernel import LoopKernel
from nullmotion.errors import InputError
from nullmotion.sim import flywheels
from nullmotion.sim.run import Progress, _columns, check_history, schedule, totals
from nullmotion.sim.setup import Setup
from nullmotion.sim.stages import loop, passes
from nullmotion.sim.state import Outcome, Record, parameters

_WORK = 2_000_000  # run-steps in one call: about a tenth of a second, then a look at Ctrl-C


@dataclass(frozen=True)
class BatchResult:
    """Metrics of many runs.

    Attributes:
        metrics: Name to values, each (runs,).
        stopped_at_s: When each run stopped [s]; NaN if it lasted its full time.
        stop_reason: In words, for each run.
        final_gimbal_rad: Final gimbal angles, (runs, n).
        final_momentum: Final momentum of the true array [N m s], (runs, m).
        status: Flag to a boolean for each run.
        final_q_BN: Final attitude, (runs, 4); None without a spacecraft.
        final_omega_BN_B: Final body rate [rad/s], (runs, 3).
        final_wheel_speed: Final wheel speeds of variable-speed CMGs [rad/s], (runs, n).
        history: Decimated histories on request, each (runs, samples, ...).
        backend: ``kernel`` or ``python``.
        instruction_set: Vector instructions of the kernel.
    """

    metrics: dict[str, np.ndarray]
    stopped_at_s: np.ndarray
    stop_reason: list[str]
    final_gimbal_rad: np.ndarray
    final_momentum: np.ndarray
    status: dict[str, np.ndarray]
    history: Record | None = None
    backend: str = "kernel"
    instruction_set: str = ""
    final_q_BN: np.ndarray | None = None
    final_omega_BN_B: np.ndarray | None = None
    final_wheel_speed: np.ndarray | None = None

    def __len__(self) -> int:
        """Return the number of runs."""
        return len(self.stopped_at_s)

    def __getitem__(self, name: str) -> np.ndarray:
        """Return a metric's values by name."""
        return self.metrics[name]


def run_batch(
    base: Setup,
    *,
    delta: np.ndarray | None = None,
    hdot: np.ndarray | None = None,
    target: np.ndarray | None = None,
    q_BN: np.ndarray | None = None,
    omega_BN_B: np.ndarray | None = None,
    setups: Sequence[Setup] | None = None,
    threads: int | None = None,
    history: int = 0,
    progress: Progress | None = None,
) -> BatchResult:
    """Run many setups that share their structure.

    Args:
        base: What is common.
        delta: Start angles of each run [rad], (runs, n); all as in ``base`` if None.
        hdot: Constant command of each run [N m], (runs, m); all as in ``base`` if None.
        target: Attitude to go to of each run, (runs, 4), with a spacecraft.
        q_BN: Attitude at the start of each run, (runs, 4).
        omega_BN_B: Body rate at the start of each run [rad/s], (runs, 3).
        setups: One setup for each run (other values may differ too); what is given beside
            it overrides.
        threads: Threads; as many as the machine has cores by default.
        history: Keep every so many steps of every run (0: none).
        progress: Called with the finished share.

    Raises:
        InputError: When lengths disagree, the setups differ in more than numbers, or the
            integrator is not compiled.
        TraceError: When the law cannot be traced: run such laws one by one.
        MemoryLimitError: When the histories would not fit.
    """
    if base.integrator == "dop853":
        raise InputError("integrator", base.integrator, "a compiled one: dop853 runs go one by one")
    given = {"delta": delta, "hdot": hdot, "target": target}
    given |= {"spacecraft.q_BN": q_BN, "spacecraft.omega_BN_B": omega_BN_B}
    table, varying = values(base, given, setups)
    runs = table.shape[1]
    if history:
        check_history(base, runs, history)
    few = runs * base.steps < _WORK  # soon done: what is quickly compiled is enough
    kernel = LoopKernel(
        loop(base, varying, recording=bool(history)),
        recording=bool(history),
        width=llvm.host().lanes if few else None,
    )
    job = _Job(kernel, base, table, history)
    _spread(job, runs, threads or os.cpu_count() or 1, progress)
    return job.result(runs)


def values(
    base: Setup, given: dict[str, np.ndarray | None], setups: Sequence[Setup] | None
) -> tuple[np.ndarray, tuple[bool, ...]]:
    """Return the values of the varying leaves, (leaves, runs), and which leaves vary."""
    own = parameters(base)
    size = len(tree.flatten(own))
    columns: dict[int, np.ndarray] = {}
    counts = {len(x) for x in (*given.values(), setups) if x is not None}
    if len(counts) > 1 or not counts or 0 in counts:
        raise InputError(
            "runs", sorted(counts), "the same number of runs (at least one) in every value"
        )
    count = counts.pop()
    if setups is not None:
        columns.update(_differing(base, setups))
    for name, value in given.items():
        if value is not None:
            columns.update(_override(base, own, name, value, count))
    varying = tuple(i in columns for i in range(size))
    return np.array([np.broadcast_to(columns[i], (count,)) for i in sorted(columns)]).reshape(
        -1, count
    ), varying


def _override(
    base: Setup, own: Any, name: str, value: np.ndarray, count: int
) -> dict[int, np.ndarray]:
    """Return the columns of one value that differs between runs, by leaf."""
    found: Any = own
    for part in name.split("."):
        found = None if found is None else getattr(found, part)
    if found is None or (name == "hdot" and base.scheduled):
        raise InputError(name, np.shape(value), "nothing: this setup has no such value")
    table = np.asarray(value, float)
    if table.shape != (count, len(found)) or not np.isfinite(table).all():
        raise InputError(name, table.shape, f"{count} x {len(found)} finite numbers")
    if name in ("target", "spacecraft.q_BN"):
        table = table / np.linalg.norm(table, axis=1, keepdims=True)
    first = _first_leaf(own, name)
    return {first + j: table[:, j] for j in range(len(found))}


def _first_leaf(own: Any, name: str) -> int:
    """Return the number of leaves before a field given by dotted name."""
    head, _, rest = name.partition(".")
    fields = getattr(own, "_fields", None) or [f.name for f in dataclasses.fields(own)]
    before = [getattr(own, f) for f in fields[: list(fields).index(head)]]
    first = len(tree.flatten(tuple(before)))
    return first + _first_leaf(getattr(own, head), rest) if rest else first


def _differing(base: Setup, setups: Sequence[Setup]) -> dict[int, np.ndarray]:
    like = structure(base)
    rows = []
    for i, setup in enumerate(setups):
        if structure(setup) != like:
            raise InputError(
                f"setups[{i}]",
                setup.law.name,
                "the same structure as the first (numbers may differ)",
            )
        rows.append(tree.flatten(parameters(setup)))
    table = np.array(rows, float)
    return {i: table[:, i] for i in range(table.shape[1]) if not (table[:, i] == table[0, i]).all()}


def structure(setup: Setup) -> Any:
    """Return what two setups must share to run in one kernel."""
    rest = (
        setup.steps,
        setup.period_steps,
        setup.delay_steps,
        setup.integrator,
        setup.metrics,
        setup.hdot.shape,
        setup.dt,  # sums over time are made of counts of steps
    )
    table = setup.table.tobytes() if setup.scheduled else b""
    stops = tuple((s.metric, s.below) for s in setup.stop)
    return (tree.structure(parameters(setup)), rest, table, stops)


class _Job:
    """The work of a batch: its memory, and what one block of runs does."""

    def __init__(self, kernel: LoopKernel, base: Setup, values: np.ndarray, history: int) -> None:
        self.kernel, self.base, self.every = kernel, base, history or 1
        runs = values.shape[1]
        self.padded = -(-runs // kernel.width) * kernel.width
        self.values = np.empty((len(values), self.padded))
        self.values[:, :runs] = values
        self.values[:, runs:] = values[:, -1:]
        self.out = np.zeros((kernel.outputs + len(kernel.flags), self.padded))
        self.rows = schedule(base)
        samples = base.steps // self.every + 1
        self.history = np.empty((runs, samples, kernel.records)) if history else None
        self.stopped = threading.Event()

    def block(self, start: int, lanes: int) -> int:
        """Run ``lanes`` runs from column ``start``; return how many."""
        kernel, total = self.kernel, passes(self.base, self.history is not None)
        state = np.zeros((kernel.carried, lanes))
        shape = (
            (self.base.steps // self.every + 1, kernel.records, lanes)
            if self.history is not None
            else (1,)
        )
        history = np.empty(shape)
        stride = max(1, _WORK // lanes)
        for k0 in range(0, total, stride):
            if self.stopped.is_set():
                return 0
            k1 = min(k0 + stride, total)
            kernel.run(
                state,
                self.values,
                self.rows,
                history,
                self.out,
                start,
                lanes,
                k0,
                k1,
                k1 == total,
                self.every,
            )
        if self.history is not None:
            runs = min(lanes, len(self.history) - start)
            self.history[start : start + runs] = history[:, :, :runs].transpose(2, 0, 1)
        return lanes

    def result(self, runs: int) -> BatchResult:
        """Gather what the blocks wrote."""
        kernel, base = self.kernel, self.base
        rows = list(self.out[: kernel.outputs, :runs])
        outcome: Outcome = _gather(kernel.traced.output_like, rows)
        flags = self.out[kernel.outputs :, :runs].astype(bool)
        status = dict(zip(kernel.flags, flags, strict=True))
        status["non-finite"] = ~(
            np.isfinite(outcome.delta).all(axis=1) & np.isfinite(outcome.rates).all(axis=1)
        )
        if base.variable_speed:
            status[flywheels.CUT] = outcome.cut > 0
        code = outcome.stop.astype(int)
        reasons = ["end of run", *[s.reason for s in base.stop]]
        history = None
        if self.history is not None:
            flat = self.history.reshape(-1, kernel.records)
            columns = _columns(kernel.traced.record_like, flat)
            samples = self.history.shape[1]
            history = Record(*[c.reshape(runs, samples, c.shape[1]) for c in columns])
        return BatchResult(
            totals(base, outcome.sums, outcome.taken),
            np.where(code > 0, outcome.taken * base.dt, np.nan),
            [reasons[max(c, 0)] for c in code],
            outcome.delta,
            outcome.momentum,
            status,
            history,
            "kernel",
            llvm.host().instruction_set,
            outcome.q_BN if base.spacecraft else None,
            outcome.omega_BN_B if base.spacecraft else None,
            outcome.spin if base.variable_speed else None,
        )


def _gather(like: Any, rows: list[np.ndarray]) -> Any:
    """Return a record like ``like`` whose leaves are arrays over runs, runs first."""
    source = iter(rows)

    def build(item: Any) -> Any:
        if isinstance(item, tuple):
            parts = [build(child) for child in item]
            return type(item)(*parts) if hasattr(item, "_fields") else tuple(parts)
        if isinstance(item, np.ndarray):
            return np.stack([next(source) for _ in range(item.size)], axis=-1)
        return next(source)

    return build(like)


def _spread(job: _Job, runs: int, threads: int, progress: Progress | None) -> None:
    """Run all blocks on threads; stop between slices on Ctrl-C."""
    width = job.kernel.width
    share = -(-job.padded // (4 * threads) // width) * width
    lanes = max(width, min(64 * width, share))
    blocks = [(start, min(lanes, job.padded - start)) for start in range(0, job.padded, lanes)]
    done = 0
    with ThreadPoolExecutor(threads) as pool:
        pending: set[Future[int]] = {pool.submit(job.block, *b) for b in blocks}
        try:
            while pending:
                finished, pending = wait(pending, timeout=0.1, return_when=FIRST_COMPLETED)
                done += sum(f.result() for f in finished)
                if progress and finished:
                    progress(done / job.padded)
        except BaseException:
            job.stopped.set()
            for future in pending:
                future.cancel()
            raise
