"""Singular surfaces as a figure for papers: one view in perspective and three cuts."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np

from nullmotion.errors import InputError
from nullmotion.plot import style
from nullmotion.plot.atlas_looks import LOOKS, Look
from nullmotion.plot.atlas_perspective import perspective
from nullmotion.plot.atlas_pieces import Pieces, cut, pieces
from nullmotion.plot.atlas_view import Ball, Motion, Scene
from nullmotion.plot.draw import SUFFIXES
from nullmotion.plot.quantities import basis_names

MOST_POINTS = 120_000  # of all sheets of a scene for a figure
_LINE = 0.55  # width in points of a line that is 1 px wide on screen


def atlas_figure(scene: Scene, path: str | Path, title: str = "") -> Path:
    """Draw an array's singular surfaces: in perspective, and cut through the origin.

    Args:
        scene: What is drawn; radii as circles, motions as lines.
        path: File to write; its suffix says png, pdf or svg.
        title: Above all.

    Returns:
        The path.

    Raises:
        InputError: For another suffix.
    """
    target = Path(path)
    if target.suffix.lower() not in SUFFIXES:
        raise InputError("figure file", str(path), f"a name that ends in {', '.join(SUFFIXES)}")
    import matplotlib

    part = target.with_name(f".{target.stem}.{os.getpid()}.part{target.suffix}")
    with matplotlib.rc_context(style.rc()):
        try:
            _sheet(scene, title).savefig(part)
            os.replace(part, target)
        finally:
            part.unlink(missing_ok=True)
    return target


def _sheet(scene: Scene, title: str) -> Any:
    from matplotlib.figure import Figure

    solid, handles = scene.array.m == 3, _handles(scene)
    size = style.PANEL_WIDTH_IN * (2 if solid else 1.5)
    figure = Figure(figsize=(size, size + 0.35 + 0.17 * len(handles) / 2), layout="constrained")
    if solid:
        perspective(figure.add_subplot(2, 2, 1), scene)
        made = pieces(scene.sheets)
        for k, place in enumerate((2, 3, 4)):
            _plane(figure.add_subplot(2, 2, place), scene, made, k)
    else:
        _lines(figure.add_subplot(), scene)
    if title:
        figure.suptitle(title, fontsize=10, fontweight="bold", x=0.01, ha="left")
    figure.legend(handles=handles, loc="outside lower center", ncols=3 if solid else 2)
    return figure


def _handles(scene: Scene) -> list[Any]:
    from matplotlib.lines import Line2D

    found = np.unique(np.concatenate([sheet.kind for sheet in scene.sheets]))
    made = [
        Line2D([], [], color=look.colour, lw=_LINE * look.width + 0.4, label=_name(look))
        for k, look in enumerate(LOOKS)
        if k in found
    ]
    named: list[Ball | Motion] = [*scene.balls, *scene.motions]
    for item in named:
        dash = style.LINE_STYLES[item.dash]
        made.append(Line2D([], [], color=item.colour, ls=dash, lw=1.1, label=item.label))
    return made


def _name(look: Look) -> str:
    return f"{look.name} ({look.meaning})"


def _plane(axes: Any, scene: Scene, made: Pieces, axis: int) -> None:
    """Draw the cut across one torque axis, through the middle of the envelope."""
    from matplotlib.collections import LineCollection

    a, b = (k for k in range(3) if k != axis)
    at = float(scene.middle[axis])
    found = cut(made, np.eye(3)[axis], at)
    for k, look in enumerate(LOOKS):
        ends = found.ends[found.kind == k][:, :, [a, b]]
        width = _LINE * look.width
        lines = LineCollection(ends, colors=look.colour, linewidths=width, capstyle="round")
        axes.add_collection(lines)
    names = basis_names(scene.array.torque_axes)
    _flat(axes, scene, a, b, f"Cut at h{names[axis]} = {at:.3g}")


def _lines(axes: Any, scene: Scene) -> None:
    """Draw the singular lines of an array with two torque dimensions."""
    from matplotlib.collections import LineCollection

    for sheet in scene.sheets:
        for k, look in enumerate(LOOKS):
            ends = sheet.momentum[sheet.cells[sheet.kind[sheet.cells[:, 0]] == k]]
            width = _LINE * look.width
            axes.add_collection(LineCollection(ends, colors=look.colour, linewidths=width))
    _flat(axes, scene, 0, 1, "Singular lines")


def _flat(axes: Any, scene: Scene, a: int, b: int, title: str) -> None:
    from matplotlib.patches import Circle

    for ball in scene.balls:
        dash = style.LINE_STYLES[ball.dash]
        circle = Circle(
            scene.middle[[a, b]], ball.radius, fill=False, color=ball.colour, ls=dash, lw=1.1
        )
        axes.add_patch(circle)
    for motion in scene.motions:
        dash = style.LINE_STYLES[motion.dash]
        axes.plot(motion.momentum[:, a], motion.momentum[:, b], color=motion.colour, ls=dash)
    names, most = basis_names(scene.array.torque_axes), 1.06 * scene.radius
    axes.set(
        xlim=(-most, most), ylim=(-most, most), aspect="equal", title=title,
        xlabel=f"h{names[a]} [N m s]", ylabel=f"h{names[b]} [N m s]",
    )  # fmt: skip
