"""The unknowns and the rows of the collocation program (see `collocation`)."""

from __future__ import annotations

from typing import Any, NamedTuple

from nullmotion.rover import step_dynamics as step
from nullmotion.rover.step_model import StepModel

SOFT = (
    "gimbal rate",
    "gimbal acceleration",
    "body rate",
    "time of the step",
    "singular orientation",
    "off-axis torque",
    "dynamic threshold",
)
LIMITS = 5  # the first five of SOFT are parameters


class Unknowns(NamedTuple):
    """What the solver looks for: state and theta'' at the nodes, theta'' midway, and the rest."""

    state: step.State
    theta_ddot: Any
    middle: Any
    t_f: Any
    c: Any
    soft: Any


def unknowns_count(nodes: int, elastic: bool) -> int:
    """Return the number of unknowns."""
    return 7 * nodes + 1 + len(SOFT) * elastic


def unknowns(x: Any, nodes: int) -> Unknowns:
    """Return a row of unknowns by name; trajectories are theta, its rates, delta, its rates."""
    theta, rate, acceleration, delta, delta_dot, delta_ddot = (
        x[i * nodes : (i + 1) * nodes] for i in range(6)
    )
    state = step.State(theta, rate, delta, delta_dot, delta_ddot)
    rest = 7 * nodes - 1
    soft = [x[i] for i in range(rest + 2, x.shape[0])]
    return Unknowns(state, acceleration, x[6 * nodes : rest], x[rest], x[rest + 1], soft)


def between(found: Unknowns, h: Any) -> step.State:
    """Return the state midway between nodes."""
    theta, rate, delta, delta_dot, q = found.state
    a, b, c = found.theta_ddot[:-1], found.middle, found.theta_ddot[1:]
    return step.State(
        theta[:-1] + h / 2 * rate[:-1] + h * h * (7 * a + 6 * b - c) / 96,
        rate[:-1] + h * (5 * a + 8 * b - c) / 24,
        delta[:-1] + h / 2 * delta_dot[:-1] + h * h * (5 * q[:-1] + q[1:]) / 48,
        delta_dot[:-1] + h * (3 * q[:-1] + q[1:]) / 8,
        (q[:-1] + q[1:]) / 2,
    )


def motion(model: StepModel, state: step.State, theta_ddot: Any) -> Any:
    """Return what the equation of motion lacks, over N."""
    T = step.cmg_torque(model, state, theta_ddot)
    driven = step.dot(T, step.along(model, state.delta, 1))
    return theta_ddot + (driven - step.gravity_torque(model, state.theta)) / model.N


def steps(found: Unknowns, h: Any) -> list[Any]:
    """Return what steps from node to node lack."""
    theta, rate, delta, delta_dot, q = found.state
    a, b, c = found.theta_ddot[:-1], found.middle, found.theta_ddot[1:]
    return [
        rate[1:] - rate[:-1] - h * (a + 4 * b + c) / 6,
        theta[1:] - theta[:-1] - h * rate[:-1] - h * h * (a + 2 * b) / 6,
        delta_dot[1:] - delta_dot[:-1] - h * (q[:-1] + q[1:]) / 2,
        delta[1:] - delta[:-1] - h * delta_dot[:-1] - h * h * (2 * q[:-1] + q[1:]) / 6,
    ]


def margins(
    model: StepModel,
    state: step.State,
    theta_ddot: Any,
    c: Any,
    branch: Any,
    authority: Any,
    soft: list[Any],
) -> list[Any]:
    """Return the rows on torque, 0 or more, over S."""
    S = model.scale
    limits = step.thresholds(model, state, theta_ddot)
    a, b = limits.spare
    return [
        a / S - c + soft[5],
        b / S - c + soft[5],
        limits.tau_DTa / S + soft[6],
        soft[6] - limits.tau_DTb / S,
        branch * step.authority(model, state.delta) - authority * (1 - soft[4]),
    ]


def limits(found: Unknowns, limits: list[Any], soft: list[Any]) -> list[Any]:
    """Return the rows on rates and time that a program with simple bounds does not need."""
    values = (found.state.delta_dot, found.state.delta_ddot, found.state.theta_dot)
    rows = []
    for value, limit, share in zip(values, limits[:3], soft[:3], strict=True):
        rows += [1 + share - value / limit, 1 + share + value / limit]
    return [*rows, 1 + soft[3] - found.t_f / limits[3]]
