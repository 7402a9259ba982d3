"""What a reader of an attitude run has to know beside its verdict."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from nullmotion.plot.events import told
from nullmotion.plot.quantities import SINGULAR, USED_UP, motor_limits, sigma_min, turns_wheels
from nullmotion.plot.view import Run
from nullmotion.report.requirements import name, tally
from nullmotion.report.wheels import wheel_findings
from nullmotion.report.wording import number, percent


def findings(
    run: Run,
    requirements: Sequence[Mapping[str, Any]] = (),
    faults: bool = True,
    wheels: Mapping[str, Any] | None = None,
) -> list[str]:
    """Return sentences on faults, singular states, saturation, wheels and requirements.

    Args:
        run: An attitude run.
        requirements: What `nullmotion.scenario.requirements.evaluate` returns.
        faults: Whether what was lost is said; not where the headline says it.
        wheels: What `nullmotion.scenario.vscmg_summary.summary` returns.
    """
    said = [*([told(run)] if faults else []), *_singular(run), *_saturated(run)]
    if turns_wheels(run):
        said += wheel_findings(run, wheels)
    if requirements:
        said.append(_requirements(requirements))
    return [sentence for sentence in said if sentence]


def _singular(run: Run) -> Iterator[str]:
    values = sigma_min(run)
    if values is None or not np.isfinite(values).any():
        return
    at = int(np.nanargmin(values))
    if values[at] >= SINGULAR:
        yield f"No singular encounter: sigma_min is never below {number(values[at], 3)}"
        return
    spent = _time(run, values < SINGULAR)
    low = f"down to {number(values[at], 3)} at {number(run.t[at])} s"
    yield f"Singular encounter: sigma_min {low}, below {number(SINGULAR)} for {number(spent)} s"


def _saturated(run: Run) -> Iterator[str]:
    beyond = run.metrics.get("rate_saturated_s", 0.0)
    if beyond > 0 and not turns_wheels(run):  # there `wheel_findings` tells what was limited
        share = f"{percent(beyond / run.t[-1])} % of the run"
        yield f"The law asked for more than the rate limit for {number(beyond)} s ({share})"
    limits = motor_limits(run)
    if limits and run.setup.servo is not None:
        servo = np.broadcast_to(run.setup.servo.torque_limit, run.delta.shape[1])
        full = (np.abs(run.motor_torque) >= servo * (1 - 1e-9)).any(axis=1)
        if full.any():
            yield f"A gimbal motor gave all of its torque for {number(_time(run, full))} s"
    state = run.measures.get("momentum_state")
    if state is not None and np.nanmin(state, initial=np.inf) < USED_UP:
        at = run.t[int(np.nanargmin(state))]
        yield f"Momentum along the command was used up at {number(at)} s"


def _time(run: Run, when: np.ndarray) -> float:
    return float(np.diff(run.t)[when[:-1]].sum())


def _requirements(results: Sequence[Mapping[str, Any]]) -> str:
    failed = [name(result) for result in results if not result["passed"]]
    return f"Requirements passed: {tally(results)}" + (
        f"; failed: {', '.join(failed)}" if failed else ""
    )
