"""The controls beside an atlas: what is drawn, how it is cut, how the gimbals stand."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from nullmotion.plot.atlas_looks import LOOKS
from nullmotion.plot.atlas_view import FEW_SHEETS, Scene, sign_name
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


def kinds(scene: Scene) -> Markup:
    """Return toggles of the types of singular points that there are."""
    found = np.unique(np.concatenate([sheet.kind for sheet in scene.sheets]))
    boxes = [
        _box(look.name, look.meaning, data_kind=k, mark=_swatch(look.colour, look.stripes))
        for k, look in enumerate(LOOKS)
        if k in found
    ]
    return _group("Type of singular point", boxes)


def spheres(scene: Scene) -> Markup:
    """Return toggles of the radii."""
    boxes = [
        _box(ball.label, "", ball.shown, data_sphere=ball.key, mark=_ring(ball.colour))
        for ball in scene.balls
    ]
    return _group("Radii", boxes) if boxes else Markup("")


def sheets(scene: Scene) -> Markup:
    """Return toggles of the sign patterns, and of all with the same number of minus signs."""
    few = len(scene.sheets) <= FEW_SHEETS
    minus = [int(np.sum(sheet.signs < 0)) for sheet in scene.sheets]
    many = [
        _box(_count(k, minus.count(k)), "", few or k <= 1, data_minus=k) for k in sorted(set(minus))
    ]
    single = [
        _box(tag("code", sign_name(sheet.signs)), "", few or k <= 1, data_sheet=i, data_of=k)
        for i, (sheet, k) in enumerate(zip(scene.sheets, minus, strict=True))
    ]
    each = tag(
        "details",
        tag("summary", "Each pattern"),
        tag("div", join(*single), class_="boxes"),
        class_="plain",
    )
    return _group("Sign pattern", many, each)


def plane(scene: Scene) -> Markup:
    """Return the choice of a cutting plane and its place."""
    names = [("none", "No cut"), *((i, f"Across {name}") for i, name in enumerate("xyz"))]
    options = [tag("option", name, value=value) for value, name in names]
    options.append(tag("option", "As seen now", value="view"))
    return tag(
        "fieldset",
        tag("legend", "Cutting plane"),
        tag(
            "label",
            tag("span", "Plane"),
            tag("select", join(*options), id="atlas-plane", autocomplete="off"),
            class_="slide",
        ),
        _slider("At [N m s]", "atlas-offset", -100, 100, 1, 0, output="atlas-offset-text"),
    )


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
        _slider("u, azimuth", "atlas-azimuth", -180, 180, 1, 0, "0°"),
        _slider("u, elevation", "atlas-elevation", -90, 90, 1, 0, "0°"),
        tag("button", "Turn the gimbals there", id="atlas-visit", type="button"),
        tag("p", "Or click a surface.", class_="note", data_told="point", aria_live="polite"),
    )


def _group(title: str, boxes: Iterable[Markup], *more: Markup) -> Markup:
    inner = tag("div", join(*boxes), class_="boxes")
    return tag("fieldset", tag("legend", title), inner, *more)


def _box(
    name: object, note: str, checked: bool = True, mark: Markup | str = "", **data: object
) -> Markup:
    box = tag("input", type="checkbox", checked=checked, autocomplete="off", **data)
    return tag(
        "label", box, mark, tag("span", name, note and tag("small", f" {note}")), class_="box"
    )


def _slider(
    name: str, key: str, low: float, high: float, step: float, value: float,
    shown: str = "–", output: str | None = None,
) -> Markup:  # fmt: skip
    ends = {"min": low, "max": high, "step": step, "value": value}
    return tag(
        "label",
        tag("span", name),
        tag("input", type="range", id=key, autocomplete="off", **ends),
        tag("output", shown, id=output),
        class_="slide",
    )


def _count(minus: int, count: int) -> str:
    if minus == 0:
        return "all +"
    return f"{minus} minus ({count})" if count > 1 else f"{minus} minus"


def _swatch(colour: str, stripes: bool) -> Markup:
    lines = "".join(
        f'<path d="M{x} 12L{x + 6} 0" stroke="{colour}" stroke-width="2"/>' for x in (0, 6, 12)
    )
    return Markup(
        f'<svg width="18" height="12" aria-hidden="true"><rect width="18" height="12" '
        f'fill="{colour}" fill-opacity="{0.45 if stripes else 0.35}"/>{lines if stripes else ""}'
        f'<rect x=".5" y=".5" width="17" height="11" fill="none" stroke="{colour}"/></svg>'
    )


def _ring(colour: str) -> Markup:
    return Markup(
        f'<svg width="16" height="16" aria-hidden="true"><circle cx="8" cy="8" r="6" fill="none" '
        f'stroke="{colour}" stroke-width="2" stroke-dasharray="4 2"/></svg>'
    )
