"""The stage of an animation: canvas, controls, and the numbers that its script draws."""

from __future__ import annotations

import base64
from collections.abc import Mapping, Sequence
from functools import cache
from importlib.resources import files
from typing import Any

import numpy as np

from nullmotion.report.charts import embedded
from nullmotion.report.markup import Markup, join, tag

_KEYS = (
    "Space plays and stops, the left and right arrow keys move along (with Shift further). Drag "
    "the picture to look from elsewhere."
)


def numbers(values: Any) -> str:
    """Return an array as the script reads it: single precision, base64."""
    return base64.b64encode(np.asarray(values, "<f4").tobytes()).decode()


def stage(
    scene: Mapping[str, Any],
    words: str,
    legend: Markup,
    events: Sequence[tuple[float, str]] = (),
    speeds: Sequence[float] = (0.25, 0.5, 1.0, 2.0),
    views: Mapping[str, str] | None = None,
    wide: bool = False,
) -> Markup:
    """Return canvas, controls and scripts of an animation.

    Args:
        scene: What the script draws; `from` and `to` are the ends of its clock.
        words: What the picture shows, for those who cannot see it.
        legend: What its lines and colours stand for.
        events: Instants on the clock [s], with names.
        speeds: Choices of the speed, 1 among them.
        views: Directions to look from: key for the script, and name.
        wide: Whether the picture has the page's width.
    """
    looks = views or {"oblique": "Oblique", "side": "Side", "above": "Above"}
    canvas = tag("canvas", id="scene", tabindex="0", role="img", aria_label=words)
    return tag(
        "div",
        tag("div", canvas, tag("p", "", id="scene-says"), class_="picture"),
        _controls(scene, events),
        tag(
            "div", join(*(_look(*look) for look in looks.items())), _speeds(speeds), class_="looks"
        ),
        legend,
        tag("p", _KEYS, class_="note"),
        _moments(events) if events else "",
        _bridge(),
        class_="stage wide" if wide else "stage",
    )


def _controls(scene: Mapping[str, Any], events: Sequence[tuple[float, str]]) -> Markup:
    slider = tag(
        "input",
        type="range",
        id="clock",
        min=scene["from"],
        max=scene["to"],
        step="any",
        value=scene["from"],
        aria_label=scene["clock"],
    )
    return tag(
        "div",
        tag("button", "Play", id="play", type="button"),
        tag("output", "", id="clock-says", for_="clock"),
        tag("div", slider, _ticks(scene, events), class_="track"),
        class_="player",
    )


def _speeds(speeds: Sequence[float]) -> Markup:
    made = [tag("option", f"{s:g} ×", value=s, selected=s == 1.0) for s in speeds]
    name = tag("span", "Speed", class_="unseen")
    return tag("label", name, tag("select", join(*made), id="speed"))


def _ticks(scene: Mapping[str, Any], events: Sequence[tuple[float, str]]) -> Markup:
    span = scene["to"] - scene["from"]
    shares = [(at - scene["from"]) / span for at, _ in events]
    return join(*(tag("i", style=f"--at:{share:.4f}") for share in shares))


def _look(key: str, name: str) -> Markup:
    return tag("button", name, type="button", data_look=key)


def _bridge() -> Markup:
    """Return the hidden cursor through which the charts follow, and are followed."""
    return tag(
        "div",
        tag("input", type="range", id="cursor", min=0, max=1000, step="any", value=0),
        tag("output", "", id="cursor-time"),
        hidden=True,
    )


def legend(entries: Sequence[tuple[str, str]]) -> Markup:
    """Return the legend of a picture from classes of `rover.css` and words."""
    items = (tag("li", tag("i", class_=key), words) for key, words in entries)
    return tag("ul", join(*items), class_="key")


def _moments(events: Sequence[tuple[float, str]]) -> Markup:
    """Return the instants [s]; pressing one goes there."""
    items = (
        tag("li", tag("button", f"{at:.2f} s", type="button", data_at=f"{at:.6f}"), words)
        for at, words in events
    )
    return join(tag("h3", "Events"), tag("ol", join(*items), class_="moments"))


def scripts(scene: Mapping[str, Any], kind: str) -> Markup:
    """Return style, data and scripts of an animation, for the end of the page."""
    code = f"{_asset('rover_scene.js')}\n{_asset(f'rover_{kind}.js')}"
    return Markup(
        f"<style>{_asset('rover.css')}</style>"
        f'<script type="application/json" id="scene-data">{embedded(scene)}</script>'
        f"<script>{code}</script>"
    )


@cache
def _asset(name: str) -> str:
    return files("nullmotion.report").joinpath("assets", name).read_text(encoding="utf-8")
