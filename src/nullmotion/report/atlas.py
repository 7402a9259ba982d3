"""The singularity atlas as a part of a page: pictures that turn, and what steers them."""

from __future__ import annotations

from dataclasses import dataclass

from nullmotion.plot.atlas_maps import most_capability
from nullmotion.plot.atlas_view import Scene
from nullmotion.report import atlas_controls as controls
from nullmotion.report import atlas_figures as figures
from nullmotion.report import atlas_handles as handles
from nullmotion.report import page
from nullmotion.report.atlas_data import block
from nullmotion.report.charts import embedded
from nullmotion.report.markup import Markup, join, tag

SCRIPTS = (
    *("base", "flat", "mesh", "raster", "webgl", "state", "space", "array", "slice"),
    *("page", "time", "hand", "choose", "maps", "steer", "begin"),
)
_HELP = "Drag to turn, Ctrl and wheel to zoom; or focus a picture: arrow keys, + and −, Home."
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
            handles.clock(self.scene),
            tag("div", _pictures(self.scene), class_="views"),
            tag("div", handles.steering(), tag("p", _HELP, class_="note"), class_="steering"),
            _readings(),
            _controls(self.scene),
            _left_out(self.scene),
            id="atlas",
        )

    @property
    def has_maps(self) -> bool:
        """Whether there is torque to show in maps."""
        return self.scene is not None and most_capability(self.scene) > 0

    def maps(self, title: str = "Torque capability") -> Markup:
        """Return the section with the maps of torque capability; nothing without any."""
        if self.scene is None or not self.has_maps:
            return Markup("")
        return page.section(title, figures.maps(self.scene), id="torque")

    def extras(self) -> tuple[str, str]:
        """Return the part's style sheet, and its data and script, for `page.document`."""
        if self.scene is None:
            return "", ""
        data = embedded(block(self.scene, self.begin_at_end))
        code = "\n".join(page.asset(f"atlas_{name}.js") for name in SCRIPTS)
        script = (
            f'<script type="application/json" id="atlas-data">{data}</script>'
            f'<script>"use strict";\n(() => {{\n{code}}})();</script>'
        )
        return page.asset("atlas.css"), script


def _pictures(scene: Scene) -> Markup:
    return join(figures.space() if scene.array.m == 3 else figures.flat(False), figures.array())


def _controls(scene: Scene) -> Markup:
    solid = scene.array.m == 3
    left = [controls.kinds(scene), controls.sheets(scene), controls.spheres(scene)]
    left += [controls.plane(scene)] if solid else []
    right = [handles.gimbals(scene), handles.point(scene) if solid else ""]
    cut = figures.flat(True) if solid else ""
    return tag(
        "div",
        tag("div", tag("div", join(*left), class_="pair"), cut),
        tag("div", join(*right), class_="pile"),
        class_="views controls",
    )


def _left_out(scene: Scene) -> Markup:
    if not scene.left_out:
        return Markup("")
    words = f"{scene.left_out:,} sign patterns with more minus signs are not shown."
    return tag("p", words, class_="note")


def _readings() -> Markup:
    rows = [tag("div", tag("dt", name), tag("dd", "–", data_told=key)) for key, name in _READINGS]
    return tag("dl", join(*rows), class_="readings")
