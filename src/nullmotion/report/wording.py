"""Numbers and names as a reader wants them."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from nullmotion import metrics
from nullmotion.errors import UnknownNameError

REDUCTIONS = {
    "min": "least over the run",
    "max": "largest over the run",
    "rms": "root mean square over the run",
    "mean": "mean over the run",
    "final": "at the end",
}
NOT_SETTLED = "not settled"
_SETTLING = ("settling_time_s", "momentum_settling_s", "wheel_settling_s")
_SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


class Meaning(NamedTuple):
    """What a key of a summary stands for."""

    words: str
    unit: str
    definition: str = ""
    citation: str = ""


def number(value: Any, digits: int = 4) -> str:
    """Return a number in few digits; a dash for none."""
    if value is None:
        return "–"
    if isinstance(value, bool) or (
        not isinstance(value, (int, float)) and not hasattr(value, "dtype")
    ):
        return str(value)
    plain = float(value)
    if math.isnan(plain):
        return "–"
    if math.isinf(plain):
        return "∞" if plain > 0 else "−∞"
    mantissa, _, power = f"{plain:.{digits}g}".partition("e")
    written = mantissa.replace("-", "−")
    return f"{written}×10{str(int(power)).translate(_SUPERSCRIPTS)}" if power else written


def percent(fraction: Any, digits: int = 3) -> str:
    """Return a fraction in percent."""
    if fraction is None or not math.isfinite(float(fraction)):
        return number(fraction)
    value = 100 * float(fraction)
    return "< 0.001" if 0 < value < 1e-3 else number(value, digits)


def plain(name: str) -> str:
    """Return a key as words."""
    return name.replace("_", " ").replace("-", " ").strip()


def meaning(key: str) -> Meaning:
    """Return what a metric's key in a summary (``min_sigma_min``) stands for."""
    reduction, _, name = key.partition("_")
    how = ""
    if reduction in REDUCTIONS:
        how = f", {REDUCTIONS[reduction]}"
    else:
        name = key
    try:
        metric = metrics.get(name)
    except UnknownNameError:
        return Meaning(f"{plain(name)}{how}", _unit_of(name))
    words = f"{metric.title or plain(name)}{how}"
    first = (metric.__doc__ or "").strip().partition("\n\n")[0].replace("``", "")
    return Meaning(words, metric.unit, " ".join(first.split()).rstrip("."), metric.citation)


def _unit_of(name: str) -> str:
    for ending, unit in (
        ("_rad_s", "rad/s"),
        ("_Nms", "N m s"),
        ("_Nm", "N m"),
        ("_s", "s"),
        ("_rad", "rad"),
    ):
        if name.endswith(ending):
            return unit
    return "1"


def quantity(value: Any, unit: str, name: str = "") -> tuple[str, str]:
    """Return value and unit as written: fractions in percent, plain numbers without a unit.

    A settling time that is not a number is said in words.
    """
    if name in _SETTLING and value is not None and math.isnan(value):
        return NOT_SETTLED, ""
    if name.endswith("_fraction"):
        return percent(value), "%"
    return number(value), "" if unit in ("", "1") else unit
