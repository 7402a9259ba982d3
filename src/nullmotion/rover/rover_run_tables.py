"""The histories of a step as tables, whatever file they go to."""

from __future__ import annotations

import numpy as np

from nullmotion.rover.initialise import Initialisation
from nullmotion.rover.landing_result import Landing
from nullmotion.rover.rover_run_columns import Column, Table
from nullmotion.rover.step_plan import StepPlan
from nullmotion.rover.step_run import StepRun
from nullmotion.rover.versine_wheels import WheelStep


def plan_table(plan: StepPlan) -> Table:
    """Return a plan."""
    margin = Column("margin", "N m", "torque to spare before a spike lifts off", plan.margin)
    return Table("plan", [*_body(plan), *_gimbal(plan), margin])


def initialisation_table(way: Initialisation) -> Table:
    """Return the gimbal's way to the start of a step."""
    spare = Column("spare", "N m", "torque to spare before the rover tips over an edge", way.spare)
    return Table("initialise", [_time(way.t), *_gimbal(way), spare])


def run_table(run: StepRun) -> Table:
    """Return a step in closed loop."""
    return Table(
        "closed_loop",
        [
            *_body(run),
            *_gimbal(run),
            Column("angle_error", "rad", "planned less true angle", run.angle_error),
            Column("turning", "1", "1 while the body turns about the edge", run.turning * 1.0),
            Column("margin", "N m", "torque to spare before a spike lifts off", run.margin),
        ],
    )


def landing_table(landing: Landing) -> Table:
    """Return a step on the ground."""
    s, x = landing.signals, landing.state
    return Table(
        "landing",
        [
            _time(landing.t),
            Column("theta", "rad", "angle turned about the edge", s.theta),
            Column("theta_dot", "rad s-1", "its rate", s.theta_dot),
            Column("tilt", "rad", "angle of the turn beside it", s.tilt),
            Column("delta", "rad", "gimbal angle", x[:, 13]),
            Column("delta_dot", "rad s-1", "gimbal rate", x[:, 14]),
            Column("delta_ddot", "rad s-2", "gimbal acceleration", s.delta_ddot),
            Column("position", "m", "mass centre in f, r, p from the edge", x[:, :3], ("axis",)),
            Column("q_BN", "1", "attitude, scalar first", x[:, 3:7], ("quaternion",)),
            Column("velocity", "m s-1", "of the mass centre in f, r, p", x[:, 7:10], ("axis",)),
            Column("omega_BN_B", "rad s-1", "body rate in B", x[:, 10:13], ("body_axis",)),
            Column("gimbal_power", "W", "of the gimbal motor, signed", s.gimbal_power),
            Column("rotor_power", "W", "of the rotor motor, signed", s.rotor_power),
            Column("energy", "J", "kinetic and potential energy", s.energy),
            Column("stored", "J", "energy in the ground's springs", s.stored),
            Column("dissipated", "W", "power lost in the ground", s.dissipated),
            Column("sinkage", "m", "of each spike; above ground < 0", s.sinkage, ("spike",)),
            Column("force", "N", "ground's force on each spike in f, r, p", s.force,
                   ("spike", "axis")),
        ],
    )  # fmt: skip


def wheel_table(step: WheelStep) -> Table:
    """Return a versine step of a rover with wheels; the wheels count as one about the edge."""
    v = step.step
    return Table(
        "versine",
        [
            _time(v.t),
            Column("theta", "rad", "angle turned about the edge", v.theta),
            Column("theta_dot", "rad s-1", "its rate", v.theta_dot),
            Column("torque", "N m", "on the wheels together", step.torque),
            Column("wheel_speed", "rad s-1", "of the wheels together", step.speed),
            Column("margin", "N m", "torque to spare before a spike lifts off",
                   step.spare.min(axis=0)),
        ],
    )  # fmt: skip


def _time(t: np.ndarray) -> Column:
    return Column("t", "s", "time", t)


def _body(step: StepPlan | StepRun) -> list[Column]:
    return [
        _time(step.t),
        Column("theta", "rad", "angle turned about the edge", step.theta),
        Column("theta_dot", "rad s-1", "its rate", step.theta_dot),
        Column("theta_ddot", "rad s-2", "its acceleration", step.theta_ddot),
    ]


def _gimbal(step: StepPlan | StepRun | Initialisation) -> list[Column]:
    return [
        Column("delta", "rad", "gimbal angle", step.delta),
        Column("delta_dot", "rad s-1", "gimbal rate", step.delta_dot),
        Column("delta_ddot", "rad s-2", "gimbal acceleration", step.delta_ddot),
    ]
