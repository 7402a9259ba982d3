"""Whether a startup ended as it should: wheels at their speeds, attitude at its target."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from nullmotion import rotation
from nullmotion.scenario.scenario import Scenario
from nullmotion.sim.batch import BatchResult
from nullmotion.sim.setup import Setup
from nullmotion.sim.trajectory import Trajectory

INCOMPLETE = "startup-incomplete"


def judged(scenario: Scenario, run: Trajectory) -> Trajectory:
    """Return a run with the status that says so where its startup is incomplete."""
    if scenario.mission.kind != "startup" or run.wheel_speed is None:
        return run
    assert run.q_BN is not None
    ready = complete(scenario, run.setup, float(run.t[-1]), run.wheel_speed[-1], run.q_BN[-1])
    return run if ready else replace(run, status=[*run.status, INCOMPLETE])


def judged_batch(scenario: Scenario, setups: Sequence[Setup], result: BatchResult) -> BatchResult:
    """Return many runs with the status of those whose startup is incomplete."""
    if result.final_wheel_speed is None or result.final_q_BN is None:
        return result
    lasted = [setup.steps * setup.dt for setup in setups]
    times = np.where(np.isnan(result.stopped_at_s), lasted, result.stopped_at_s)
    ends = zip(setups, times, result.final_wheel_speed, result.final_q_BN, strict=True)
    missed = np.array([not complete(scenario, *end) for end in ends])
    return replace(result, status={**result.status, INCOMPLETE: missed})


def complete(scenario: Scenario, setup: Setup, t: float, speed: Any, q_BN: Any) -> bool:
    """Return whether every wheel is near its design speed and the attitude near its reference.

    Args:
        scenario: A startup.
        setup: What was run.
        t: When the run ended [s].
        speed: Wheel speeds then [rad/s], (n,).
        q_BN: Attitude then, (4,).
    """
    aim = setup.array.design_speed
    error = rotation.multiply(rotation.conjugate(_reference(setup, t)), q_BN)
    angle = 2.0 * np.arctan2(np.linalg.norm(error[1:]), abs(error[0]))
    mission = scenario.mission
    near = np.all(np.abs(speed - aim) <= mission.wheel_tolerance * aim)
    return bool(near and np.degrees(angle) <= mission.settle_tolerance_deg)


def _reference(setup: Setup, t: float) -> np.ndarray:
    """Return the attitude asked for at a time, as the controller saw it."""
    if setup.target is not None:
        return setup.target
    assert setup.reference is not None
    sample = int(t / setup.period + 1e-9)
    row: np.ndarray = setup.reference[min(sample, len(setup.reference) - 1), :4]
    return row
