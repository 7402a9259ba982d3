"""The singularity atlas as a part of a page: pictures that turn, and what steers them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from importlib.resources import files

from nullmotion.plot.atlas_view import Scene
from nullmotion.report import atlas_controls as controls
from nullmotion.report import page
from nullmotion.report.atlas_data import block
from nullmotion.report.charts import embedded
from nullmotion.report.markup import Markup, join, tag

SCRIPTS = ("base", "mesh", "raster", "webgl", "state", "space", "array", "slice", "page", "steer")
_HELP = "Drag to turn, Ctrl and wheel to zoom; or focus a picture: arrow keys, + and −, Home."
_ARRAY_NOTE = (
    "Gimbal axes (grey), rotor momenta (coloured) and their sum (black, smaller scale); places "
    "are schematic."
)
_READINGS = (
    ("source", "Shown"),
    ("momentum", "Momentum h"),
    ("size", "|h|"),
    ("sigma", "sigma_min"),
    ("angles", "Gimbal angles [deg]"),
)


@dataclass(frozen=True)
class Atlas:
    """The part of a page that shows a scene: one in each page.

    Args:
        scene: What is shown; None leaves the part away.
        begin_at_end: Whether a run is first shown as it ended.
    """

    scene: Scene | None
    begin_at_end: bool = False

    def section(self, title: str = "Momentum space and array") -> Markup:
        """Return the section with both pictures and their controls."""
        if self.scene is None:
            return Markup("")
        return page.section(
            title,
            controls.clock(self.scene),
            tag("div", _pictures(self.scene), class_="views"),
            tag("div", controls.steering(), tag("p", _HELP, class_="note"), class_="steering"),
            _readings(),
            _controls(self.scene),
            _left_out(self.scene),
            id="atlas",
        )

    def extras(self) -> tuple[str, str]:
        """Return the part's style sheet, and its data and script, for `page.document`."""
        if self.scene is None:
            return "", ""
        data = embedded(block(self.scene, self.begin_at_end))
        code = "\n".join(_asset(f"atlas_{name}.js") for name in SCRIPTS)
        script = (
            f'<script type="application/json" id="atlas-data">{data}</script>'
            f'<script>"use strict";\n(() => {{\n{code}}})();</script>'
        )
        return _asset("atlas.css"), script


def _pictures(scene: Scene) -> Markup:
    return join(_space() if scene.array.m == 3 else _slice(False), _array())


def _controls(scene: Scene) -> Markup:
    solid = scene.array.m == 3
    left = [controls.kinds(scene), controls.spheres(scene), controls.sheets(scene)]
    left += [controls.plane(scene)] if solid else []
    right = [controls.gimbals(scene), controls.point(scene) if solid else ""]
    return tag(
        "div",
        tag("div", tag("div", join(*left), class_="pair"), _slice(True) if solid else ""),
        tag("div", join(*right), class_="pile"),
        class_="views controls",
    )


def _left_out(scene: Scene) -> Markup:
    if not scene.left_out:
        return Markup("")
    words = f"{scene.left_out:,} sign patterns with more minus signs are not shown."
    return tag("p", words, class_="note")


def _space() -> Markup:
    layers = [tag("canvas", aria_hidden="true") for _ in range(3)]
    view = tag(
        "div",
        join(*layers),
        id="atlas-space",
        class_="view3d",
        tabindex="0",
        role="application",
        aria_label="Singular surfaces in momentum space. Arrow keys turn, plus and minus zoom.",
    )
    return _figure("Momentum space", "Singular surfaces, momentum in N m s, in body axes.", view)


def _array() -> Markup:
    view = tag(
        "div",
        tag("canvas", aria_hidden="true"),
        id="atlas-array",
        class_="view3d",
        tabindex="0",
        role="application",
        aria_label="The array: gimbal axes, rotor momenta. Arrow keys turn, plus and minus zoom.",
    )
    return _figure("Array", _ARRAY_NOTE, view)


def _slice(solid: bool) -> Markup:
    note = "Where the plane meets the surfaces." if solid else "Singular lines, momentum in N m s."
    view = tag(
        "div",
        tag("canvas", aria_hidden="true"),
        id="atlas-slice",
        class_="view2d",
        role="img",
        aria_label="Cut through momentum space" if solid else "Singular lines in momentum space",
    )
    return _figure("Cut" if solid else "Momentum space", note, view, "flat")


def _figure(title: str, note: str, view: Markup, kind: str = "turning") -> Markup:
    head = tag("figcaption", tag("h3", title), tag("p", note))
    return tag("figure", head, view, class_=f"view {kind}")


def _readings() -> Markup:
    rows = [tag("div", tag("dt", name), tag("dd", "–", data_told=key)) for key, name in _READINGS]
    return tag("dl", join(*rows), class_="readings")


@cache
def _asset(name: str) -> str:
    return files("nullmotion.report").joinpath("assets", name).read_text(encoding="utf-8")
