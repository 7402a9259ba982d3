"""Batch results from parts: groups of runs, or runs flown one after another."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from nullmotion.errors import InputError
from nullmotion.sim.batch import BatchResult
from nullmotion.sim.setup import Setup
from nullmotion.sim.trajectory import Trajectory
from nullmotion.sim.workers import run_each

_BODY = {  # what a batch holds of a body and of wheels, and where a run holds it
    "final_q_BN": "q_BN",
    "final_omega_BN_B": "omega_BN_B",
    "final_wheel_speed": "wheel_speed",
}


def merged(parts: Sequence[BatchResult], rows: Sequence[np.ndarray]) -> BatchResult:
    """Return one result whose run ``rows[p][i]`` is run i of part p."""
    if len(parts) == 1:
        return parts[0]
    order = np.argsort(np.concatenate(rows))
    flags = {flag for part in parts for flag in part.status}
    status = {f: [p.status.get(f, np.zeros(len(p), bool)) for p in parts] for f in sorted(flags)}
    reasons = [reason for part in parts for reason in part.stop_reason]
    return BatchResult(
        {name: _joined([p.metrics[name] for p in parts], order) for name in parts[0].metrics},
        _joined([p.stopped_at_s for p in parts], order),
        [reasons[i] for i in order],
        _joined([p.final_gimbal_rad for p in parts], order),
        _joined([p.final_momentum for p in parts], order),
        {flag: _joined(columns, order) for flag, columns in status.items()},
        None,
        parts[0].backend,
        parts[0].instruction_set,
        **{name: _where_known([getattr(p, name) for p in parts], order) for name in _BODY},
    )


def _where_known(columns: Sequence[np.ndarray | None], order: np.ndarray) -> np.ndarray | None:
    """Return what each part has, joined; None if any has none."""
    known = [column for column in columns if column is not None]
    return _joined(known, order) if len(known) == len(columns) else None


def _joined(columns: Sequence[np.ndarray], order: np.ndarray) -> np.ndarray:
    widths = {column.shape[1:] for column in columns}
    if len(widths) > 1:
        raise InputError(
            "runs", sorted(widths), "arrays with the same number of CMGs and torque dimensions"
        )
    joined: np.ndarray = np.concatenate(columns)[order]
    return joined


def one_by_one(
    base: Setup,
    setups: Sequence[Setup] | None,
    arrays: Mapping[str, np.ndarray],
    options: Mapping[str, Any],
) -> BatchResult:
    """Return the result of runs flown one after another (laws that cannot be traced)."""
    count = len(next(x for x in (setups, *arrays.values()) if x is not None))
    runs = list(setups or [base] * count)
    for key, table in arrays.items():
        runs = [_with(setup, key, row) for setup, row in zip(runs, table, strict=True)]
    return gathered(run_each(runs, options.get("progress"), options.get("threads")))


def _with(setup: Setup, key: str, value: Any) -> Setup:
    if setup.spacecraft is not None and key in ("q_BN", "omega_BN_B"):
        return replace(setup, spacecraft=replace(setup.spacecraft, **{key: value}))
    return replace(setup, **{key: value})


def gathered(runs: Sequence[Trajectory]) -> BatchResult:
    """Return the result of finished runs."""
    flags = sorted({flag for run in runs for flag in run.status})
    return BatchResult(
        {name: np.array([run.metrics[name] for run in runs]) for name in runs[0].metrics},
        np.array([np.nan if run.stopped_at_s is None else run.stopped_at_s for run in runs]),
        [run.stop_reason for run in runs],
        np.array([run.delta[-1] for run in runs]),
        np.array([run.momentum[-1] for run in runs]),
        {flag: np.array([flag in run.status for run in runs]) for flag in flags},
        None,
        "python",
        **_ends(runs),
    )


def _ends(runs: Sequence[Trajectory]) -> dict[str, Any]:
    """Return the final state of body and wheels, where the runs have them."""
    known = {name: source for name, source in _BODY.items() if _has(runs[0], source)}
    return {n: np.array([getattr(run, s)[-1] for run in runs]) for n, s in known.items()}


def _has(run: Trajectory, name: str) -> bool:
    return getattr(run, name) is not None
