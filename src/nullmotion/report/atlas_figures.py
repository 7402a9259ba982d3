"""The pictures of an atlas: canvases with a title, a note, and words for who does not see them."""

from __future__ import annotations

import numpy as np

from nullmotion.plot.atlas_looks import LOOKS
from nullmotion.plot.atlas_maps import Plane, map_title, most_capability, plane_of
from nullmotion.plot.atlas_view import Scene
from nullmotion.report.atlas_parts import bar, stroke
from nullmotion.report.markup import Markup, join, tag

_SCALES = (64, 48)  # what scales take of a map's width and height [px]
_TALL = 1.5
_ARRAY_NOTE = (
    "Gimbal axes (grey), rotor momenta (coloured) and their sum (black, smaller scale); places "
    "are schematic."
)
_MAPS_NOTE = (
    "Largest torque that is there in every direction, best of all gimbal angles with that "
    "momentum; hatched: momentum that cannot be reached. Point at a place for its value; click it, "
    "or focus a map, move with the arrow keys (Shift: faster) and press Enter, to turn the gimbals "
    "there."
)


def space() -> Markup:
    """Return momentum space with its surfaces."""
    view = _canvases(
        3,
        id="atlas-space",
        class_="view3d",
        tabindex="0",
        role="application",
        aria_label="Singular surfaces in momentum space. Arrow keys turn, plus and minus zoom.",
    )
    return figure("Momentum space", "Singular surfaces, momentum in N m s, in body axes.", view)


def array() -> Markup:
    """Return the array."""
    view = _canvases(
        1,
        id="atlas-array",
        class_="view3d",
        tabindex="0",
        role="application",
        aria_label="The array: gimbal axes, rotor momenta. Arrow keys turn, plus and minus zoom.",
    )
    return figure("Array", _ARRAY_NOTE, view)


def flat(solid: bool) -> Markup:
    """Return a plane of momentum space: the cut, or all there is of two torque dimensions."""
    note = "Where the plane meets the surfaces." if solid else "Singular lines, momentum in N m s."
    words = "Cut through momentum space" if solid else "Singular lines in momentum space"
    view = _canvases(1, id="atlas-slice", class_="view2d", role="img", aria_label=words)
    return figure("Cut" if solid else "Momentum space", note, view, "flat")


def maps(scene: Scene) -> Markup:
    """Return the maps of torque capability, their scale, and what their lines are."""
    made = []
    for place, shown in enumerate(scene.maps):
        key, title = f"map-{place}", map_title(scene, shown)
        words = f"Torque capability, {title}. Arrow keys move, Enter turns the gimbals there."
        view = _canvases(
            2, data_map=key, class_="view2d map", tabindex="0", role="application",
            aria_label=words, style=f"aspect-ratio: {_aspect(plane_of(shown)):.3f}",
        )  # fmt: skip
        value = tag("p", "", class_="told", data_map_told=key, aria_live="polite")
        made.append(tag("figure", tag("figcaption", tag("h3", title)), view, value))
    methods = ", ".join(dict.fromkeys(shown.method for shown in scene.maps))
    scale = bar(0.0, most_capability(scene), f"Torque capability [N m]; {methods}")
    return join(
        tag("p", _MAPS_NOTE, class_="note"),
        tag("div", join(*made), class_="maps"),
        tag("div", scale, _lines(scene), class_="maplegend"),
    )


def _aspect(where: Plane) -> float:
    """Return width over height of a picture of a map, with its scales, when 400 px wide."""
    x, y = float(np.ptp(where.x)), float(np.ptp(where.y))
    return 400 / (_SCALES[1] + (400 - _SCALES[0]) * min(y / x, _TALL)) if x > 0 else 1.0


def _lines(scene: Scene) -> Markup:
    """Return what the lines over a map are."""
    found = np.unique(np.concatenate([sheet.kind for sheet in scene.every]))
    entries = [
        tag("span", stroke(look.colour, look.width), look.name, class_="box")
        for k, look in enumerate(LOOKS)
        if k in found
    ]
    return tag("p", "Singular lines, as switched on above: ", join(*entries), class_="note")


def figure(title: str, note: str, view: Markup, kind: str = "turning") -> Markup:
    """Return a picture under its title."""
    head = tag("figcaption", tag("h3", title), tag("p", note))
    return tag("figure", head, view, class_=f"view {kind}")


def _canvases(count: int, **attributes: object) -> Markup:
    layers = [tag("canvas", aria_hidden="true") for _ in range(count)]
    return tag("div", join(*layers), **attributes)
