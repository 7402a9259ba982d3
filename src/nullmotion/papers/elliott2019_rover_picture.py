"""A step in pictures, as in Figure 34 of Elliott 2019: isometric, from below the slope."""

from __future__ import annotations

from typing import Any

import numpy as np

from nullmotion.papers.elliott2019_camera import Camera
from nullmotion.papers.elliott2019_rover_steps import Step
from nullmotion.plot import palette
from nullmotion.report.rover_step_scene import world

CAMERA = Camera(float(np.arctan(np.sqrt(0.5))), np.radians(-135.0))
SHARES = (0.0, 0.2, 0.4, 0.6, 0.8, 1.0)  # of the angle turned
_BACK, _AHEAD, _WIDE = -1.05, 1.25, 0.8  # the slope that is drawn, over the edge's length
_PLACE = {"left": 0.01, "right": 0.99, "bottom": 0.01, "top": 0.89, "wspace": 0.02, "hspace": 0.1}
_REACH = 0.42  # of the axes of the CMG


class Eye:
    """Draws points given in f, r, p of a step."""

    def __init__(self, axes: Any, step: Step) -> None:
        """Take axes to draw into, and the step."""
        self.axes = axes
        self.to_paper = CAMERA.axes @ world(step.plan.site)

    def seen(self, points: np.ndarray) -> np.ndarray:
        """Return points (k, 3) on paper: right, up, towards the viewer, (3, k)."""
        paper: np.ndarray = self.to_paper @ np.atleast_2d(points).T
        return paper

    def line(self, points: Any, closed: bool = False, **look: Any) -> None:
        """Draw a line."""
        ends = np.array([*points, points[0]] if closed else points)
        self.axes.plot(*self.seen(ends)[:2], **{"linewidth": 1.0, **look})

    def area(self, points: Any, colour: str, opacity: float, order: float) -> None:
        """Fill a polygon."""
        x, y, _ = self.seen(np.array(points))
        self.axes.fill(x, y, facecolor=colour, alpha=opacity, edgecolor="none", zorder=order)

    def text(self, point: np.ndarray, words: str, colour: str) -> None:
        """Write a word."""
        x, y, _ = self.seen(point)[:, 0]
        centred = {"ha": "center", "va": "center", "fontsize": 7.5, "zorder": 9}
        self.axes.text(x, y, words, color=colour, **centred)


def picture(figure: Any, step: Step) -> None:
    """Draw a step at some angles."""
    run = step.run
    figure.set_layout_engine("none")
    panes = figure.subplots(2, len(SHARES) // 2, sharex=True, sharey=True, gridspec_kw=_PLACE)
    for axes, share in zip(panes.flat, SHARES, strict=True):
        wanted = share * run.theta[-1]
        at = int(np.searchsorted(run.theta, wanted - 1e-9)) if share else 0
        axes.set_axis_off()
        axes.set(aspect="equal")
        eye = Eye(axes, step)
        _slope(eye, step)
        _body(eye, step, at)
        axes.set_title(f"{run.t[at]:.1f} s, {np.degrees(run.theta[at]):.0f} deg")


def _slope(eye: Eye, step: Step) -> None:
    L, plan = step.plan.frame.length, step.plan
    corners = [
        (f * L, r * L, 0.0)
        for f, r in ((_BACK, -_WIDE), (_AHEAD, -_WIDE), (_AHEAD, _WIDE), (_BACK, _WIDE))
    ]
    eye.area(corners, palette.GRID, 0.8, 0)
    up = -plan.site.vector / plan.site.gravity
    low, high = np.array(corners[:2])
    foot = high - ((high - low) @ up) * up
    eye.area([low, high, foot], palette.QUIET, 0.35, 0)
    eye.line([low, high, foot], True, color=palette.QUIET, linewidth=0.7, zorder=0.5)
    for f in np.arange(-1.0, _AHEAD, 0.25) * L:
        eye.line([(f, -_WIDE * L, 0), (f, _WIDE * L, 0)], color="white", linewidth=0.7, zorder=0.5)
    for r in np.arange(-0.75, _WIDE, 0.25) * L:
        eye.line([(_BACK * L, r, 0), (_AHEAD * L, r, 0)], color="white", linewidth=0.7, zorder=0.5)
    chassis, frame = plan.rover.chassis, plan.frame
    for face, theta in ((frame.start_face, 0.0), (frame.end_face, frame.turn)):
        spikes = frame.spike_positions(chassis.vertices, theta)[list(chassis.faces[face])]
        eye.line(spikes, True, color=palette.QUIET, linewidth=0.7, linestyle=(0, (1, 2)), zorder=1)


def _body(eye: Eye, step: Step, at: int) -> None:
    """Draw chassis and CMG at an instant of the run."""
    plan, run = step.plan, step.run
    frame, chassis, cmg = plan.frame, plan.rover.chassis, plan.rover.cmg
    turn = frame.rotation(float(run.theta[at]))
    spikes = frame.spike_positions(chassis.vertices, float(run.theta[at]))
    centre, blue = turn @ -frame.point, palette.colour(0)
    for edge in chassis.edges:
        eye.line(spikes[edge], color=blue, linewidth=0.5, zorder=2)
    for face in chassis.faces:
        points = spikes[list(face)]
        facing = _outward(points, centre) @ (eye.to_paper.T @ [0.0, 0.0, 1.0]) > 0
        eye.area(points, blue, 0.16, 6 if facing else 2)
        if facing:
            eye.line(points, True, color=blue, linewidth=1.5, zorder=6)
    eye.line(spikes[list(frame.spikes)], color=palette.colour(3), linewidth=3.5, zorder=5,
             solid_capstyle="butt")  # fmt: skip
    s, g, _ = cmg.axes(float(run.delta[at]))
    reach = _REACH * frame.length
    for name, axis, slot in (("g", turn @ g, 1), ("s", turn @ s, 2)):
        colour, tip = palette.colour(slot), centre + reach * axis
        back = centre - (reach if name == "g" else 0.5 * reach) * axis
        eye.line([back, tip], color=colour, linewidth=1.8, zorder=4)
        eye.text(centre + 1.2 * reach * axis, f"${name}$", colour)
    _rotor(eye, centre, turn @ s, turn @ g, 0.16 * frame.length)


def _rotor(eye: Eye, centre: np.ndarray, s: np.ndarray, g: np.ndarray, radius: float) -> None:
    turns = np.linspace(0.0, 2 * np.pi, 49)[:, None]
    rim = centre + radius * (np.cos(turns) * g + np.sin(turns) * np.cross(g, s))
    eye.area(rim, palette.colour(2), 0.3, 3)
    eye.line(rim, color=palette.colour(2), linewidth=0.9, zorder=4)


def _outward(points: np.ndarray, centre: np.ndarray) -> np.ndarray:
    normal: np.ndarray = np.cross(points[1] - points[0], points[2] - points[1])
    return normal if normal @ (points[0] - centre) > 0 else -normal
