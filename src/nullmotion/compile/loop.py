"""A time loop around pure stages: its description, and the loop in plain Python.

A loop carries a state record through steps k = 0, 1, ... Each stage is a pure
function that acts at the steps ``k % period == phase``. `kernel.LoopKernel` makes machine
code of the same description.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

StageFunction = Callable[[Any, Any, Any, Any], Any]  # (k, row, state, parameters) -> state


@dataclass(frozen=True)
class Stage:
    """One part of a step: ``function(k, row, state, parameters) -> state``."""

    function: StageFunction
    period: int = 1
    phase: int = 0


@dataclass(frozen=True)
class Loop:
    """What is repeated, on floats or symbols alike.

    Attributes:
        start: Makes the state from the parameters.
        stages: What a step does, in order.
        outputs: Makes what is wanted of the state and the parameters at the end.
        record: Picks what a history keeps, after the stages ``recorded_after`` and
            before the rest of the step.
        parameters: Example record; its leaves are constants but for the varying ones.
        varying: For each leaf of ``parameters``, whether it differs between runs.
        row: Length of a row of the schedule, the values that all runs share in a step.
        row_period: Steps for which a row holds.
        active: Tells from the state whether a run goes on; None if all do.
        recorded_after: Number of stages before the record.
    """

    start: Callable[[Any], Any]
    stages: tuple[Stage, ...]
    outputs: Callable[[Any, Any], Any]
    parameters: Any
    varying: tuple[bool, ...]
    row: int = 0
    row_period: int = 1
    active: Callable[[Any], Any] | None = None
    record: Callable[[Any], Any] | None = None
    recorded_after: int = 0


def run_on_host(
    loop: Loop,
    steps: int,
    schedule: np.ndarray,
    on_step: Callable[[int], None] | None = None,
    recording: bool = False,
) -> tuple[Any, list[Any]]:
    """Run one loop in plain Python, with the floats of ``loop.parameters``.

    Returns:
        The outputs and, when recording, the record of every step.
    """
    parameters, history = loop.parameters, []
    state = loop.start(parameters)
    for k in range(steps):
        row = schedule[k // loop.row_period] if loop.row else np.zeros(0)
        for index, stage in enumerate(loop.stages):
            if recording and loop.record is not None and index == loop.recorded_after:
                history.append(loop.record(state))
            if k % stage.period == stage.phase:
                state = stage.function(float(k), row, state, parameters)
        if on_step is not None:
            on_step(k)
        if loop.active is not None and not loop.active(state):
            break
    return loop.outputs(state, parameters), history
