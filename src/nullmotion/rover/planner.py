"""Planning a step: the trajectory with the greatest least margin (Elliott 2019, Section 5.4.1).

The sign of o . r cannot change during a step, so that each sign is a problem of its own. Both are
solved on few nodes, from several guesses; the best is solved again on more, and on more still
while the margin between nodes falls below that at the nodes.
"""

from __future__ import annotations

import functools
import itertools
from collections.abc import Iterator
from time import perf_counter

import numpy as np

from nullmotion.rover import diagnosis, solve
from nullmotion.rover.dense import dense_margin, energy_used, margins
from nullmotion.rover.plan_error import PlanError, Violation
from nullmotion.rover.rover import Rover, Site
from nullmotion.rover.settings import Settings
from nullmotion.rover.solve import Solution, Task, Tick
from nullmotion.rover.step_model import step_model
from nullmotion.rover.step_plan import StepPlan
from nullmotion.rover.watch import Progress

_EVEN = 1e-4  # margins over M g L/2 that differ by less are equal: the first found stays


def plan_step(
    rover: Rover,
    edge: int = 1,
    site: Site | None = None,
    face: int | None = None,
    settings: Settings | None = None,
    progress: Progress | None = None,
) -> StepPlan:
    """Plan a step over an edge.

    Args:
        rover: The rover.
        edge: Edge, from 1.
        site: Gravity and slope; level ground on Mars by default.
        face: Face on the ground before the step (see `Chassis.edge_frame`).
        settings: Limits and how to solve.
        progress: Called with the share done, in [0, 1]. What it raises, and Ctrl-C, ends the solve.

    Returns:
        The plan; its least margin, on the dense grid too, is above 0.

    Raises:
        PlanError: When there is no such step: with the constraint in the way, and by how much.
        InputError: For an edge or a face that the rover does not have.
    """
    begin = perf_counter()
    site, settings = site or Site(), settings or Settings()
    frame = rover.edge_frame(edge, face)
    model = step_model(rover, frame, site)
    tasks = [Task(model, frame.turn, rover.cmg.rate_limit, settings, b) for b in (1, -1)]
    words = f"over edge {edge} at {np.degrees(site.incline):g} deg in {site.gravity:g} m/s^2"
    task, solution, least = _best_step(tasks, words, progress)
    x = solution.x
    return StepPlan(
        rover=rover,
        frame=frame,
        site=site,
        t=np.linspace(0.0, solution.t_f, x.shape[1]),
        theta=x[0],
        theta_dot=x[1],
        theta_ddot=x[2],
        delta=x[3],
        delta_dot=x[4],
        delta_ddot=x[5],
        margin=margins(model, x, x[2]),
        least_margin=least,
        energy=energy_used(model, solution, settings.dense),
        branch=task.branch,
        seconds=perf_counter() - begin,
    )


def _best_step(
    tasks: list[Task], words: str, progress: Progress | None
) -> tuple[Task, Solution, float]:
    """Return the better branch, its solution and least margin [N m], or say why there is none."""
    ticks = _ticks(len(tasks) * len(tasks[0].settings.start_durations) + 1, progress)
    task, solution = _coarse(tasks, ticks) or _rescued(tasks, words, next(ticks))
    least = solution.c * task.model.scale
    if least > 0:
        solution, least = _fine(task, solution, next(ticks))
    if least <= 0:
        raise PlanError(words, (diagnosis.off_axis(least),))
    if progress:
        progress(1.0)
    return task, solution, least


def _coarse(tasks: list[Task], ticks: Iterator[Tick]) -> tuple[Task, Solution] | None:
    """Return the best of all branches and guesses on few nodes."""
    best: tuple[Task, Solution] | None = None
    for task in tasks:
        for duration in task.settings.start_durations:
            start = solve.guess(task, task.settings.nodes[0], duration)
            solution = solve.solve(task, start, tick=next(ticks))
            if solution.closed and (best is None or solution.c > best[1].c + _EVEN):
                best = task, solution
    return best


def _rescued(tasks: list[Task], words: str, tick: Tick) -> tuple[Task, Solution]:
    """Return a step found from the one that passes its limits least, or say which it passes."""
    worst: tuple[float, tuple[Violation, ...]] = (np.inf, ())
    for task in tasks:
        near = diagnosis.least_violation(task, task.settings.start_durations[-1], tick)
        if near is None:
            continue
        passed = diagnosis.violations(task, near)
        if not passed:
            solution = solve.solve(task, near._replace(soft=near.soft[:0]), tick=tick)
            if solution.closed:
                return task, solution
        worst = min(worst, (float(near.soft.sum()), passed), key=lambda item: item[0])
    raise PlanError(words, worst[1])


def _fine(task: Task, solution: Solution, tick: Tick) -> tuple[Solution, float]:
    """Return the solution on as many nodes as it takes, and its least margin [N m]."""
    settings = task.settings
    nodes, least = settings.nodes[1], dense_margin(task, solution)
    while True:
        finer = solve.solve(task, solve.resampled(solution, nodes), tick=tick)
        if finer.closed:
            solution, least = finer, dense_margin(task, finer)
        kept = least > (1 - settings.drop) * solution.c * task.model.scale
        nodes *= 2
        if kept or nodes > settings.most_nodes:
            return solution, least


def _ticks(stages: int, progress: Progress | None) -> Iterator[Tick]:
    """Yield a tick for each stage; within one the share nears 1 with the iterations."""
    shown = 0.0

    def tick(stage: int, count: int) -> None:
        nonlocal shown
        shown = max(shown, min((stage + 1 - 0.95**count) / stages, 0.999))
        if progress:
            progress(shown)

    for stage in itertools.count():
        yield functools.partial(tick, min(stage, stages - 1))
