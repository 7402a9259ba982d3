"""Singular surfaces seen from one side, drawn far ones first."""

from __future__ import annotations

from typing import Any

import numpy as np

from nullmotion.atlas import surfaces
from nullmotion.plot import palette, style
from nullmotion.plot.atlas_looks import LOOKS
from nullmotion.plot.atlas_pieces import Pieces, pieces
from nullmotion.plot.atlas_view import Scene
from nullmotion.plot.quantities import basis_names

_POINTS = 24_000  # of all sheets
_FINEST = 4000  # directions
_AZIMUTH, _ELEVATION = np.radians([-55.0, 24.0])
_LIGHT = np.array([0.35, 0.55, 0.75])  # to the right, up, towards the eye
_AXIS = 1.08  # length of an axis over the size of the picture


def perspective(axes: Any, scene: Scene) -> None:
    """Draw a scene with three torque dimensions into flat axes, in parallel perspective."""
    from matplotlib.collections import PolyCollection

    signs = np.array([sheet.signs for sheet in scene.sheets])
    count = int(np.clip(_POINTS // len(signs), 200, _FINEST))
    made = pieces((*surfaces(scene.array, count, signs), *scene.flats))
    view = _view()
    order = np.argsort((made.corner @ view[2]).mean(axis=1))
    areas = PolyCollection(made.corner[order] @ view[:2].T, facecolors=_colours(made, view)[order])
    areas.set(linewidth=0, rasterized=True)  # areas would fill megabytes
    _frame(axes, scene, view)
    axes.add_collection(areas)
    for motion in scene.motions:
        dash = style.LINE_STYLES[motion.dash]
        axes.plot(*(motion.momentum @ view[:2].T).T, color=motion.colour, ls=dash)
    axes.set_title("Singular surfaces")


def _frame(axes: Any, scene: Scene, view: np.ndarray) -> None:
    """Draw the axes of momentum space, nothing of the sheet of paper's."""
    end = _AXIS * scene.radius
    for name, tip in zip(basis_names(scene.array.torque_axes), view[:2].T * end, strict=True):
        axes.plot([-tip[0], tip[0]], [-tip[1], tip[1]], color=palette.QUIET, lw=0.7, zorder=0)
        axes.annotate(f"h{name}", tip, xytext=tip * 1.06, ha="center", va="center", fontsize=8)
    axes.set(xlim=(-1.05 * end, 1.05 * end), ylim=(-1.05 * end, 1.05 * end), aspect="equal")
    axes.set_axis_off()


def _view() -> np.ndarray:
    """Return the directions to the right, up and towards the eye as rows."""
    ca, sa, ce, se = np.cos(_AZIMUTH), np.sin(_AZIMUTH), np.cos(_ELEVATION), np.sin(_ELEVATION)
    return np.array([[-sa, ca, 0], [-se * ca, -se * sa, ce], [ce * ca, ce * sa, se]])


def _colours(made: Pieces, view: np.ndarray) -> np.ndarray:
    facing = made.normal @ view[2]
    lit = 0.7 + 0.3 * np.sign(facing) * (made.normal @ (_LIGHT / np.linalg.norm(_LIGHT) @ view))
    paint = np.array([_paint(look.colour, look.alpha) for look in LOOKS])[made.kind]
    rim = np.array([look.rim for look in LOOKS])[made.kind]
    paint[:, :3] *= np.clip(lit, 0, 1)[:, None]
    paint[:, 3] += (1 - paint[:, 3]) * rim * (1 - np.abs(facing)) ** 3
    return np.clip(paint, 0, 1)


def _paint(colour: str, alpha: float) -> tuple[float, ...]:
    return (*(int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)), alpha)
