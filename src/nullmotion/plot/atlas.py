"""Singular surfaces as a figure for papers: one view in perspective and three cuts."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np

from nullmotion.errors import InputError
from nullmotion.plot import style
from nullmotion.plot.atlas_flat import LINE, plane, singular_lines
from nullmotion.plot.atlas_looks import LOOKS, Look
from nullmotion.plot.atlas_maps import map_panel, most_capability
from nullmotion.plot.atlas_perspective import perspective
from nullmotion.plot.atlas_pieces import Pieces, pieces
from nullmotion.plot.atlas_view import Ball, Motion, Scene
from nullmotion.plot.draw import SUFFIXES

MOST_POINTS = 120_000  # of all sheets of a scene for a figure
_WIDTH = 2 * style.PANEL_WIDTH_IN
_LONG = 45  # characters of a legend's entry that leave room for two columns only
_MAPS = 2.3  # height of a row of maps [in]


def atlas_figure(scene: Scene, path: str | Path, title: str = "") -> Path:
    """Draw an array's singular surfaces: in perspective, and cut through the middle; torque maps.

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
    shown = scene.maps if most_capability(scene) > 0 else ()
    columns = 3 if solid and max(len(h.get_label()) for h in handles) < _LONG else 2
    legend = 0.2 + 0.16 * -(-len(handles) // columns)
    figure = Figure(figsize=(_WIDTH, _height(solid, len(shown)) + legend), layout="constrained")
    made = pieces(scene.every) if solid else None
    below = _planes(figure, scene, made, len(shown)) if made else _flat_pair(figure, scene, shown)
    if shown:
        drawn = [map_panel(a, scene, s, made) for a, s in zip(below, shown, strict=True)]
        label = "Torque capability [N m]"
        figure.colorbar(drawn[0], ax=below, label=label, aspect=20, shrink=0.8)
    if title:
        figure.suptitle(title, fontsize=10, fontweight="bold", x=0.01, ha="left")
    figure.legend(handles=handles, loc="outside lower center", ncols=columns)
    return figure


def _height(solid: bool, maps: int) -> float:
    """Return the height of the panels [in]: two rows of two, one of maps, or one row alone."""
    if not solid:
        return _WIDTH / 2 if maps else 0.75 * _WIDTH
    return _WIDTH + (_MAPS if maps else 0.0)


def _planes(figure: Any, scene: Scene, made: Pieces, maps: int) -> list[Any]:
    """Draw a view and three cuts; return the places for maps below."""
    ratios = (_WIDTH, _MAPS)[: 2 if maps else 1]
    rows = figure.add_gridspec(len(ratios), 1, height_ratios=ratios)
    above = rows[0].subgridspec(2, 2)
    perspective(figure.add_subplot(above[0, 0]), scene)
    for axis, place in enumerate((above[0, 1], above[1, 0], above[1, 1])):
        plane(figure.add_subplot(place), scene, made, axis)
    below = rows[1].subgridspec(1, maps) if maps else ()
    return [figure.add_subplot(place) for place in below]


def _flat_pair(figure: Any, scene: Scene, shown: tuple[Any, ...]) -> list[Any]:
    """Draw the singular lines of two torque dimensions; return the places for maps beside."""
    first, *others = figure.subplots(1, 1 + len(shown), squeeze=False)[0]
    singular_lines(first, scene)
    return list(others)


def _handles(scene: Scene) -> list[Any]:
    from matplotlib.lines import Line2D

    found = np.unique(np.concatenate([sheet.kind for sheet in scene.every]))
    made = [
        Line2D([], [], color=look.colour, lw=LINE * look.width + 0.4, label=_name(look))
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
