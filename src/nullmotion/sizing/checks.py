"""Checks of a requirement's sections that need more than one value."""

from __future__ import annotations

from typing import Any

import numpy as np

from nullmotion import laws
from nullmotion.array import layouts
from nullmotion.errors import UnknownNameError
from nullmotion.scenario.toml import Path
from nullmotion.sizing import schema
from nullmotion.sizing.read import Reader
from nullmotion.sizing.requirement import Requirement
from nullmotion.spacecraft.body import checked_inertia

_STEPS = (20, 100_000)
_BANDWIDTH = 0.5  # natural frequency times period above which the feedback is no longer smooth


def check(requirement: Requirement, reader: Reader) -> None:
    """Add to the reader what cannot be."""
    slew, settling = requirement.slew, requirement.settling
    inertia = requirement.spacecraft.inertia_kg_m2
    reader.attempt(("spacecraft", "inertia_kg_m2"), lambda: checked_inertia("inertia", inertia))
    if not np.linalg.norm(slew.axis) > 0:
        reader.add(("slew", "axis"), slew.axis, "a vector that is not zero")
    if not settling.pointing_error_deg < slew.angle_deg:
        allowed = f"below slew.angle_deg = {slew.angle_deg:g}"
        reader.add(("settling", "pointing_error_deg"), settling.pointing_error_deg, allowed)
    for key in ("gimbal_rate_deg_s", "skew_deg"):
        value = getattr(requirement.array, key)
        if isinstance(value, tuple) and not 0 < value[0] < value[1]:
            reader.add(("array", key), value, "one number, or a lower and a greater one, above 0")
    _layouts(requirement, reader)
    _timing(requirement, reader)


def _layouts(requirement: Requirement, reader: Reader) -> None:
    known, given, names = schema.layout_names(), requirement.array.layouts, []
    for name in given:
        names.append(_layout(name))
        if names[-1] not in known:
            allowed = UnknownNameError("layout", name, known).allowed
            reader.add(("array", "layouts"), name, allowed)
    if len(set(names)) < len(names):
        reader.add(("array", "layouts"), given, "each layout once")
    for name in known:
        given = getattr(requirement.law, name)
        for law in (given,) if isinstance(given, str) else given or ():
            _law(reader, ("law", name), law, name)


def _layout(name: str) -> str:
    """Return a layout's name for its name or alias; an unknown one as it is."""
    try:
        return str(layouts.get(name).name)
    except UnknownNameError:
        return name


def _law(reader: Reader, path: Path, law: str, layout: str) -> None:
    cls: Any = reader.attempt(path, lambda: laws.get(law))
    if cls is None:
        return
    if not cls.traceable:
        reader.add(path, law, "a law that can be compiled")
        return
    made = reader.attempt(path, cls)
    reason = made.supports(layouts.create(layout)) if made is not None else ""
    if reason:
        reader.add(path, law, f"a law that steers this layout: {reason}")


def _timing(requirement: Requirement, reader: Reader) -> None:
    least, most = _STEPS
    steps = requirement.slew.time_s / requirement.period
    if not least <= steps <= most:
        low, high = requirement.slew.time_s / most, requirement.slew.time_s / least
        path: Path = ("law", "period_s")
        reader.add(path, requirement.law.period_s, f"from {low:g} to {high:g} s for this slew")
    elif requirement.natural_frequency * requirement.period > _BANDWIDTH:
        path = ("controller", "natural_frequency_rad_s")
        allowed = f"at most {_BANDWIDTH / requirement.period:g} at a period of "
        reader.add(path, requirement.natural_frequency, f"{allowed}{requirement.period:g} s")
