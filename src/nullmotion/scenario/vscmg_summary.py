"""What ``summary.json`` holds beside a run's own summary where wheel speeds change."""

from __future__ import annotations

from typing import Any

import numpy as np

from nullmotion.scenario import momentum_budget, objects
from nullmotion.scenario.scenario import Scenario
from nullmotion.sim import wheel_summary
from nullmotion.sim.trajectory import Trajectory
from nullmotion.vscmg import lyapunov


def summary(run: Trajectory, scenario: Scenario) -> dict[str, Any]:
    """Return ``wheels``, ``limited``, ``momentum_budget`` and ``lyapunov``; empty without them."""
    if run.wheel_speed is None:
        return {}
    found: dict[str, Any] = {
        "wheels": wheel_summary.wheels(run),
        "limited": wheel_summary.limits(run),
    }
    if scenario.spacecraft is not None:
        found["momentum_budget"] = budget(scenario)
    monitor = monitored(run)
    return found if monitor is None else found | {"lyapunov": monitor.summary()}


def budget(scenario: Scenario) -> dict[str, Any]:
    """Return the momentum to be held at the end against what the array can hold [N m s]."""
    found = momentum_budget.budget(scenario, objects.array(scenario.array))
    return {
        "start_Nms": found.start.tolist(),
        "from_outside_Nms": found.outside.tolist(),
        "needed_Nms": found.needed,
        "available_Nms": found.available,
        "share": found.needed / found.available if found.available > 0 else None,
    }


def monitored(run: Trajectory) -> lyapunov.LyapunovMonitor | None:
    """Return Lyapunov's function along a run of the controller ``adaptive``; else None."""
    controller = run.setup.controller
    if controller is None or controller.name != "adaptive" or run.estimates is None:
        return None
    known = np.isfinite(run.delta).all() and np.isfinite(run.estimates).all()
    return lyapunov.monitor(run) if known else None
