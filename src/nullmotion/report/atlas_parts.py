"""Pieces of forms: groups, toggles, sliders, samples of how something is drawn."""

from __future__ import annotations

from collections.abc import Iterable

from nullmotion.plot.atlas_torque import SCALE, ticks
from nullmotion.plot.atlas_view import Ball
from nullmotion.report.markup import Markup, join, tag
from nullmotion.report.wording import number

_STROKES = {"dash": "4 2.4", "dot": "1.2 2.2", "dashdot": "5 2 1.2 2", "longdash": "8 2.6"}


def group(title: str, boxes: Iterable[Markup], *more: Markup) -> Markup:
    """Return toggles under a title."""
    inner = tag("div", join(*boxes), class_="boxes")
    return tag("fieldset", tag("legend", title), inner, *more)


def toggle(
    name: object, note: str, checked: bool = True, mark: Markup | str = "", **data: object
) -> Markup:
    """Return a box to tick: a sample, a name, what it means."""
    box = tag("input", type="checkbox", checked=checked, autocomplete="off", **data)
    return tag(
        "label", box, mark, tag("span", name, note and tag("small", f" {note}")), class_="box"
    )


def slider(
    name: str, key: str, low: float, high: float, step: float, value: float,
    shown: str = "–", output: str | None = None,
) -> Markup:  # fmt: skip
    """Return a slider between its name and its value."""
    ends = {"min": low, "max": high, "step": step, "value": value}
    return tag(
        "label",
        tag("span", name),
        tag("input", type="range", id=key, autocomplete="off", **ends),
        tag("output", shown, id=output),
        class_="slide",
    )


def bar(low: float, high: float, words: str, **attributes: object) -> Markup:
    """Return a scale of colours between two values."""
    colours = f"background: linear-gradient(to right, {', '.join(SCALE)})"
    at = ((value, 100 * (value - low) / ((high - low) or 1.0)) for value in ticks(low, high))
    marks = [tag("span", number(value), style=f"left: {place:.2f}%") for value, place in at]
    return tag(
        "div",
        tag("div", "", class_="ramp", style=colours),
        tag("div", join(*marks), class_="ticks"),
        tag("p", words, class_="note"),
        class_="scale",
        **attributes,
    )


def swatch(colour: str, stripes: bool) -> Markup:
    """Return a sample of a surface."""
    lines = "".join(
        f'<path d="M{x} 12L{x + 6} 0" stroke="{colour}" stroke-width="2"/>' for x in (0, 6, 12)
    )
    return Markup(
        f'<svg width="18" height="12" aria-hidden="true"><rect width="18" height="12" '
        f'fill="{colour}" fill-opacity="{0.45 if stripes else 0.35}"/>{lines if stripes else ""}'
        f'<rect x=".5" y=".5" width="17" height="11" fill="none" stroke="{colour}"/></svg>'
    )


def ring(ball: Ball) -> Markup:
    """Return a sample of a radius: its colour and its dash."""
    strokes = _STROKES.get(ball.dash)
    dash = f' stroke-dasharray="{strokes}"' if strokes else ""
    return Markup(
        f'<svg width="18" height="18" aria-hidden="true"><circle cx="9" cy="9" r="7" fill="none" '
        f'stroke="{ball.colour}" stroke-width="2"{dash}/></svg>'
    )


def stroke(colour: str, width: float) -> Markup:
    """Return a sample of a line."""
    return Markup(
        f'<svg width="22" height="8" aria-hidden="true"><path d="M1 4H21" stroke="{colour}" '
        f'stroke-width="{width + 0.6:.1f}"/></svg>'
    )
