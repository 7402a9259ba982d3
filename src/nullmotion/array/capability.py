"""Torque capability: the largest torque that an array can give in every direction.

Torque is the rate of change of the array's momentum. Everything is divided by the mean
momentum of the working CMGs times the least rate limit (one rad/s where there is no limit,
which then counts for all CMGs): a single CMG has the capability 1.
"""

from __future__ import annotations

from typing import Any, Literal, get_args

import numpy as np

from nullmotion.array.capability_batch import evaluated
from nullmotion.array.model import CmgArray
from nullmotion.array.torque_set import rows_capability
from nullmotion.errors import InputError, UnknownNameError

__all__ = ["direction_capability", "rows_capability", "torque_capability"]

Method = Literal["pseudo-inverse", "optimal", "local-gradient"]


def torque_capability(
    array: CmgArray,
    delta: Any,
    method: Method = "pseudo-inverse",
    *,
    k: float | None = None,
    null_motion: Any = None,
) -> Any:
    """Return the torque capability at gimbal angles (Elliott 2019, Section 2.2.2).

        pseudo-inverse    min_i limit_i / |row_i(A^+)|                      (Eq 15)
          null_motion     min_i (limit_i - |nu_i|) / |row_i(A^+)|           (Eq 143)
        local-gradient    the same with nu = k (I - A^+ A) grad det(A A^T)  (Eq 60)
        optimal           inradius of {A w : |w_i| <= limit_i}: the best of all laws

    With one rate limit for all a linear law has at most n/m, the optimum up to n/2 (m = 3) or
    cot(pi/2n) (m = 2). With null motion beyond the rate limit the capability is negative, as
    Eq 143 has it. Singular arrays, and arrays of fewer CMGs than torque dimensions, have
    exactly 0.

    Args:
        array: The array; its limits are in the result, its `rate_limit_mode` is not.
        delta: Gimbal angles [rad], (..., n).
        method: How torque is shared out to the CMGs.
        k: Gain of the local gradient [rad/s], det(A A^T) made of A / mean momentum.
        null_motion: Gimbal rates of a null motion [rad/s], (..., n), of any law that adds it
            to the pseudo-inverse.

    Returns:
        A float, or an array over the leading axes.

    Raises:
        InputError: For angles of another number of CMGs or that are not finite, and for k or
            null_motion missing, not finite or beside a method that has none.
        UnknownNameError: For an unknown method.
    """
    angles = _finite("delta", delta, array.n, f"{array.n} gimbal angles (rad)")
    if method not in get_args(Method):
        raise UnknownNameError("method", method, get_args(Method))
    if (k is not None) != (method == "local-gradient"):
        raise InputError("k", k, "a gain (rad/s) with method 'local-gradient', and only there")
    if null_motion is not None and method != "pseudo-inverse":
        raise InputError("null_motion", null_motion, "only with method 'pseudo-inverse'")
    extra = []
    if k is not None:
        if not isinstance(k, (int, float, np.number)) or not 0 <= k < np.inf:
            raise InputError("k", k, "one finite number, not negative (rad/s)")
        extra.append(np.asarray(k, float))
    if null_motion is not None:
        extra.append(_finite("null_motion", null_motion, array.n, f"{array.n} rates (rad/s)"))
    return evaluated(array, method, angles, *extra)


def direction_capability(array: CmgArray, delta: Any, directions: Any) -> Any:
    """Return the largest torque within the rate limits along given directions.

    Whatever the rates' law, and at singular angles too; the least over all directions is the
    `torque_capability` of the method ``optimal``.

    Args:
        array: The array.
        delta: Gimbal angles [rad], (..., n).
        directions: Vectors of any length along the array's torque axes, (..., m); leading axes
            broadcast against delta's.

    Returns:
        A float, or an array over the leading axes.

    Raises:
        InputError: For angles or directions of another size, not finite, or without length.
    """
    angles = _finite("delta", delta, array.n, f"{array.n} gimbal angles (rad)")
    vectors = _finite("directions", directions, array.m, f"{array.m} components")
    size = np.linalg.norm(vectors, axis=-1, keepdims=True)
    if not (size > 0).all():
        raise InputError("directions", [0.0] * array.m, "vectors that are not zero")
    return evaluated(array, "direction", angles, vectors / size)


def _finite(key: str, value: Any, size: int, allowed: str) -> np.ndarray:
    try:
        numbers = np.asarray(value, float)
    except (TypeError, ValueError) as error:
        raise InputError(key, value, allowed) from error
    if numbers.ndim == 0 or numbers.shape[-1] != size:
        raise InputError(key, f"shape {numbers.shape}", f"{allowed} on the last axis")
    rows = numbers.reshape(-1, size)
    good = np.isfinite(rows).all(axis=1)
    if not good.all():
        raise InputError(key, rows[np.argmin(good)].tolist(), f"{allowed}, finite")
    return numbers
