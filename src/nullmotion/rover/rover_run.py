"""A step from its file: planned, followed in closed loop, landed on the ground."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from time import perf_counter

from nullmotion.rover.edge_frame import EdgeFrame
from nullmotion.rover.files import StepFile
from nullmotion.rover.impulsive import ImpulsiveStep, impulsive_step
from nullmotion.rover.initialise import Initialisation
from nullmotion.rover.interrupt import interruptible
from nullmotion.rover.landing_result import Landing
from nullmotion.rover.rover import Rover
from nullmotion.rover.step_plan import StepPlan
from nullmotion.rover.step_run import StepRun
from nullmotion.rover.versine import Verdict
from nullmotion.rover.versine_wheels import WheelStep
from nullmotion.rover.watch import Progress
from nullmotion.rover.wheels import WheelRover
from nullmotion.scenario.problems import MISSING, Problem, ScenarioError

_WHEELS = "a rover with a CMG; `nullmotion rover plan` tells what steps with wheels take"
_SHARES = (0.3, 0.1, 0.6)  # of the time that plan, closed loop and landing take


@dataclass(frozen=True, eq=False)
class WheelPlan:
    """What a step takes with reaction wheels.

    Attributes:
        frame: Frame of the step.
        impulsive: The step of a wheel that is spun up and braked.
        versine: The step along a versine.
    """

    frame: EdgeFrame
    impulsive: ImpulsiveStep
    versine: WheelStep


@dataclass(frozen=True, eq=False)
class StepResult:
    """A step from plan to landing.

    Attributes:
        file: What was asked for.
        plan: The plan.
        verdict: How a versine comes out; None for a planned step.
        initialisation: The gimbal's way to where the step starts; None if none was asked for.
        run: The step in closed loop.
        landing: The step on the ground.
        seconds: How long it took to compute.
    """

    file: StepFile
    plan: StepPlan
    verdict: Verdict | None
    initialisation: Initialisation | None
    run: StepRun
    landing: Landing
    seconds: float


def plan_file(
    file: StepFile, progress: Progress | None = None
) -> tuple[StepPlan | WheelPlan, Verdict | None]:
    """Return the plan of a file's step, and how a versine of a CMG comes out.

    Args:
        file: Rover and step.
        progress: Called with the share done, in [0, 1].

    Raises:
        PlanError: When there is no such step: with the constraint in the way, and by how much.
        InputError: For a step that the rover cannot make.
    """
    from nullmotion.rover.versine_wheels import versine_step

    rover, at = file.rover, (file.edge, file.site)
    with file.located():
        if isinstance(rover, Rover):
            with interruptible(progress) as told:
                return _plan(file, rover, told)
        impulsive = impulsive_step(rover, *at, face=file.face)
        versine = versine_step(rover, *at, file.versine_rate, file.face)
        return WheelPlan(rover.chassis.edge_frame(file.edge, file.face), impulsive, versine), None


def _plan(
    file: StepFile, rover: Rover, progress: Progress | None
) -> tuple[StepPlan, Verdict | None]:
    if file.motion == "planned":
        from nullmotion.rover.planner import plan_step

        return plan_step(rover, file.edge, file.site, file.face, file.settings, progress), None
    from nullmotion.rover.versine_cmg import cmg_versine
    from nullmotion.rover.versine_plan import versine_plan

    given = (rover, file.edge, file.site, file.versine_rate, file.face)
    return versine_plan(*given), cmg_versine(*given).verdict


def run_file(file: StepFile, progress: Progress | None = None) -> StepResult:
    """Return a file's step from plan to landing.

    Args:
        file: Rover and step.
        progress: Called with the share done, in [0, 1]; what it raises ends the work.

    Raises:
        PlanError: As for `plan_file`.
        InputError: For a rover with wheels, or a step that the rover cannot make.
    """
    from nullmotion.rover.fly_step import track
    from nullmotion.rover.initialise import initialise
    from nullmotion.rover.landing import land

    rover, begin = file.rover, perf_counter()
    if isinstance(rover, WheelRover):
        where = file.source.where(("wheels",))
        raise ScenarioError([Problem("wheels", MISSING, _WHEELS, where)])
    with file.located(), interruptible(progress) as told:
        planning, tracking, landing_on = shares(told, _SHARES)
        plan, verdict = _plan(file, rover, planning)
        start = file.initial_gimbal
        way = None if start is None else initialise(plan, start, file.threshold_share)
        run = track(plan, file.gains)
        if tracking:
            tracking(1.0)
        landing = land(plan, file.ground, gains=file.gains, progress=landing_on)
    return StepResult(file, plan, verdict, way, run, landing, perf_counter() - begin)


def shares(progress: Progress | None, sizes: tuple[float, ...]) -> Iterator[Progress | None]:
    """Yield what reports each part of the work as a share of the whole."""
    first = 0.0
    for size in sizes:
        yield None if progress is None else _share(progress, first, size)
        first += size


def _share(progress: Progress, first: float, size: float) -> Progress:
    return lambda share: progress(first + size * share)
