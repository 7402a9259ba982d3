"""A rover on its spikes over time: smooth until a spike begins or ends to carry, then anew.

Between such instants the equations of `contact_dynamics` are smooth and stiff (C_c / M is 2e4 1/s
on rock); they are integrated by Radau IIA of order 5 with the exact Jacobian. The instant at which
a spike comes to the ground, or its force to zero, is found on the solver's own polynomial, and
integration begins anew there. Integrals over time (work, losses) are sums over the nodes of each
step, to the solver's order.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from nullmotion.rover.contact_field import Field
from nullmotion.rover.contact_record import Change, Record
from nullmotion.rover.contact_step import Step

RTOL = 1e-6  # energy then balances to 1e-5
# m, -, m/s, rad/s, rad, rad/s: C_c times the third is 0.01 N on rock
ATOL = np.repeat([1e-9, 1e-9, 1e-8, 1e-8, 1e-8], [3, 4, 3, 3, 2])
LONGEST_STEP = 0.05  # s: a spike that touches and leaves within one is not seen
MOST_CHANGES = 1000


Watch = Callable[[Record], float]  # after each step and change: until when to go on [s]


def simulate(equations: Field, x: np.ndarray, watch: Watch) -> Record:
    """Simulate from t = 0.

    Args:
        equations: Right-hand side, with the spikes that carry at first.
        x: State at first, (15,).
        watch: Called at first, after each step and when a spike begins or ends to carry; returns
            when to end [s].
    """
    record, t = Record(), 0.0
    while t < watch(record) and not record.failure:
        t, x, spike = _smooth(equations, t, x, record, watch)
        if spike is None:
            break
        carrying = equations.carrying.copy()
        carrying[spike] ^= True
        equations.carry(carrying)
        record.changes.append(Change(float(t), spike, bool(carrying[spike]), x))
        if len(record.changes) >= MOST_CHANGES:
            record.failure = f"spikes began or ended to carry {MOST_CHANGES} times"
    return record


def _smooth(
    equations: Field, t: float, x: np.ndarray, record: Record, watch: Watch
) -> tuple[float, np.ndarray, int | None]:
    """Integrate until a spike begins or ends to carry, or to the end.

    Returns:
        Time, state and spike; None at the end.
    """
    solver = _solver(equations, t, x, watch(record))
    while solver.status == "running":
        before = solver.y
        step = _step(equations, solver, record)
        found = None if step is None else step.first_change()
        if step is not None and found is not None:
            return _to_change(equations, step.t[0], before, found, record)
        if step is not None:
            record.note(step)
        if watch(record) <= solver.t:
            break
    return solver.t, solver.y, None


def _to_change(
    equations: Field, t: float, x: np.ndarray, found: tuple[float, int], record: Record
) -> tuple[float, np.ndarray, int | None]:
    """Repeat a step up to the instant found on it: the polynomial is less exact than the nodes."""
    if found[0] <= t:
        return t, x, found[1]
    solver = _solver(equations, t, x, found[0], first_step=found[0] - t)
    while solver.status == "running":
        step = _step(equations, solver, record)
        if step is not None:
            record.note(step)
    return solver.t, solver.y, None if record.failure else found[1]


def _solver(equations: Field, t: float, x: np.ndarray, end: float, **more: Any) -> Any:
    from scipy.integrate import Radau

    options: dict[str, Any] = {"rtol": RTOL, "atol": ATOL, "max_step": LONGEST_STEP, **more}
    return Radau(equations.change, t, x, end, jac=equations.slopes, **options)


def _step(equations: Field, solver: Any, record: Record) -> Step | None:
    """Return the solver's next step; None, and the record says why, if it has none."""
    message = solver.step()
    if solver.status == "failed":
        record.failure = f"the solver gave up: {message}"
        return None
    return Step(equations, solver.dense_output(), solver.t_old, solver.t)
