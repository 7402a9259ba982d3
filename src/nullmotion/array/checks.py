"""Checks of what an array is made from."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from nullmotion.errors import InputError

_UNIT = 1e-6  # axes written with seven digits are meant as unit vectors


def as_vectors(key: str, value: Any, rows: int | None = None) -> np.ndarray:
    """Return finite vectors of B as rows of a fresh array."""
    try:
        array = np.atleast_2d(np.array(value, dtype=float))
    except (TypeError, ValueError) as error:
        raise InputError(key, value, "vectors of three numbers") from error
    if array.ndim != 2 or array.shape[1] != 3 or (rows is not None and len(array) != rows):
        raise InputError(key, array.tolist(), f"{rows or 'n'} x 3 numbers")
    if not np.isfinite(array).all():
        raise InputError(key, array.tolist(), "finite numbers")
    return array


def checked_axes(gimbal_axes: Any, spin_axes: Any) -> tuple[np.ndarray, np.ndarray]:
    """Return exact unit gimbal axes and spin axes perpendicular to them."""
    gimbal = as_vectors("gimbal_axes", gimbal_axes)
    spin = as_vectors("spin_axes", spin_axes, len(gimbal))
    for key, axes in (("gimbal_axes", gimbal), ("spin_axes", spin)):
        lengths = np.linalg.norm(axes, axis=1)
        if np.any(np.abs(lengths - 1) > _UNIT):
            worst = int(np.argmax(np.abs(lengths - 1)))
            raise InputError(
                f"{key}[{worst}]", axes[worst].tolist(), "a unit vector (length 1 to 1e-6)"
            )
    along = np.abs(np.sum(gimbal * spin, axis=1))
    if np.any(along > _UNIT):
        worst = int(np.argmax(along))
        relation = "parallel to it" if along[worst] > 1 - _UNIT else "not perpendicular"
        raise InputError(
            f"spin_axes[{worst}]",
            spin[worst].tolist(),
            f"a spin axis perpendicular to its gimbal axis {gimbal[worst].tolist()} "
            f"(this one is {relation})",
        )
    gimbal = gimbal / np.linalg.norm(gimbal, axis=1, keepdims=True)
    spin = spin - np.sum(gimbal * spin, axis=1, keepdims=True) * gimbal
    return gimbal, spin / np.linalg.norm(spin, axis=1, keepdims=True)


def per_cmg(
    key: str, value: Any, n: int, allowed: str, good: Callable[[np.ndarray], Any]
) -> np.ndarray:
    """Return one number for each CMG, checked."""
    try:
        array = np.broadcast_to(np.asarray(value, float), (n,)).copy()
    except (TypeError, ValueError) as error:
        raise InputError(key, value, f"one number or {n}, one for each CMG") from error
    if np.isnan(array).any() or not np.all(good(array)):
        raise InputError(key, array.tolist(), allowed)
    return array


def checked_limits(key: str, value: Any, n: int) -> np.ndarray:
    """Return lowest and highest gimbal angle of each CMG, (n, 2), checked."""
    try:
        limits = np.broadcast_to(np.asarray(value, float), (n, 2)).copy()
    except (TypeError, ValueError) as error:
        raise InputError(
            key, value, f"two numbers, or {n} x 2: lowest and highest (rad)"
        ) from error
    if not np.all(limits[:, 0] < limits[:, 1]):
        raise InputError(key, limits.tolist(), "lowest below highest (rad)")
    return limits


def torque_basis(gimbal_axes: np.ndarray) -> np.ndarray:
    """Return the torque space's axes: all of B, or the plane normal to parallel gimbal axes.

    In that plane: the body axis that lies most in it, made perpendicular (x when the
    gimbals point along z), then the third axis of the right-handed set.
    """
    first = gimbal_axes[0]
    if np.linalg.matrix_rank(gimbal_axes, tol=1e-9) > 1:
        return np.eye(3)
    normal = first * np.sign(first[np.argmax(np.abs(first))])
    near = np.eye(3)[int(np.argmin(np.abs(normal)))]
    e1 = near - (near @ normal) * normal
    e1 = e1 / np.linalg.norm(e1)
    return np.stack([e1, np.cross(normal, e1)])
