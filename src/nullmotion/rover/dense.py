"""A collocated step between its nodes: interpolation, margin, energy.

A quintic through angle, rate and acceleration at both ends is what the collocation has between its
points, whose degree is four; the margin is taken with the body's acceleration that the equation of
motion gives.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from nullmotion.rover import step_dynamics as step
from nullmotion.rover.solve import Solution, Task
from nullmotion.rover.step_energy import used_power
from nullmotion.rover.step_model import StepModel


def interpolated(x: np.ndarray, t_f: float, t: np.ndarray | float) -> np.ndarray:
    """Return trajectories theta, its rates, delta, its rates (6, n) at times, (6, ...).

    Before the step and after it angles stay as they are.
    """
    steps = x.shape[1] - 1
    h = t_f / steps
    inside = np.clip(t, 0.0, t_f)
    k = np.minimum((inside / h).astype(int), steps - 1)
    u = inside / h - k
    rows = [*_quintic(x[:3, k], x[:3, k + 1], h, u), *_quintic(x[3:, k], x[3:, k + 1], h, u)]
    moving = inside == t
    return np.array([row * (moving | (i % 3 == 0)) for i, row in enumerate(rows)])


def interpolated_at(rows: list[list[float]], t_f: float, t: float) -> list[float]:
    """Return `interpolated` at one time, for trajectories as a list of nodes; much faster."""
    steps = len(rows) - 1
    h = t_f / steps
    inside = min(max(t, 0.0), t_f)
    k = min(int(inside / h), steps - 1)
    low, high = rows[k], rows[k + 1]
    body = _quintic(low[:3], high[:3], h, inside / h - k)
    gimbal = _quintic(low[3:], high[3:], h, inside / h - k)
    if inside != t:
        return [body[0], 0.0, 0.0, gimbal[0], 0.0, 0.0]
    return [*body, *gimbal]


def _quintic(low: Any, high: Any, h: float, u: Any) -> tuple[Any, Any, Any]:
    """Return angle, rate and acceleration at a share u between two triples of them."""
    x, v, a = low[0], low[1] * h, low[2] * h * h
    miss = high[0] - x - v - a / 2
    miss_v = high[1] * h - v - a
    miss_a = high[2] * h * h - a
    c3 = 10 * miss - 4 * miss_v + miss_a / 2
    c4 = -15 * miss + 7 * miss_v - miss_a
    c5 = 6 * miss - 3 * miss_v + miss_a / 2
    return (
        x + u * (v + u * (a / 2 + u * (c3 + u * (c4 + u * c5)))),
        (v + u * (a + u * (3 * c3 + u * (4 * c4 + u * 5 * c5)))) / h,
        (a + u * (6 * c3 + u * (12 * c4 + u * 20 * c5))) / (h * h),
    )


def state(x: np.ndarray) -> step.State:
    """Return trajectories (6, ...) as a state."""
    return step.State(x[0], x[1], x[3], x[4], x[5])


def margins(model: StepModel, x: np.ndarray, theta_ddot: np.ndarray) -> np.ndarray:
    """Return the torque to spare before either spike lifts off [N m], (...)."""
    spare = step.thresholds(model, state(x), theta_ddot).spare
    return np.minimum(*spare)


def on_grid(solution: Solution, times: int) -> tuple[np.ndarray, np.ndarray]:
    """Return times and trajectories on a grid that is denser by a factor, (k,) and (6, k)."""
    t = np.linspace(0.0, solution.t_f, (solution.x.shape[1] - 1) * times + 1)
    return t, interpolated(solution.x, solution.t_f, t)


def dense_margin(task: Task, solution: Solution) -> float:
    """Return the least margin on the dense grid [N m]."""
    _, x = on_grid(solution, task.settings.dense)
    return float(margins(task.model, x, step.acceleration(task.model, state(x))).min())


def energy_used(model: StepModel, solution: Solution, times: int) -> float:
    """Return the energy of Eq 88 [J]."""
    t, x = on_grid(solution, times)
    return float(np.trapezoid(used_power(model, state(x), x[2]), t))
