"""Steering laws, one file each; `create` makes one by name."""

from __future__ import annotations

import dataclasses
from typing import Any

from nullmotion.errors import InputError, UnknownNameError
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
    cls = get(name)
    known = {f.name for f in dataclasses.fields(cls)}
    for key in parameters:
        if key not in known and known:
            raise UnknownNameError(f"law.{key}", key, known)
        if not known:
            raise InputError(f"law.{key}", parameters[key], f"no parameters: law {name!r} has none")
    return cls(**parameters)
