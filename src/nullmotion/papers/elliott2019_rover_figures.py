"""Figures 34 to 36 of Elliott 2019: steps up an incline; dashed the plan, solid the result."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from nullmotion.papers.elliott2019_figures import save
from nullmotion.papers.elliott2019_rover_picture import picture
from nullmotion.papers.elliott2019_rover_steps import Step, Steps
from nullmotion.papers.elliott2019_rover_wheels import INCLINES
from nullmotion.plot import palette, style
from nullmotion.rover import step_dynamics as dynamics
from nullmotion.rover.step_model import step_model
from nullmotion.rover.step_plan import StepPlan
from nullmotion.rover.step_run import StepRun

FIGURES = {35: 1, 36: 2}  # number: edge
COUNT = 1 + 2 * len(FIGURES)
_PICTURED = (1, "30")
_MOTION, _TORQUES = 8.2, 8.8  # heights [in]
_GOOD = {"solid": 1.3, "dash": 1.0}

_PLACE = {"left": 0.09, "right": 0.99, "bottom": 0.08, "top": 0.935, "wspace": 0.32, "hspace": 0.3}

Source = StepPlan | StepRun


def draw(folder: Path, found: Steps) -> Iterator[Path]:
    """Draw all figures, one after another."""
    folder.mkdir(parents=True, exist_ok=True)
    step = found[_PICTURED]
    title = f"Figure 34: a step over e{step.edge} up {step.row} deg"
    yield save(folder / "figure_34.png", 5.2, title, partial(picture, step=step))
    for number, edge in FIGURES.items():
        chosen = [found[edge, row] for row in INCLINES]
        name = f"Figure {number}: steps over e{edge}"
        path = folder / f"figure_{number}.png"
        yield save(path, _MOTION, f"{name}; dashed: planned", partial(motion, steps=chosen))
        path = folder / f"figure_{number}_torques.png"
        title = f"{name}: torques and thresholds; dashed: planned"
        yield save(path, _TORQUES, title, partial(torques, steps=chosen))


def motion(figure: Any, steps: Sequence[Step]) -> None:
    """Angle and rate of the body, angle and rate of the gimbal; one row an incline."""
    columns: tuple[tuple[str, Callable[[Source], np.ndarray]], ...] = (
        ("Body angle [deg]", lambda s: s.theta),
        ("Body rate [deg/s]", lambda s: s.theta_dot),
        ("Gimbal angle [deg]", lambda s: s.delta),
        ("Gimbal rate [deg/s]", lambda s: s.delta_dot),
    )
    panes = _grid(figure, steps, [name for name, _ in columns])
    limit = np.degrees(steps[0].plan.rover.cmg.rate_limit)
    for row, step in zip(panes, steps, strict=True):
        for axes, (_, read) in zip(row, columns, strict=True):
            for source in (step.run, step.plan):
                _curve(axes, source, np.degrees(read(source)), palette.colour(0))
        for value in (-limit, limit):
            row[3].axhline(value, color=palette.QUIET, linewidth=0.8, linestyle=(0, (2, 2)))
    panes[0][3].annotate("limit", (0, limit), (2, 2), textcoords="offset points", fontsize=6.5)


def torques(figure: Any, steps: Sequence[Step]) -> None:
    """Torque about the edge; off-axis torque between the dynamic thresholds."""
    heads = ["Torque about the edge [N m]", "Off-axis torque [N m]"]
    panes = _grid(figure, steps, heads)
    blue, orange, green = (palette.colour(i) for i in range(3))
    for row, step in zip(panes, steps, strict=True):
        for source in (step.run, step.plan):
            _, driven, holding, off, low, high = signals(source)
            _curve(row[0], source, driven, blue, "CMG, $-T \\cdot r$")
            _curve(row[1], source, off, blue, r"$\tau_{off}$")
            _curve(row[1], source, high, orange, r"$\tau_{DTa}$")
            _curve(row[1], source, low, green, r"$\tau_{DTb}$")
            if isinstance(source, StepPlan):
                look = {"color": palette.INK, "linewidth": 0.9, "linestyle": (0, (1, 1.6))}
                row[0].plot(source.t, holding, label="holds the weight", **look)
    named: dict[str, Any] = {}  # legend of both columns
    for axes in panes[0]:
        for handle, name in zip(*axes.get_legend_handles_labels(), strict=True):
            named.setdefault(name, handle)
    figure.legend(named.values(), named.keys(), loc="lower center", ncols=len(named))


def signals(source: Source) -> tuple[np.ndarray, ...]:
    """Return times, -T . r, the torque that holds the weight, tau_off, tau_DTb, tau_DTa [N m].

    Thresholds are those of a body on its edge: there are none while it lies on its face.
    """
    plan = source if isinstance(source, StepPlan) else source.plan
    model = step_model(plan.rover, plan.frame, plan.site)
    state = dynamics.State(
        source.theta, source.theta_dot, source.delta, source.delta_dot, source.delta_ddot
    )
    T = dynamics.cmg_torque(model, state, source.theta_ddot)
    driven = -dynamics.dot(T, dynamics.along(model, source.delta, 1))
    bounds = dynamics.thresholds(model, state, source.theta_ddot)
    turning = source.turning if isinstance(source, StepRun) else np.ones(source.t.shape, bool)
    off, low, high = (
        np.where(turning, values, np.nan)
        for values in (bounds.tau_off, bounds.tau_DTb, bounds.tau_DTa)
    )
    holding = -dynamics.gravity_torque(model, source.theta)
    return source.t, driven, holding, off, low, high


def _curve(axes: Any, source: Source, values: np.ndarray, colour: str, label: str = "") -> None:
    """Draw a curve: solid for a run; a plan's is dark, dashed and on top."""
    if isinstance(source, StepPlan):
        colour, dash, label = palette.INK, "dash", ""
    else:
        dash = "solid"
    line = {"color": colour, "linestyle": style.LINE_STYLES[dash], "linewidth": _GOOD[dash]}
    axes.plot(source.t, values, label=label or "_", **line)


def _grid(figure: Any, steps: Sequence[Step], heads: Sequence[str]) -> Any:
    """Return axes, one row a step: columns share their ordinate, rows their time."""
    figure.set_layout_engine("none")  # a grid by hand takes half the time
    panes = figure.subplots(
        len(steps), len(heads), sharey="col", sharex="row", squeeze=False, gridspec_kw=_PLACE
    )
    for row, step in zip(panes, steps, strict=True):
        row[0].set_ylabel(f"Φ = {step.row} deg", fontweight="bold")
        for axes in row:
            axes.margins(x=0.01, y=0.08)
    for axes, head in zip(panes[0], heads, strict=True):
        axes.set_title(head)
    for axes in panes[-1]:
        axes.set_xlabel("Time [s]")
    return panes
