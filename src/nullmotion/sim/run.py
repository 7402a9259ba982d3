"""Run one setup: compiled when its law can be traced, in plain Python otherwise."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from typing import Any, Literal

import numpy as np

from nullmotion import tree
from nullmotion.compile import llvm
from nullmotion.compile.kernel import LoopKernel
from nullmotion.compile.loop import Loop, run_on_host
from nullmotion.errors import InputError, MemoryLimitError, TraceError
from nullmotion.metrics.base import PLAIN
from nullmotion.sim import flywheels
from nullmotion.sim.setup import Setup
from nullmotion.sim.stages import loop, reductions
from nullmotion.sim.state import Outcome, Record
from nullmotion.sim.trajectory import Trajectory

Backend = Literal["auto", "kernel", "python"]
Progress = Callable[[float], None]

_SLICE = 200_000  # steps between two looks at progress and Ctrl-C
_SHORT = 20_000  # runs below this finish sooner with quickly made code


def run(
    setup: Setup, *, backend: Backend = "auto", decimate: int = 1, progress: Progress | None = None
) -> Trajectory:
    """Return the trajectory of a setup.

    Args:
        setup: What to run.
        backend: ``kernel`` compiles it, ``python`` evaluates it as it stands, ``auto``
            compiles and falls back to Python (with a warning) on a law that cannot be traced.
        decimate: Keep every so many steps in the history.
        progress: Called with the finished share.

    Raises:
        TraceError: With ``kernel``, when the law decides by a value.
        MemoryLimitError: When the history would not fit.
    """
    if backend not in ("auto", "kernel", "python"):
        raise InputError("backend", backend, "'auto', 'kernel' or 'python'")
    if decimate < 1:
        raise InputError("decimate", decimate, "a whole number from 1")
    check_history(setup, 1, decimate)
    what = loop(setup, recording=True)
    if setup.integrator == "dop853":
        return _run_python(setup, what, decimate, progress)
    if backend == "kernel" or (backend == "auto" and setup.law.traceable):
        try:
            return _run_kernel(setup, what, decimate, progress)
        except TraceError as error:
            if backend == "kernel":
                raise
            warnings.warn(
                f"{setup.law.name}: runs uncompiled, slower: {error}", RuntimeWarning, stacklevel=2
            )
    return _run_python(setup, what, decimate, progress)


def schedule(setup: Setup) -> np.ndarray:
    """Return the command for every sample of the law, the last row held on, at rest."""
    if not setup.scheduled:
        return np.zeros((1, 0))
    samples = np.arange(setup.steps // setup.period_steps + 1)
    table = np.ascontiguousarray(setup.table[np.minimum(samples, len(setup.table) - 1)])
    if setup.reference is not None:
        table[samples >= len(setup.table), 4:] = 0.0
    return table


def check_history(setup: Setup, runs: int, decimate: int) -> None:
    """Refuse a history that would take more than half of the memory."""
    import os

    values = 5 * setup.array.n + 3 * setup.array.m + (11 if setup.spacecraft else 0)
    values += (6 * setup.array.n + 9) if setup.variable_speed else 0
    need = 8 * runs * (setup.steps // decimate + 1) * values
    have = (
        os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
        if hasattr(os, "sysconf")
        else 8 << 30
    )
    if need > have // 2:
        raise MemoryLimitError(
            f"the history of {runs} runs x {setup.steps} steps takes {need / 2**30:.1f} GiB, "
            f"over half of this machine's memory ({have / 2**30:.1f} GiB): "
            "keep fewer steps (decimate) or fewer runs"
        )


def _run_kernel(setup: Setup, what: Loop, decimate: int, progress: Progress | None) -> Trajectory:
    kernel = LoopKernel(what, recording=True, width=1, level=0 if setup.steps < _SHORT else 2)
    total = setup.steps + 1
    state = np.zeros((kernel.carried, 1))
    out = np.zeros((kernel.outputs + len(kernel.flags), 1))
    history = np.empty((setup.steps // decimate + 1, kernel.records, 1))
    rows, none = schedule(setup), np.zeros((0, 1))
    for k0 in range(0, total, _SLICE):
        k1 = min(k0 + _SLICE, total)
        kernel.run(state, none, rows, history, out, 0, 1, k0, k1, k1 == total, decimate)
        if progress:
            progress(k1 / total)
    outcome: Outcome = tree.unflatten(kernel.traced.output_like, out[: kernel.outputs, 0].tolist())
    flags = [f for f, raised in zip(kernel.flags, out[kernel.outputs :, 0], strict=True) if raised]
    columns = _columns(kernel.traced.record_like, history[:, :, 0])
    return assemble(setup, outcome, columns, flags, decimate, "kernel", llvm.host().instruction_set)


def _run_python(setup: Setup, what: Loop, decimate: int, progress: Progress | None) -> Trajectory:
    total = setup.steps + 1
    step = (lambda k: progress((k + 1) / total) if k % 100 == 0 else None) if progress else None
    with np.errstate(all="ignore"):
        outcome, history = run_on_host(what, total, schedule(setup), step, recording=True)
    kept = history[::decimate]
    columns = Record(
        *[np.array([np.asarray(r[i], float) for r in kept]) for i in range(len(Record._fields))]
    )
    return assemble(setup, outcome, columns, [], decimate, "python", "")


def _columns(like: Any, table: np.ndarray) -> Record:
    parts, at = [], 0
    for item in like:
        size = len(tree.flatten(item))
        parts.append(table[:, at : at + size])
        at += size
    return Record(*parts)


def assemble(
    setup: Setup,
    outcome: Outcome,
    columns: Record,
    flags: list[str],
    decimate: int,
    backend: str,
    instructions: str,
) -> Trajectory:
    """Return the trajectory of a run's record and outcome."""
    taken = int(outcome.taken)
    code = int(outcome.stop)
    stopped = code > 0
    return Trajectory(
        setup=setup,
        **histories(setup, columns, taken, decimate),
        metrics=totals(setup, outcome.sums, taken),
        stopped_at_s=round(taken * setup.dt, 12) if stopped else None,
        stop_reason=setup.stop[code - 1].reason if stopped else "end of run",
        status=status(setup, outcome, flags),
        law_counts=law_counts(setup, outcome),
        backend=backend,
        instruction_set=instructions,
    )


def histories(setup: Setup, columns: Record, taken: int, every: int) -> dict[str, Any]:
    """Return a run's record as the fields of a `Trajectory`, up to the step that was its last.

    Args:
        setup: The run.
        columns: Its record, rows first, one row ``every`` so many steps.
        taken: Number of steps taken; no rate acts after the last.
        every: Steps between two rows.
    """
    kept = taken // every + 1
    cut = Record(*[np.array(c[:kept]) for c in columns])
    if taken % every == 0:
        ends = ("rates", "asked", "motor_torque", "wheel_torque", "spin_rate", "spin_torque")
        for acting in (getattr(cut, name) for name in ends):
            acting[-1] = np.nan
    found = {"t": np.arange(kept) * (setup.dt * every), **cut._asdict()}
    for name in ("spin", "spin_rate", "spin_torque", "work"):
        del found[name]
    found |= {"rates_asked": found.pop("asked"), "momentum_wanted": found.pop("wanted")}
    wheel = {key: found[key] for key in ("wheel_momentum", "wheel_torque")}
    found |= {k: v[:, 0] if setup.reaction_wheel else None for k, v in wheel.items()}
    found |= flywheels.history(setup, cut)
    if setup.spacecraft is None:
        found |= dict.fromkeys(("q_BN", "omega_BN_B", "reference"))
    return found


def totals(setup: Setup, sums: Any, taken: Any) -> dict[str, Any]:
    """Return the metrics by name from a run's sums (floats or arrays over runs)."""
    result = {}
    steps = np.maximum(taken, 1)
    for (metric, reduction), value in zip(reductions(setup.metrics), sums, strict=True):
        if reduction == "rms":
            value = np.sqrt(value / steps)
        elif reduction == "mean":
            value = value / steps
        elif reduction == "total":
            value = value * setup.dt
        elif reduction == "latest":  # a time beyond the run's end was not reached
            value = np.where(value > taken * setup.dt * (1 + 1e-12), np.nan, value)
        name = metric.name if reduction in PLAIN else f"{reduction}_{metric.name}"
        result[name] = np.where(np.isinf(value), np.nan, value)[()]
    return result


def status(setup: Setup, outcome: Outcome, flags: list[str]) -> list[str]:
    """Return the status flags of a finished run."""
    found = list(flags)
    if not (np.isfinite(outcome.delta).all() and np.isfinite(outcome.rates).all()):
        found.append("non-finite")
    if setup.variable_speed and outcome.cut > 0:
        found.append(flywheels.CUT)
    return [*found, *(name for name, count in law_counts(setup, outcome).items() if count)]


def law_counts(setup: Setup, outcome: Outcome) -> dict[str, int]:
    """Return what the law counted on the way; nothing for one that was compiled."""
    return {} if setup.law.traceable else dict(setup.law.counts(outcome.law))
