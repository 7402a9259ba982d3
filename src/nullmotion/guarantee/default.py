"""The constraint function that a law steers an array by: named, or the array's own."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import fields
from typing import Any

import numpy as np

from nullmotion import guarantee
from nullmotion.array.model import CmgArray
from nullmotion.errors import InputError, UnknownNameError
from nullmotion.guarantee.constraint import Constraint
from nullmotion.guarantee.fit import Fit, fit

_PREFERRED = ("planar", "box90-designed", "roof6", "scissored-pairs", "orthogonal-pairs")
_CLOSE = 1e-6  # likenesses that differ by less are equal: the preferred one comes first


def checked(name: str | None, parameters: Any) -> dict[str, Any]:
    """Return a constraint's parameters as a law keeps them.

    Raises:
        InputError: For an unknown constraint, or a parameter that it refuses, under the keys
            ``law.constraint`` and ``law.constraint_parameters``.
    """
    key = "law.constraint_parameters"
    if not isinstance(parameters, Mapping):
        raise InputError(key, parameters, "a table of the constraint's parameters")
    if name is None:
        if parameters:
            raise InputError(key, dict(parameters), "nothing without a named law.constraint")
        return {}
    try:
        cls = guarantee.get(name) if isinstance(name, str) else None
    except UnknownNameError as error:
        raise InputError("law.constraint", name, error.allowed) from None
    if cls is None:
        raise InputError("law.constraint", name, "the name of a constraint function")
    whole = {f.name for f in fields(cls) if f.type in ("int", int)}
    given = {k: v if k in whole else _floats(v) for k, v in parameters.items()}
    try:
        guarantee.create(name, **given)
    except InputError as error:
        told = error.key.replace("constraint", key, 1)
        raise InputError(told, error.value, error.allowed) from None
    return given


def chosen(
    name: str | None, parameters: Mapping[str, Any], array: CmgArray
) -> tuple[Constraint, Fit] | str:
    """Return a constraint function for an array and how the array fits it, or why none does.

    Args:
        name: The constraint; None for the one whose layout is most like the array.
        parameters: Its parameters, which may be symbols. A number of CMGs ``n`` that is
            not among them is the array's.
        array: The array.

    Raises:
        TraceError: When the gimbal axes are symbols.
    """
    if name is not None:
        return _held(name, parameters, array)
    best: tuple[Constraint, Fit] | None = None
    for candidate in _candidates():
        found = _held(candidate, {}, array)
        if not isinstance(found, str) and (
            best is None or found[1].likeness > best[1].likeness + _CLOSE
        ):
            best = found
    why = f"no constraint function holds these {array.n} CMGs (nullmotion list constraints)"
    return best or why


def _held(
    name: str, parameters: Mapping[str, Any], array: CmgArray
) -> tuple[Constraint, Fit] | str:
    made = _made(name, parameters, array.n)
    if isinstance(made, str):
        return made
    found = fit(made, array)
    return found if isinstance(found, str) else (made, found)


def _candidates() -> Iterator[str]:
    yield from _PREFERRED
    yield from (name for name in guarantee.names() if name not in _PREFERRED)


def _made(name: str, parameters: Mapping[str, Any], n: int) -> Constraint | str:
    """Return the constraint; parameters were checked before, and may be symbols by now."""
    cls = guarantee.get(name)
    own = {f.name for f in fields(cls)}
    try:
        made: Constraint = cls(**({"n": n} if "n" in own else {}))
    except InputError as error:
        return f"{name}: {error}"
    for key, value in parameters.items():
        object.__setattr__(made, key, value)
    return made


def _floats(value: Any) -> Any:
    """Return whole numbers as floats and lists as tuples: a file may write 1 for 1.0."""
    if isinstance(value, (list, tuple)):
        return tuple(map(_floats, value))
    whole = isinstance(value, (int, np.integer)) and not isinstance(value, bool)
    return float(value) if whole else value
