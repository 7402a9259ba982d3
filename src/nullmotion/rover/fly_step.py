"""Integrating the closed loop of a step, from rest on one face until the next is down."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from nullmotion.rover import step_dynamics as step
from nullmotion.rover.dense import interpolated
from nullmotion.rover.limits import resting_margin
from nullmotion.rover.step_energy import total_energy
from nullmotion.rover.step_plan import StepPlan
from nullmotion.rover.step_run import StepRun
from nullmotion.rover.tracking import Gains, Loop, loop

_SETTLE = 2.0  # [s] after the plan's end in which the step may come down
_DOWN = 0.01  # [rad] that may be missing then: the body falls that far by itself
_SAMPLE = 2e-3  # [s] between values that are kept
_PHASES = 50  # rests and turns; a body that falls back more often chatters on its face
_ACCURACY = {"method": "DOP853", "rtol": 1e-7, "atol": 1e-9, "max_step": 0.02}


class Phase(NamedTuple):
    """A rest or a turn: times (k,), theta, its rate, delta, its rate, work, energy (6, k)."""

    t: np.ndarray
    y: np.ndarray
    turning: bool


def track(plan: StepPlan, gains: Gains | None = None) -> StepRun:
    """Run a planned step in closed loop, from a gimbal at rest.

    Args:
        plan: What to track.
        gains: The controller's gains.

    Returns:
        The run. Its outcome is ``landed``; ``tipped`` when the margin falls below 0 (the run goes
        on as if the edge held); ``stalled`` when the next face is not down in time.
    """
    closed = loop(plan, gains or Gains())
    end = plan.duration + _SETTLE
    y = np.array([0.0, 0.0, plan.delta[0], 0.0, 0.0, 0.0])
    phases = [Phase(np.zeros(1), y[:, None], bool(_pull(closed, 0.0, y) > 0))]
    while phases[-1].t[-1] < end and len(phases) < _PHASES and y[0] < plan.frame.turn - 1e-9:
        turning = not phases[-1].turning if len(phases) > 1 else phases[-1].turning
        phase = _phase(closed, phases[-1].t[-1], end, y, plan.frame.turn, turning)
        y = phase.y[:, -1].copy()
        if phase.turning and y[0] < plan.frame.turn / 2 and phase.t[-1] < end:
            y[:2] = 0.0  # it fell back on its face, which takes the rest of its speed
        phases.append(phase)
    return _run(plan, closed, phases[1:])


def _pull(closed: Loop, t: float, y: np.ndarray) -> float:
    """Return the acceleration that the body has, or would have but for its face [rad/s^2]."""
    return float(step.acceleration(closed.model, closed.state(t, y.tolist())))


def _phase(
    closed: Loop, begin: float, end: float, y: np.ndarray, turn: float, turning: bool
) -> Phase:
    """Integrate until the body lifts off, comes down or falls back."""
    from scipy.integrate import solve_ivp

    events: list[Callable[[float, np.ndarray], float]] = (
        [_event(lambda t, y: y[0] - turn, 1), _event(lambda t, y: y[0] + 1e-9, -1)]
        if turning
        else [_event(lambda t, y: _pull(closed, t, y), 1)]
    )
    rates = closed.turning if turning else closed.resting
    found = solve_ivp(rates, (begin, end), y, events=events, dense_output=True, **_ACCURACY)
    last = float(found.t[-1])
    t = np.linspace(begin, last, 1 + max(1, round((last - begin) / _SAMPLE)))
    return Phase(t, np.column_stack([found.sol(t[:-1]), found.y[:, -1]]), turning)


def _event(function: Callable[[float, np.ndarray], float], direction: int) -> Any:
    function.terminal, function.direction = True, direction  # type: ignore[attr-defined]
    return function


def _energies(closed: Loop, phase: Phase) -> np.ndarray:
    """Return the energy at both ends of a phase [J], (2,)."""
    ends = [0, -1]
    energies: np.ndarray = total_energy(closed.model, closed.state(phase.t[ends], phase.y[:, ends]))
    return energies


def _run(plan: StepPlan, closed: Loop, phases: list[Phase]) -> StepRun:
    """Return a run from its phases."""
    kept = [p.t.size - 1 for p in phases[:-1]] + [phases[-1].t.size]  # one ends as the next begins
    t = np.concatenate([p.t[:n] for p, n in zip(phases, kept, strict=True)])
    y = np.hstack([p.y[:, :n] for p, n in zip(phases, kept, strict=True)])
    turning = np.repeat([p.turning for p in phases], kept)
    state = closed.state(t, y)
    theta_ddot = np.where(turning, step.acceleration(closed.model, state), 0.0)
    swung = np.minimum(*step.thresholds(closed.model, state, theta_ddot).spare)
    margin = np.where(turning, swung, resting_margin(plan, state))
    change = sum(float(np.diff(_energies(closed, p))[0]) for p in phases)
    missing = plan.frame.turn - y[0, -1]
    outcome = "tipped" if margin.min() < 0 else "landed" if missing < _DOWN else "stalled"
    lifted = turning.any()
    return StepRun(
        plan=plan,
        t=t,
        theta=y[0],
        theta_dot=y[1],
        theta_ddot=theta_ddot,
        delta=y[2],
        delta_dot=y[3],
        delta_ddot=state.delta_ddot,
        angle_error=interpolated(closed.plan, closed.t_f, t)[0] - y[0],
        turning=turning,
        margin=margin,
        energy=float(y[5, -1]),
        work=float(y[4, -1]),
        energy_change=change,
        lift_off=float(t[np.argmax(turning)]) if lifted else np.inf,
        outcome=outcome,
    )
