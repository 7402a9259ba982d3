"""What to say about a key that is not known."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches

UNITS = {  # as written in keys: as written in messages
    "rad_s2": "rad/s2", "deg_s2": "deg/s2", "kg_m2": "kg m2", "rad_s": "rad/s", "deg_s": "deg/s",
    "Nms": "N m s", "Nm": "N m", "W": "W", "rpm": "rpm", "deg": "deg", "rad": "rad", "ms": "ms",
    "per_s": "1/s", "s": "s", "kHz": "kHz", "Hz": "Hz", "km": "km", "m": "m",
}  # fmt: skip
_UNWRITTEN = {"omega_BN_B": "rad/s", "k_m": "1/(kg m2 s)"}
_MOST = 60


def split_unit(key: str) -> tuple[str, str]:
    """Return a key without its unit, in small letters, and the unit as messages write it."""
    for unit, text in UNITS.items():
        if key.lower().endswith("_" + unit.lower()):
            return key[: -len(unit) - 1].lower(), text
    return key.lower(), ""


def without_unit(key: str) -> str:
    """Return a key as fields of records are called: without its unit."""
    unit = next((unit for unit in UNITS if key.endswith("_" + unit)), None)
    return key if unit is None else key[: -len(unit) - 1]


def same_quantity(key: str, known: Iterable[str]) -> str | None:
    """Return the known key that names the same quantity in another unit, if there is one."""
    return next((k for k in known if split_unit(k)[0] == split_unit(key)[0]), None)


def hint(key: str, known: Iterable[str]) -> str:
    """Return what is said about an unknown key: the right unit, near names, all names."""
    names = sorted(known)
    right = same_quantity(key, names)
    if right is not None:
        unit = _UNWRITTEN.get(right) or split_unit(right)[1] or "no unit"
        return f"unknown key; it is written {right} ({unit})"
    near = get_close_matches(key, names, n=3, cutoff=0.5)
    start = f"unknown key; did you mean {' or '.join(near)}? " if near else "unknown key; "
    if near and len(names) > _MOST:
        return start.strip()
    return f"{start}allowed: {', '.join(names)}" if names else "unknown key; there are none here"
