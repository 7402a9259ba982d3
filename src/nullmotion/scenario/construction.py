"""What a layout, law, controller or body refuses, told at the key that the value came from."""

from __future__ import annotations

from nullmotion.errors import InputError
from nullmotion.scenario import keys
from nullmotion.scenario.problems import MISSING
from nullmotion.scenario.toml import Path
from nullmotion.scenario.validate import Validator


def add_construction(validator: Validator, section: Path, error: InputError) -> None:
    """Note what was refused on construction, at the key that the value came from."""
    head, _, tail = error.key.removeprefix(f"{section[0]}.").removeprefix("law.").partition("[")
    table = validator.source.value(section)
    names = {"h0": "wheel_speed_rpm"} if "wheel_speed_rpm" in table else {}
    key = names.get(head) or keys.same_quantity(head, table)
    if key is None:
        value = MISSING if error.value is None else error.value
        validator.add((*section, head), value, error.allowed)
        return
    row = f" ({head}[{tail} = {error.value})" if tail else ""
    validator.add((*section, key), table[key], error.allowed + row)
