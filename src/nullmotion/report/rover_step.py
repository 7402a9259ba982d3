"""The page of a step: animation, charts, events, numbers."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from nullmotion.report import page
from nullmotion.report.charts import Charts, grid
from nullmotion.report.markup import Markup, tag
from nullmotion.report.rover_stage import legend, scripts, stage
from nullmotion.report.rover_step_events import happened, tipping
from nullmotion.report.rover_step_numbers import number_table
from nullmotion.report.rover_step_panels import step_panels
from nullmotion.report.rover_step_scene import scene
from nullmotion.report.tiles import Tile, row
from nullmotion.report.wording import number


def write_step_report(
    path: str | Path, plan: Any, run: Any = None, landing: Any = None, title: str = ""
) -> Path:
    """Write a step over an edge as an HTML page that needs no network.

    Args:
        path: File to write.
        plan: A `nullmotion.rover.StepPlan`.
        run: Its `StepRun` in closed loop.
        landing: Its `Landing` on the ground, which the animation then shows.
        title: Title of the page; what was stepped over by default.

    Returns:
        The path.
    """
    panels = step_panels(plan, run, landing)
    charts = Charts.for_curves(sum(len(panel.curves) for panel in panels))
    drawn = grid([charts.add(panel, group="time") for panel in panels])
    shown = scene(plan, run, landing)
    instants = [(at, words) for at, _, words in happened(run, landing)]
    acted = stage(shown, _seen(plan), _legend(plan, run, landing), instants)
    head = title or f"{plan.rover.name}: a step over e{plan.frame.edge}"
    parts = [
        _header(plan, run, landing, head),
        page.section("Key numbers", row(_tiles(plan, run, landing)), id="numbers"),
        page.section("The step", tag("div", acted, drawn, class_="beside"), id="step"),
        page.section("Numbers", number_table(plan, run, landing), id="table"),
        scripts(shown, "step"),
    ]
    return page.write(path, page.document(head, parts, charts, page.versions()))


def _header(plan: Any, run: Any, landing: Any, title: str) -> Markup:
    words, good = _verdict(plan, run, landing)
    return tag(
        "header",
        tag("p", title, class_="title"),
        tag("h1", words, class_=f"verdict {'done' if good else 'trouble'}"),
        tag("p", _subject(plan), class_="subject"),
    )


def _verdict(plan: Any, run: Any, landing: Any) -> tuple[str, bool]:
    """Return what came of the step, and whether that is good."""
    if landing is not None:
        slip, tilt = number(1e3 * landing.slip, 3), number(np.degrees(landing.tilt), 3)
        words = f"slip {slip} mm, tilt {tilt} deg, on {landing.ground.name}"
        if landing.outcome == "landed":
            return f"Landed after {number(landing.landed_at, 3)} s: {words}", landing.as_planned
        return f"{landing.outcome.capitalize()}: {words}", False
    if run is not None and run.outcome == "landed":
        late = number(np.degrees(run.max_angle_error), 3)
        return f"Landed after {number(run.t[-1], 3)} s, at most {late} deg off the plan", True
    if run is not None and run.outcome == "tipped":
        when = f"Tips at {number(tipping(run), 3)} s: there a spike of the edge lifts off"
        return f"{when}; the run goes on as if the edge held", False
    if run is not None:
        after = f"the next face is not down after {number(run.t[-1], 3)} s"
        return f"{run.outcome.capitalize()}: {after}", False
    spare = number(plan.least_margin, 3)
    return f"A step of {number(plan.duration, 3)} s with {spare} N m to spare", True


def _subject(plan: Any) -> str:
    rover, site = plan.rover, plan.site
    ground = "level ground"
    if site.incline:
        way = "uphill" if site.incline > 0 else "downhill"
        ground = f"{way} on {number(abs(np.degrees(site.incline)), 3)} deg"
        if site.heading:
            ground += f", {number(np.degrees(site.heading), 3)} deg off the step"
    size = f"{rover.chassis.name} of {number(rover.mass)} kg and {number(plan.frame.length)} m"
    drive = f"one CMG of {number(rover.cmg.momentum)} N m s"
    return f"{rover.name}, a {size} with {drive}; {ground}, {number(site.gravity)} m/s²"


def _tiles(plan: Any, run: Any, landing: Any) -> list[Tile]:
    result = next(one for one in (landing, run, plan) if one is not None)
    whose = {id(landing): "on the ground", id(run): "in closed loop"}.get(id(result), "as planned")
    made = [
        Tile("Cost of travel", number(result.cost_of_travel, 3), "J/(kg m)", whose),
        Tile("Energy of the motors", number(result.energy, 3), "J", "Eq 88"),
        Tile("Planned time", number(plan.duration, 3), "s"),
        Tile("Least margin", number(plan.least_margin, 3), "N m", "planned, on a dense grid"),
    ]
    if run is not None:
        worst = number(np.degrees(run.max_angle_error), 3)
        note = f"least margin then {number(run.least_margin, 3)} N m"
        made.append(Tile("Largest angle error", worst, "deg", note))
    if landing is not None:
        made.append(Tile("Slip of the edge", number(1e3 * landing.slip, 3), "mm"))
        made.append(Tile("Off-axis tilt", number(np.degrees(landing.tilt), 3), "deg"))
    return made


def _seen(plan: Any) -> str:
    return (
        f"Animation: the {plan.rover.chassis.name} turns over edge {plan.frame.edge} by "
        f"{number(np.degrees(plan.frame.turn))} deg; charts below show the same in numbers."
    )


def _legend(plan: Any, run: Any, landing: Any) -> Markup:
    entries = [("gimbal-axis", "g, gimbal axis"), ("spin-axis", "s, spin axis of the rotor")]
    if run is not None or landing is not None:
        entries.insert(0, ("planned", "planned"))
        entries.insert(0, ("result", "on the ground" if landing is not None else "closed loop"))
    entries.append(("edge", "edge it turns about"))
    if landing is not None:
        entries.append(("force", "push of the ground; half an edge long: the rover's weight"))
    return legend(entries)
