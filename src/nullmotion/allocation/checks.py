"""Checks that laws with a quadratic program share, and the command they look at."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from nullmotion import qp
from nullmotion.array.model import CmgArray
from nullmotion.errors import InputError, UnknownNameError


def whole(key: str, value: Any) -> None:
    """Refuse what is no whole number from 1.

    Raises:
        InputError: With the key ``law.<key>``.
    """
    if isinstance(value, bool) or not isinstance(value, int) or value < 1:
        raise InputError(f"law.{key}", value, "a whole number from 1")


def solver(name: Any) -> None:
    """Refuse a solver that is unknown or not installed.

    Raises:
        InputError: With the key ``law.solver``.
    """
    try:
        qp.create(name)
    except UnknownNameError as error:
        raise InputError("law.solver", name, error.allowed) from None


def refusal(array: CmgArray, sizes: Mapping[str, int], law: Any) -> str:
    """Return why a law cannot steer an array; an empty string if it can.

    Args:
        array: The array.
        sizes: For each weight, how many numbers it has unless it is one.
        law: Holds the weights.
    """
    if array.n <= array.m:
        return f"{array.n} CMGs leave no null motion beside {array.m} torque dimensions"
    for key, size in sizes.items():
        given = getattr(law, key)
        if isinstance(given, tuple) and len(given) != size:
            return f"{key} has {len(given)} weights, this array takes one or {size}"
    return ""


def wanted(obs: Any, moves: int) -> np.ndarray:
    """Return hdot over the coming moves [N m], (moves, m): the preview, its last row held on."""
    rows = obs.hdot[None] if obs.preview is None else obs.preview[:moves]
    if len(rows) == moves:
        return np.asarray(rows, float)
    return np.asarray(rows, float)[np.minimum(np.arange(moves), len(rows) - 1)]
