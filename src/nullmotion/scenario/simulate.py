"""Fly scenarios: one, or many that differ in values."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from nullmotion.scenario import batch, build, startup
from nullmotion.scenario.load import load_scenario
from nullmotion.scenario.scenario import Scenario
from nullmotion.sim.batch import BatchResult
from nullmotion.sim.run import Backend, run
from nullmotion.sim.trajectory import Trajectory

Progress = Callable[[float], None]


def simulate(
    scenario: Scenario | str | Path,
    backend: Backend = "auto",
    *,
    decimate: int = 1,
    progress: Progress | None = None,
) -> Trajectory:
    """Return the trajectory of a scenario.

    Args:
        scenario: A scenario, or what `load_scenario` takes.
        backend: ``kernel`` (compiled), ``python`` or ``auto``.
        decimate: Keep every so many steps.
        progress: Called with the finished share.
    """
    loaded = _loaded(scenario)
    flown = run(build.setup(loaded), backend=backend, decimate=decimate, progress=progress)
    return startup.judged(loaded, flown)


def simulate_batch(
    scenario: Scenario | str | Path,
    metrics: Sequence[str] | None = None,
    threads: int | None = None,
    progress: Progress | None = None,
    history: int = 0,
    **values: Any,
) -> BatchResult:
    """Return the metrics of many runs of a scenario.

    Args:
        scenario: A scenario, or what `load_scenario` takes.
        metrics: Names of the metrics; all registered ones by default.
        threads: Threads, or processes for a law that runs in Python; one for each core by default.
        progress: Called with the finished share.
        history: Keep every so many steps of every run (0: none).
        **values: Values by key, runs along the leading axis: ``gimbal_deg=starts`` (runs, n),
            ``hdot_Nm=directions`` (runs, m), ``target_q_BN=attitudes`` (runs, 4),
            ``skew_deg=angles`` (runs,), and with the section for a key that stands in
            several, ``**{"law.sigma_c": ...}``, or a fault: ``**{"event.0.at_s": ...}``.

    Raises:
        InputError: For an unknown or ambiguous key, lengths that differ, impossible values.
    """
    base = _loaded(scenario)
    names = None if metrics is None else tuple(metrics)
    return batch.run(base, values, names, threads=threads, progress=progress, history=history)


def _loaded(scenario: Scenario | str | Path) -> Scenario:
    return scenario if isinstance(scenario, Scenario) else load_scenario(scenario)
