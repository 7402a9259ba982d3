"""Named geometries, one file each: ``layouts.pyramid(skew=...)`` makes an array."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from nullmotion.array.layout import Layout
from nullmotion.array.model import CmgArray
from nullmotion.errors import UnknownNameError
from nullmotion.registry import Registry

registry = Registry("layout", "nullmotion.array.layouts", "nullmotion.array.layout.Layout")
names = registry.names
get = registry.get

_ARRAY_KEYS = (
    "h0",
    "rate_limit",
    "rate_limit_mode",
    "angle_limits",
    "momentum_bias",
    "wheels",
)


def create(name: str, **parameters: Any) -> CmgArray:
    """Return an array of a named layout.

    Args:
        name: Layout; see `names`.
        **parameters: Fields of the layout (angles in rad) and of `CmgArray`
            (h0, rate_limit, rate_limit_mode, angle_limits, momentum_bias, wheels).

    Raises:
        UnknownNameError: For an unknown layout or parameter, with the nearest names.
        InputError: For a value that cannot be.
    """
    cls = get(name)
    own = {f.name for f in dataclasses.fields(cls)}
    for key in parameters:
        if key not in own and key not in _ARRAY_KEYS:
            raise UnknownNameError(f"array.{key}", key, [*own, *_ARRAY_KEYS])
    layout: Layout = cls(**{k: v for k, v in parameters.items() if k in own})
    return layout.array(**{k: v for k, v in parameters.items() if k not in own})


def home(name: str, **parameters: Any) -> np.ndarray:
    """Return a layout's starting gimbal angles [rad]: little or no momentum, far from singular."""
    cls = get(name)
    own = {f.name for f in dataclasses.fields(cls)}
    return np.asarray(cls(**{k: v for k, v in parameters.items() if k in own}).home(), float)


def __getattr__(name: str) -> Callable[..., CmgArray]:
    if name.startswith("_"):
        raise AttributeError(name)
    try:
        registry.get(name)
    except UnknownNameError as error:
        raise AttributeError(str(error)) from None
    return partial(create, name)


# importing a layout's file binds its module to the same name: the maker comes last and stays
for _name in names():
    globals()[_name] = partial(create, _name)
