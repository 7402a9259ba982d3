"""What an array can be relied on to give: constraint functions, torque capability, proofs.

`create` makes a constraint function by name; it says which gimbal angles hold a momentum,
what torque the array can give there in every direction, and proves how far that holds.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from nullmotion.array.capability import direction_capability, torque_capability
from nullmotion.registry import Registry

if TYPE_CHECKING:
    from pathlib import Path

    from nullmotion.guarantee.certificate import Certificate
    from nullmotion.guarantee.constraint import Constraint

__all__ = [
    "create",
    "direction_capability",
    "get",
    "load_certificate",
    "load_file",
    "names",
    "registry",
    "torque_capability",
]

registry = Registry(
    "constraint", "nullmotion.guarantee.constraints", "nullmotion.guarantee.constraint.Constraint"
)
names = registry.names
get = registry.get
load_file = registry.load_file


def create(name: str, **parameters: Any) -> Constraint:
    """Return a constraint function by name.

    Args:
        name: Name or alias; see `names`.
        **parameters: The constraint's fields; the rest keep their defaults.

    Raises:
        UnknownNameError: For an unknown constraint or parameter, with the nearest names.
        InputError: For a parameter value that the constraint refuses.
    """
    made: Constraint = registry.create(name, **parameters)
    return made


def load_certificate(path: str | Path) -> Certificate:
    """Return a certificate from its file; its method `check` confirms it.

    Raises:
        InputError: For a file that is not one.
    """
    from nullmotion.guarantee import certificate

    return certificate.load(path)
