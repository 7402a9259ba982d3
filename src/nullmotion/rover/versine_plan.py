"""A versine step as a plan, so that it can be tracked, landed and drawn like a planned one."""

from __future__ import annotations

import numpy as np

from nullmotion.rover.rover import Rover, Site
from nullmotion.rover.step_dynamics import State
from nullmotion.rover.step_energy import used_power
from nullmotion.rover.step_model import step_model
from nullmotion.rover.step_plan import StepPlan
from nullmotion.rover.versine_cmg import cmg_versine


def versine_plan(
    rover: Rover,
    edge: int = 1,
    site: Site | None = None,
    rate: float = 2.0,
    face: int | None = None,
) -> StepPlan:
    """Return the versine step of `cmg_versine` as a plan, whether or not it can be made.

    Where no gimbal angle gives the torque the gimbal stays where it last did; the least margin
    is that of the nodes, without those.

    Args:
        rover: The rover.
        edge: Edge, from 1.
        site: Gravity and slope; level ground on Mars by default.
        rate: Greatest rate of the body [rad/s].
        face: Face on the ground before the step; the lower number of the two by default.

    Raises:
        InputError: For an edge that it does not have, or a rate that is not above 0.
    """
    place = site or Site()
    found, frame = cmg_versine(rover, edge, place, rate, face), rover.edge_frame(edge, face)
    t, theta, theta_dot, theta_ddot = (
        found.step.t,
        found.step.theta,
        found.step.theta_dot,
        found.step.theta_ddot,
    )
    known = np.isfinite(found.delta)
    last = np.maximum.accumulate(np.where(known, np.arange(len(t)), 0))
    delta, delta_dot = found.delta[last], np.where(known, found.delta_dot, 0.0)
    delta_ddot = np.gradient(delta_dot, t)
    state = State(theta, theta_dot, delta, delta_dot, delta_ddot)
    power = used_power(step_model(rover, frame, place), state, theta_ddot)
    return StepPlan(
        rover=rover,
        frame=frame,
        site=place,
        t=t,
        theta=theta,
        theta_dot=theta_dot,
        theta_ddot=theta_ddot,
        delta=delta,
        delta_dot=delta_dot,
        delta_ddot=delta_ddot,
        margin=found.margin,
        least_margin=float(np.nanmin(found.margin)),
        energy=float(np.trapezoid(power, t)),
        branch=found.branch,
    )
