"""``--vary array.skew_deg=40:60:1``: the values that one key takes."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from nullmotion.errors import InputError
from nullmotion.scenario.source import parse_value

_FORM = "section.key=start:stop:step or section.key=a,b,c"
MOST_VALUES = 10_000


@dataclass(frozen=True)
class Vary:
    """A key and its values.

    Attributes:
        key: Dotted key.
        values: What it takes, in order.
    """

    key: str
    values: tuple[Any, ...]


def parse(text: str) -> Vary:
    """Return the key and values of ``key=start:stop:step`` (stop included) or ``key=a,b,c``.

    Raises:
        InputError: For anything else.
    """
    key, equals, listed = (part.strip() for part in text.partition("="))
    if not equals or not listed or "." not in key:
        raise InputError("--vary", text, _FORM)
    parts = listed.split(":")
    if len(parts) == 1:
        return Vary(key, tuple(parse_value(item.strip(), key) for item in _items(listed)))
    return Vary(key, _range(text, parts))


def _items(listed: str) -> list[str]:
    """Return the comma-separated items; commas inside brackets belong to an item."""
    items, depth = [""], 0
    for c in listed:
        depth += (c == "[") - (c == "]")
        if c == "," and depth == 0:
            items.append("")
        else:
            items[-1] += c
    if not all(item.strip() for item in items):
        raise InputError("--vary", listed, "values between all commas")
    return items


def _range(text: str, parts: list[str]) -> tuple[float, ...]:
    try:
        start, stop, step = (float(part) for part in parts)
        count = math.floor((stop - start) / step + 1e-9) + 1
    except (ValueError, ZeroDivisionError, OverflowError):
        raise InputError("--vary", text, _FORM) from None
    if not 1 <= count <= MOST_VALUES:
        raise InputError(
            "--vary", text, f"a step that leads from start to stop in at most {MOST_VALUES} values"
        )
    return tuple(float(f"{start + i * step:.12g}") for i in range(count))
