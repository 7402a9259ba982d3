"""What a layout, law, controller or body refuses, told at the key that the value came from."""

from __future__ import annotations

from nullmotion.errors import InputError
from nullmotion.scenario import keys
from nullmotion.scenario.problems import MISSING
from nullmotion.scenario.toml import Path
from nullmotion.scenario.validate import Validator

_WHEELS = {  # fields of the flywheels: keys of [array]
    "wheels.inertia": "wheel_inertia_kg_m2",
    "wheels.torque_limit": "wheel_torque_limit_Nm",
    "wheels.speed_limit": "wheel_speed_limit_rpm",
    "wheels.power_limit": "wheel_power_limit_W",
}


def add_construction(validator: Validator, section: Path, error: InputError) -> None:
    """Note what was refused on construction, at the key that the value came from."""
    head, _, tail = error.key.removeprefix(f"{section[0]}.").removeprefix("law.").partition("[")
    table = validator.source.value(section)
    key = _WHEELS.get(head) or keys.same_quantity(head, table)
    if head == "h0":
        key = next((k for k in ("wheel_speed_rpm", "wheel_speed_rad_s") if k in table), key)
    if key is None:
        value = MISSING if error.value is None else error.value
        validator.add((*section, head), value, error.allowed)
        return
    row = f" ({head}[{tail} = {error.value})" if tail else ""
    validator.add((*section, key), table[key], error.allowed + row)
