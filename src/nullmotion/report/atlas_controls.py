"""The controls beside an atlas: what is drawn, in which colours, how it is cut."""

from __future__ import annotations

from collections import Counter

import numpy as np

from nullmotion.plot.atlas_looks import LOOKS
from nullmotion.plot.atlas_signs import minus, sign_name
from nullmotion.plot.atlas_torque import span, torque_left
from nullmotion.plot.atlas_view import FEW_SHEETS, Scene
from nullmotion.report.atlas_parts import bar, group, ring, slider, swatch, toggle
from nullmotion.report.markup import Markup, join, tag


def kinds(scene: Scene) -> Markup:
    """Return toggles of the types of singular points that there are."""
    found = np.unique(np.concatenate([sheet.kind for sheet in scene.every]))
    boxes = [
        toggle(look.name, look.meaning, data_kind=k, mark=swatch(look.colour, look.stripes))
        for k, look in enumerate(LOOKS)
        if k in found
    ]
    return group("Type of singular point", boxes, _colour(scene))


def _colour(scene: Scene) -> Markup:
    """Return the choice between colours by type and by torque, and the scale of the latter."""
    left = torque_left(scene)
    if not left:
        return Markup("")
    options = [tag("option", "Type", value="type"), tag("option", "Torque left", value="left")]
    select = tag("select", join(*options), id="atlas-colour", autocomplete="off")
    choice = tag("label", tag("span", "Colour"), select, class_="slide")
    words = (
        "Second smallest singular value of A over mean momentum; at 0, torque along a line only."
    )
    shown = bar(*span(left), words, id="atlas-scale", hidden=True)
    return join(choice, shown)


def spheres(scene: Scene) -> Markup:
    """Return toggles of the radii."""
    boxes = [
        toggle(ball.label, "", ball.shown, data_sphere=ball.key, mark=ring(ball))
        for ball in scene.balls
    ]
    return group("Radii", boxes) if boxes else Markup("")


def sheets(scene: Scene) -> Markup:
    """Return toggles of the sign patterns, and of all with the same number of minus signs."""
    few, each_minus = len(scene.sheets) <= FEW_SHEETS, [minus(s.signs) for s in scene.every]
    counts = Counter(each_minus[: len(scene.sheets)])
    many = [toggle(_count(k, counts[k]), "", few or k <= 1, data_minus=k) for k in sorted(counts)]
    single = [
        toggle(tag("code", sign_name(sheet.signs)), "", few or k <= 1, data_sheet=i, data_of=k)
        for i, (sheet, k) in enumerate(zip(scene.every, each_minus, strict=True))
    ]
    free = tag("p", "○: at any angle, u along its gimbal axis", class_="note")
    each = tag(
        "details",
        tag("summary", "Each pattern"),
        tag("div", join(*single), class_="boxes"),
        free if scene.flats else "",
        class_="plain",
    )
    return group("Sign pattern", many, each)


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
        slider("At [N m s]", "atlas-offset", -100, 100, 1, 0, output="atlas-offset-text"),
    )


def _count(minus: int, count: int) -> str:
    if minus == 0:
        return "all +"
    return f"{minus} minus ({count})" if count > 1 else f"{minus} minus"
