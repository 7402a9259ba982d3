"""Flatten nested records of numbers to a list of leaves, and put them back.

A record is a float, an array, a tuple (named or not), a dict or a dataclass of
records. Anything else in it (strings, whole numbers, flags, None) is structure.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from nullmotion.compile.tape import Symbol

Leaf = Any  # float or Symbol
Rebuild = Callable[[list[Leaf]], Any]


def flatten(record: Any) -> list[Leaf]:
    """Return the leaves of a record in order."""
    out: list[Leaf] = []
    _walk(record, out)
    return out


def _walk(record: Any, out: list[Leaf]) -> None:
    if isinstance(record, (float, Symbol, np.floating)):
        out.append(record)
    elif isinstance(record, np.ndarray):
        out.extend(record.ravel().tolist() if record.dtype != object else record.ravel())
    else:
        for child in _children(record):
            _walk(child, out)


def _children(record: Any) -> Sequence[Any]:
    if isinstance(record, (tuple, list)):
        return record
    if isinstance(record, dict):
        return list(record.values())
    if dataclasses.is_dataclass(record) and not isinstance(record, type):
        return [getattr(record, f.name) for f in dataclasses.fields(record)]
    return ()


def unflatten(like: Any, leaves: Sequence[Leaf]) -> Any:
    """Return a record shaped like ``like`` that holds ``leaves``.

    Dataclasses are rebuilt without running ``__post_init__``: what was checked
    once on floats is not checked again on symbols.
    """
    source = iter(leaves)
    result = _rebuild(like, source)
    if next(source, None) is not None:
        raise ValueError("more leaves than the record holds")
    return result


def _rebuild(like: Any, source: Any) -> Any:
    if isinstance(like, (float, Symbol, np.floating)):
        return next(source)
    if isinstance(like, np.ndarray):
        values = [next(source) for _ in range(like.size)]
        out = np.empty(
            like.size, dtype=object if any(isinstance(v, Symbol) for v in values) else float
        )
        out[:] = values
        return out.reshape(like.shape)
    if isinstance(like, tuple):
        parts = [_rebuild(child, source) for child in like]
        return type(like)(*parts) if hasattr(like, "_fields") else tuple(parts)
    if isinstance(like, list):
        return [_rebuild(child, source) for child in like]
    if isinstance(like, dict):
        return {key: _rebuild(child, source) for key, child in like.items()}
    if dataclasses.is_dataclass(like) and not isinstance(like, type):
        copy = object.__new__(type(like))
        for f in dataclasses.fields(like):
            object.__setattr__(copy, f.name, _rebuild(getattr(like, f.name), source))
        return copy
    return like


def structure(record: Any) -> Any:
    """Return a hashable description of everything in a record that is not a leaf."""
    if isinstance(record, (float, Symbol, np.floating)):
        return "leaf"
    if isinstance(record, np.ndarray):
        return ("array", record.shape)
    if isinstance(record, (tuple, list)):
        return (type(record).__name__, *map(structure, record))
    if isinstance(record, dict):
        return ("dict", *((k, structure(v)) for k, v in record.items()))
    if dataclasses.is_dataclass(record) and not isinstance(record, type):
        fields = dataclasses.fields(record)
        return (type(record), *((f.name, structure(getattr(record, f.name))) for f in fields))
    return record
