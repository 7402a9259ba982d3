"""Steering laws, one file each; `create` makes one by name."""

from __future__ import annotations

from typing import Any

from nullmotion.law import Law
from nullmotion.registry import Registry

registry = Registry("law", "nullmotion.laws", "nullmotion.law.Law")
names = registry.names
get = registry.get
load_file = registry.load_file


def create(name: str, **parameters: Any) -> Law:
    """Return a steering law by name.

    Args:
        name: Name or alias; see `names`.
        **parameters: The law's fields; the rest keep their defaults.

    Raises:
        UnknownNameError: For an unknown law or parameter, with the nearest names.
        InputError: For a parameter value that the law refuses.
    """
    made: Law = registry.create(name, **parameters)
    return made
