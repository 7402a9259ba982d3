"""Charts of a step: dashed what was planned, solid what came of it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from nullmotion.plot import palette
from nullmotion.plot.parts import limited
from nullmotion.plot.view import Curve, Level, Panel
from nullmotion.report.rover_step_events import marks

_NEAR = 0.06  # of the time: marks closer than that share the weightiest name
_LATE = 0.6  # share of the time from which a mark's name runs to the left
WEIGHT = ("landing", "tipping", "turning", "slip", "lift-off", "touchdown", "departure", "sliding")

_HOW = {"m": "by up to", "rad": "by up to", "m/s": "at"}

Signal = Callable[[Any], np.ndarray]


def step_panels(plan: Any, run: Any, landing: Any) -> list[Panel]:
    """Return the charts of a step."""
    shown = [Source("plan", plan, palette.INK, "dash", 1.4)]
    if landing is not None:
        shown.insert(0, Source("on the ground", OnGround(landing), palette.colour(0), width=1.8))
    if run is not None:
        slot, width = (0, 1.8) if landing is None else (1, 3.6)  # the wider one stays in sight
        shown.insert(0, Source("closed loop", run, palette.colour(slot), width=width))
    panels = [*_motion(plan, shown), *_torques(plan, shown)]
    if landing is not None:
        panels.append(_loads(landing))
    named = marks(run, landing)
    return [replace(panel, marks=named) for panel in panels]


class Source:
    """What curves are taken from, and how they look."""

    def __init__(
        self, label: str, step: Any, colour: str, dash: str = "solid", width: float = 1.6
    ) -> None:
        """Take name, object and style."""
        self.label, self.step = label, step
        self.colour, self.dash, self.width = colour, dash, width

    def curve(self, signal: Signal) -> Curve:
        """Return the curve of a signal."""
        values = signal(self.step)
        return Curve(self.label, self.step.t, values, self.colour, self.dash, self.width)


class OnGround:
    """A landing, named like a run."""

    def __init__(self, landing: Any) -> None:
        """Take what curves are made of."""
        self.plan, self.t = landing.plan, landing.t
        self.theta, self.theta_dot = landing.signals.theta, landing.signals.theta_dot
        self.delta, self.delta_dot = landing.state[:, 13], landing.state[:, 14]
        self.delta_ddot = landing.signals.delta_ddot
        self.angle_error = np.interp(self.t, self.plan.t, self.plan.theta) - self.theta


def _motion(plan: Any, shown: Sequence[Source]) -> Iterator[Panel]:
    cmg, end = plan.rover.cmg, float(np.degrees(plan.frame.turn))
    yield Panel(
        "theta",
        "Angle turned about the edge",
        "θ [deg]",
        _curves(shown, lambda step: np.degrees(step.theta)),
        (Level(end, f"next face down, {end:.4g} deg"),),
    )
    for key, title, label, limit, unit in (
        ("theta_dot", "Rate of the body", "θ′ [deg/s]", None, ""),
        ("delta", "Gimbal angle", "δ [deg]", None, ""),
        ("delta_dot", "Gimbal rate", "δ′ [deg/s]", cmg.rate_limit, "deg/s"),
        ("delta_ddot", "Gimbal acceleration", "δ″ [deg/s²]", cmg.acceleration_limit, "deg/s²"),
    ):
        panel = Panel(key, title, label, _curves(shown, _degrees(key)))
        yield panel if limit is None else limited(panel, [float(np.degrees(limit))], unit)
    late = [source for source in shown if hasattr(source.step, "angle_error")]
    if late:
        curves = _curves(late, _degrees("angle_error"))
        yield Panel("error", "Planned angle less the true one", "Error [deg]", curves)


def _torques(plan: Any, shown: Sequence[Source]) -> Iterator[Panel]:
    driven = _curves(shown, lambda step: drive(plan, step))
    weight = Curve(
        "holds the weight", plan.t, -gravity(plan, plan.theta), palette.QUIET, "dot", 1.4
    )
    yield Panel(
        "drive",
        "CMG torque about the edge",
        "−h δ′ o·r [N m]",
        (*driven, weight),
        note="Above the dotted line it speeds the body up.",
    )
    spared = [source for source in shown if hasattr(source.step, "margin")]
    yield Panel(
        "margin",
        "Torque to spare",
        "Margin [N m]",
        _curves(spared, lambda step: step.margin),
        (Level(0.0, "a spike lifts off"),),
        note="Before a spike of the edge lifts off; at rest: before another edge is tipped over.",
    )


def _loads(landing: Any) -> Panel:
    """Return what the ground pushes on each spike; above twice the weight it is cut off."""
    force = np.asarray(landing.signals.force)[..., 2]
    weight = landing.plan.rover.mass * landing.plan.site.gravity
    most = 2 * weight
    curves = tuple(
        Curve(f"spike {i}", landing.t, np.minimum(force[:, i], most), palette.colour(i),
              palette.dash(i))
        for i in range(force.shape[1])
    )  # fmt: skip
    note = f"Impacts beyond {most:.4g} N are cut off." if force.max() > most else ""
    level = (Level(weight, "weight"),)
    return Panel("load", "Load of the spikes", "Force [N]", curves, level, note)


def drive(plan: Any, step: Any) -> np.ndarray:
    """Return -h delta' o . r [N m], by which the CMG turns the body about the edge, (k,)."""
    cmg, r = plan.rover.cmg, plan.frame.r
    s0, _, o0 = cmg.axes(0.0)
    along = np.cos(step.delta) * (o0 @ r) - np.sin(step.delta) * (s0 @ r)
    return np.asarray(-cmg.momentum * step.delta_dot * along)


def gravity(plan: Any, theta: np.ndarray) -> np.ndarray:
    """Return the weight's torque about the edge, M (cm/o x g) . r [N m], (k,)."""
    x, _, z = plan.frame.com
    c, s = np.cos(theta), np.sin(theta)
    f, _, p = plan.site.vector
    return np.asarray(plan.rover.mass * ((c * z - s * x) * f - (c * x + s * z) * p))


def _degrees(key: str) -> Signal:
    return lambda step: np.degrees(getattr(step, key))


def _curves(shown: Sequence[Source], signal: Signal) -> tuple[Curve, ...]:
    return tuple(source.curve(signal) for source in shown)
