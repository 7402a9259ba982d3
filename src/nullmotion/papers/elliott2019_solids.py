"""Figures 22 to 25 of Elliott 2019: bodies and paths in momentum space."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import Any

import numpy as np

from nullmotion import ops
from nullmotion.guarantee.evaluate import capability
from nullmotion.papers.elliott2019_camera import WIDTH, Body, Camera, View
from nullmotion.papers.elliott2019_courses import Course
from nullmotion.papers.elliott2019_spheres import Box90
from nullmotion.plot import palette

CAMERAS = (Camera(np.radians(20.0), np.radians(-60.0)), Camera(np.radians(20.0), np.radians(25.0)))
_LIGHT = np.array([-0.45, 0.55, 0.70])  # in the camera's axes
_ARROW = 2.55  # where the arrows of the axes end [h]


def body(box90: Box90, level: float) -> Body:
    """Return where TC is above a level within |h_x| = 2; the envelope for 0."""
    if not level:
        return Body(box90.room_source)

    def source(h: Any) -> Any:
        above = capability(box90.constraint, h) - level
        return ops.minimum(above, 2.0 - ops.absolute(h[0]))

    return Body(source)


def restricted(h: Any) -> Any:
    """Return what is positive within the restricted envelope of Figure 19; source."""
    y, z = (ops.sqrt(ops.maximum(4.0 - c * c, 0.0)) for c in h[1:])
    within = ops.minimum(y + z, 2.0) - ops.absolute(h[0])
    return ops.minimum(within, 2.0 - ops.maximum(ops.absolute(h[1]), ops.absolute(h[2])))


@lru_cache(maxsize=1)
def shadows() -> list[np.ndarray]:
    """Return where each camera sees the restricted envelope, (pixels, pixels)."""
    envelope = Body(restricted)
    return [np.isfinite(envelope.seen(camera).depth) for camera in CAMERAS]


def outlines() -> list[np.ndarray]:
    """Return the edges of the restricted envelope, each (k, 3).

    It is |h_x| <= 2 and |h_x| <= sqrt(4 - h_y^2) + sqrt(4 - h_z^2): it has flat ends on all
    six sides of the cube, four of them discs.
    """
    turn = np.linspace(0.0, 2 * np.pi, 361)
    c, s, two = 2 * np.cos(turn), 2 * np.sin(turn), np.full(361, 2.0)
    # sqrt(4 - y^2) + sqrt(4 - z^2) = 2 holds at y = 2 sin a, z = 2 sin b, cos a + cos b = 1
    a = np.linspace(0.0, 0.5 * np.pi, 91)
    y, z = 2 * np.sin(a), 2 * np.sin(np.arccos(1.0 - np.cos(a)))
    ring = np.concatenate([[y, z], [y[::-1], -z[::-1]], [-y, -z], [-y[::-1], z[::-1]]], axis=1)
    width = np.full(ring.shape[1], 2.0)
    edges = [[c, two, s], [c, s, two], [width, *ring]]
    return [np.stack(e, axis=1) * flip for e in edges for flip in (1.0, -1.0)]


def draw_body(figure: Any, shown: Body) -> None:
    """Draw a body inside the restricted envelope from two sides."""
    for axes, camera in _spaces(figure):
        view = shown.seen(camera)
        _picture(axes, _shaded(view))
        for edge in outlines():
            _line(axes, camera, edge, view)
        _arrows(axes, camera, view)


def draw_paths(figure: Any, courses: Sequence[Course]) -> None:
    """Draw trajectories inside the restricted envelope from two sides."""
    for axes, camera in _spaces(figure):
        for edge in outlines():
            _line(axes, camera, edge)
        _arrows(axes, camera)
        for i, course in enumerate(courses):
            line = camera.axes @ np.concatenate([np.zeros((1, 3)), course.waypoints]).T
            axes.plot(*line[:2], color=palette.colour(i), linewidth=0.6)
            axes.plot(*line[:2, 1:3], "o", color=palette.colour(i), markersize=1.8)


def _spaces(figure: Any) -> list[tuple[Any, Camera]]:
    """Return axes with the restricted envelope's shadow, one for each camera."""
    from matplotlib.colors import to_rgb

    made = []
    panes = figure.subplots(1, len(CAMERAS))
    for axes, camera, seen in zip(panes, CAMERAS, shadows(), strict=True):
        axes.set_axis_off()
        axes.set(aspect="equal", xlim=(-WIDTH, WIDTH), ylim=(-WIDTH, WIDTH))
        shadow = np.broadcast_to(to_rgb(palette.GRID), (*seen.shape, 3))
        _picture(axes, np.concatenate([shadow, seen[..., None]], axis=-1))
        made.append((axes, camera))
    return made


def _picture(axes: Any, colours: np.ndarray) -> None:
    extent = (-WIDTH, WIDTH, -WIDTH, WIDTH)
    axes.imshow(colours, origin="lower", extent=extent, interpolation="bilinear")


def _arrows(axes: Any, camera: Camera, view: View | None = None) -> None:
    """Draw the axes beyond the envelope, faintly where they are behind the body."""
    for name, unit in zip("xyz", np.eye(3), strict=True):
        start, end, text = (camera.axes[:2] @ (unit * x) for x in (2.0, _ARROW, _ARROW + 0.2))
        opacity = 0.3 if view and view.hidden(_ARROW * unit[None])[0] else 1.0
        stroke = {"arrowstyle": "-|>", "color": palette.INK, "linewidth": 0.9, "alpha": opacity}
        axes.annotate("", end, start, arrowprops={**stroke, "shrinkA": 0, "shrinkB": 0})
        words = {"ha": "center", "va": "center", "fontsize": 8, "color": palette.INK}
        axes.text(*text, f"$H_{name}$", alpha=opacity, **words)


def _line(axes: Any, camera: Camera, points: np.ndarray, view: View | None = None) -> None:
    """Draw a line, faintly where it is behind the body."""
    x, y = camera.axes[:2] @ points.T
    hidden = view.hidden(points) if view else np.zeros(len(points), bool)
    for where, opacity in ((hidden, 0.18), (~hidden, 0.9)):
        shown = np.where(where, y, np.nan)
        axes.plot(x, shown, color=palette.QUIET, linewidth=0.7, alpha=opacity)


def _shaded(view: View) -> np.ndarray:
    """Return a picture, (pixels, pixels, 4), by how the surface faces the light."""
    from matplotlib.colors import to_rgb

    facing = 0.5 + 0.5 * (view.normal @ (_LIGHT / np.linalg.norm(_LIGHT)))
    base, seen = np.array(to_rgb(palette.colour(0))), np.isfinite(view.depth)
    share = np.nan_to_num(0.9 * facing**2)[..., None]
    return np.concatenate([base + (1.0 - base) * share, seen[..., None]], axis=-1)
