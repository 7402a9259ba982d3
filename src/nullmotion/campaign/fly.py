"""Fly the cases of a comparison: one after another, or in batches when a key is varied."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from nullmotion import rotation
from nullmotion.errors import TraceError
from nullmotion.scenario.batch import compiled, groups
from nullmotion.sim.batch import BatchResult, run_batch
from nullmotion.sim.run import histories, run
from nullmotion.sim.setup import Setup
from nullmotion.sim.state import Record
from nullmotion.sim.trajectory import Trajectory

Progress = Callable[[float], None]
_MOST_SAMPLES = 1_500_000  # over all runs of a varied comparison: some 300 MB of history


class Flown(NamedTuple):
    """A run and its summary; the trajectory may be thinned, the summary never is."""

    trajectory: Trajectory
    summary: dict[str, Any]


def one_by_one(setups: Sequence[Setup], progress: Progress | None = None) -> list[Flown]:
    """Run setups one after another, each with its full history."""
    done = []
    for i, setup in enumerate(setups):
        share = (lambda s, i=i: progress((i + s) / len(setups))) if progress else None
        trajectory = run(setup, progress=share)
        done.append(Flown(trajectory, trajectory.summary()))
    return done


def together(setups: Sequence[Setup], progress: Progress | None = None) -> list[Flown]:
    """Run setups in batches of those that share their structure."""
    every = 1 + sum(setup.steps for setup in setups) // _MOST_SAMPLES
    done: list[Flown | None] = [None] * len(setups)
    before = 0
    for rows in groups(setups):
        picked = [setups[i] for i in rows]
        share = _share(progress, before, len(rows), len(setups))
        for i, flown in zip(rows, _group(picked, every, share), strict=True):
            done[i] = flown
        before += len(rows)
        if progress:
            progress(before / len(setups))
    return [flown for flown in done if flown is not None]


def _share(progress: Progress | None, before: int, count: int, total: int) -> Progress | None:
    return (lambda s: progress((before + s * count) / total)) if progress else None


def _group(setups: Sequence[Setup], every: int, progress: Progress | None) -> list[Flown]:
    if len(setups) == 1 or not compiled(setups[0]):
        return one_by_one(setups, progress)
    try:
        result = run_batch(setups[0], setups=setups, history=every, progress=progress)
    except TraceError:
        return one_by_one(setups, progress)
    return [_single(setup, result, i, every) for i, setup in enumerate(setups)]


def _single(setup: Setup, result: BatchResult, i: int, every: int) -> Flown:
    """Return one run of a batch."""
    assert result.history is not None
    stopped = result.stopped_at_s[i]
    taken = setup.steps if np.isnan(stopped) else round(stopped / setup.dt)
    columns = Record(*(column[i] for column in result.history))
    trajectory = Trajectory(
        setup=setup,
        **histories(setup, columns, taken, every),
        metrics={name: float(values[i]) for name, values in result.metrics.items()},
        stopped_at_s=None if np.isnan(stopped) else float(stopped),
        stop_reason=result.stop_reason[i],
        status=[flag for flag, raised in result.status.items() if raised[i]],
        backend=result.backend,
        instruction_set=result.instruction_set,
    )
    exact = {
        "duration_s": taken * setup.dt,
        "steps": taken,
        "final_momentum": result.final_momentum[i].tolist(),
        "final_gimbal_deg": np.degrees(result.final_gimbal_rad[i]).tolist(),
    }
    if result.final_q_BN is not None and result.final_omega_BN_B is not None:
        q = result.final_q_BN[i]
        exact |= {
            "final_q_BN": q.tolist(),
            "final_euler_321_deg": np.degrees(rotation.euler_321(q)).tolist(),
            "final_omega_BN_B_rad_s": result.final_omega_BN_B[i].tolist(),
        }
    return Flown(trajectory, trajectory.summary() | exact)
