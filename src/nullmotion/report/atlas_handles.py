"""What moves an atlas: time, view, gimbal angles, the way to a singular point."""

from __future__ import annotations

import numpy as np

from nullmotion.plot.atlas_signs import sign_name
from nullmotion.plot.atlas_view import Scene
from nullmotion.report.atlas_parts import slider
from nullmotion.report.markup import Markup, join, tag

_STEERING = (
    ("left", "◀", "Turn left"),
    ("right", "▶", "Turn right"),
    ("up", "▲", "Tilt up"),
    ("down", "▼", "Tilt down"),
    ("closer", "+", "Closer"),
    ("farther", "−", "Farther"),
)


def clock(scene: Scene) -> Markup:
    """Return the time slider that turns array and momentum; nothing without a motion."""
    if not scene.motions:
        return Markup("")
    options = [tag("option", m.label, value=i) for i, m in enumerate(scene.motions)]
    which = tag("select", join(*options), id="atlas-motion", aria_label="Run whose gimbals turn")
    return tag(
        "div",
        tag("label", "Time ", tag("output", "", id="atlas-clock"), for_="atlas-time"),
        tag("input", type="range", id="atlas-time", min=0, max=1000, value=0, step=1),
        tag("button", "Play", id="atlas-play", type="button"),
        which if len(options) > 1 else "",
        class_="toolbar",
    )


def steering() -> Markup:
    """Return buttons that turn both pictures."""
    buttons = [
        tag("button", sign, type="button", data_steer=key, aria_label=name, title=name)
        for key, sign, name in _STEERING
    ]
    reset = tag("button", "Reset view", type="button", data_steer="reset")
    return tag("div", join(*buttons), reset, class_="steer", role="group", aria_label="View")


def gimbals(scene: Scene) -> Markup:
    """Return a slider for each gimbal angle."""
    limits = np.degrees(np.asarray(scene.array.angle_limits, float))
    rows = []
    for i, (low, high) in enumerate(limits):
        ends = {"min": max(float(low), -180.0), "max": min(float(high), 180.0)}
        rows.append(
            tag(
                "label",
                tag("span", f"CMG {i + 1}"),
                tag("input", type="range", step=0.1, value=0, data_gimbal=i, **ends),
                tag("output", ""),
                class_="slide",
            )
        )
    return tag("fieldset", tag("legend", "Gimbal angles"), join(*rows))


def point(scene: Scene) -> Markup:
    """Return the choice of a singular point by signs and direction."""
    options = [
        tag("option", sign_name(sheet.signs), value=i) for i, sheet in enumerate(scene.sheets)
    ]
    chosen = tag(
        "label",
        tag("span", "Signs"),
        tag("select", join(*options), id="atlas-sheet", class_="mono"),
        class_="slide",
    )
    return tag(
        "fieldset",
        tag("legend", "Go to a singular point"),
        chosen,
        slider("u, azimuth", "atlas-azimuth", -180, 180, 1, 0, "0°"),
        slider("u, elevation", "atlas-elevation", -90, 90, 1, 0, "0°"),
        tag("button", "Turn the gimbals there", id="atlas-visit", type="button"),
        tag("p", "Or click a surface.", class_="note", data_told="point", aria_live="polite"),
    )
