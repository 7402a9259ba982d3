"""Planes of momentum space on paper: singular lines, radii, runs."""

from __future__ import annotations

from typing import Any

import numpy as np

from nullmotion.plot import style
from nullmotion.plot.atlas_looks import LOOKS
from nullmotion.plot.atlas_pieces import Pieces, cut
from nullmotion.plot.atlas_view import Scene
from nullmotion.plot.quantities import basis_names

LINE = 0.55  # width in points of a line that is 1 px wide on screen


def plane(axes: Any, scene: Scene, made: Pieces, axis: int) -> None:
    """Draw the cut across one torque axis, through the middle of the envelope."""
    a, b = (k for k in range(3) if k != axis)
    at = float(scene.middle[axis])
    found = cut(made, np.eye(3)[axis], at)
    for k, look in enumerate(LOOKS):
        ends = found.ends[found.kind == k][:, :, [a, b]]
        strokes(axes, ends, look.colour, LINE * look.width)
    names = basis_names(scene.array.torque_axes)
    _flat(axes, scene, a, b, f"Cut at h{names[axis]} = {at:.3g}")


def singular_lines(axes: Any, scene: Scene) -> None:
    """Draw the singular lines of an array with two torque dimensions."""
    for sheet in scene.sheets:
        for k, look in enumerate(LOOKS):
            ends = sheet.momentum[sheet.cells[sheet.kind[sheet.cells[:, 0]] == k]]
            strokes(axes, ends, look.colour, LINE * look.width)
    _flat(axes, scene, 0, 1, "Singular lines")


def _flat(axes: Any, scene: Scene, a: int, b: int, title: str) -> None:
    from matplotlib.patches import Circle

    for ball in scene.balls:
        dash = style.LINE_STYLES[ball.dash]
        at = (float(scene.middle[a]), float(scene.middle[b]))
        circle = Circle(at, ball.radius, fill=False, color=ball.colour, ls=dash, lw=1.1)
        axes.add_patch(circle)
    for motion in scene.motions:
        dash = style.LINE_STYLES[motion.dash]
        axes.plot(motion.momentum[:, a], motion.momentum[:, b], color=motion.colour, ls=dash)
    names, most = basis_names(scene.array.torque_axes), 1.06 * scene.radius
    axes.set(
        xlim=(-most, most), ylim=(-most, most), aspect="equal", title=title,
        xlabel=f"h{names[a]} [N m s]", ylabel=f"h{names[b]} [N m s]",
    )  # fmt: skip


def strokes(axes: Any, ends: np.ndarray, colour: str, width: float, **more: Any) -> None:
    """Draw pieces of lines, (k, 2, 2), as one path: a file holds it far smaller than k lines."""
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path

    if not len(ends):
        return
    codes = np.tile([Path.MOVETO, Path.LINETO], len(ends))
    path = Path(np.reshape(ends, (-1, 2)), codes)
    drawn = PathPatch(path, fill=False, ec=colour, lw=width, capstyle="round", snap=False, **more)
    axes.add_artist(drawn)  # not add_patch, which would look for limits piece by piece
    drawn.set_in_layout(False)
