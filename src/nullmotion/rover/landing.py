"""A step on real ground: the whole rover on its spikes, from standing on one face to the next.

    landing = land(plan)                              # the tracking controller on rock (Table 3)
    landing = land(plan, "sand.toml")                 # the same on the ground of a file
    landing = land(run, open_loop=True)               # the run's gimbal motion without feedback

The rover is free in all six degrees of freedom; the ground pushes on each spike. When the next face
is down the rover has landed, and the gimbal is braked to rest.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from nullmotion.errors import InputError
from nullmotion.rover.contact import simulate
from nullmotion.rover.contact_command import Numbers, history, tracking
from nullmotion.rover.contact_field import Field
from nullmotion.rover.contact_reference import Reference
from nullmotion.rover.contact_signals import Setting
from nullmotion.rover.contact_state import Machine
from nullmotion.rover.ground import Ground
from nullmotion.rover.ground_file import load_ground
from nullmotion.rover.landing_result import Landing, landing_of
from nullmotion.rover.landing_start import attitude, standing
from nullmotion.rover.landing_watch import LandingWatch
from nullmotion.rover.step_model import step_model
from nullmotion.rover.step_plan import StepPlan
from nullmotion.rover.step_run import StepRun
from nullmotion.rover.tracking import Gains
from nullmotion.rover.watch import Progress


def land(
    step: StepPlan | StepRun,
    ground: Ground | str | Path | None = None,
    *,
    gains: Gains | None = None,
    open_loop: bool = False,
    settle: float = 0.5,
    patience: float = 2.0,
    progress: Progress | None = None,
) -> Landing:
    """Simulate a step on ground that yields.

    Args:
        step: A plan, or its run in closed loop.
        ground: The ground, or a file or name that says which; rock by default.
        gains: Those of the tracking controller.
        open_loop: Follow the step's gimbal angles instead, whatever the rover does.
        settle: How long to go on after landing [s].
        patience: How long to wait for it after the step's end [s].
        progress: Called with the share done, in [0, 1]; what it raises ends the simulation.

    Raises:
        InputError: For a ground or a time that cannot be used.
    """
    for key, value in (("settle", settle), ("patience", patience)):
        if not 0 <= value < np.inf:
            raise InputError(key, value, "a time of at least 0 (s)")
    plan = step.plan if isinstance(step, StepRun) else step
    reference = Reference(step if open_loop else plan)
    yielding = load_ground(Ground() if ground is None else ground)
    delta, delta_dot = reference(0.0)[4:6] if open_loop else (plan.delta[0], 0.0)
    x, carrying = standing(plan.rover, plan.site, plan.frame, yielding, delta, delta_dot)
    spikes = plan.rover.chassis.vertices
    watch = LandingWatch(plan.rover.chassis, plan.frame, reference, settle, patience, progress)
    law, setting = history if open_loop else tracking, _setting(plan, yielding, gains or Gains())
    field = Field(law, reference, setting, spikes, carrying)
    record = simulate(field, x, watch)
    return landing_of(plan, yielding, record, watch)


def _setting(plan: StepPlan, ground: Ground, gains: Gains) -> Setting:
    """Return rover, ground and controller in numbers."""
    rover, cmg = plan.rover, plan.rover.cmg
    return Setting(
        machine=Machine.of(rover, plan.site),
        ground=ground.numbers(rover.mass * plan.site.gravity, rover.friction),
        start=attitude(plan.frame),
        edge=plan.frame.r,
        numbers=Numbers(
            model=step_model(rover, plan.frame, plan.site),
            k_p=float(gains.kp),
            k_d=float(gains.kd),
            k_g=float(gains.gimbal),
            rate_limit=float(cmg.rate_limit),
            acceleration_limit=float(cmg.acceleration_limit),
        ),
    )
