"""Sign patterns: which side of its singular direction each rotor is on."""

from __future__ import annotations

from typing import Any

import numpy as np

from nullmotion.array.model import CmgArray
from nullmotion.errors import InputError

_MOST = 16  # CMGs; 2^15 sheets


def patterns(array: CmgArray) -> np.ndarray:
    """Return all sign patterns, (2^(w - 1), n) of 1 and -1, for w working CMGs.

    (u, epsilon) and (-u, -epsilon) are the same singular point, so the first working CMG
    keeps +1. All +1 comes first: the outer surface. A CMG without momentum has +1.

    Raises:
        InputError: For more than 16 working CMGs.
    """
    working = np.flatnonzero(np.asarray(array.h0) > 0)
    if len(working) > _MOST:
        raise InputError("array.n", len(working), f"at most {_MOST} working CMGs")
    count = 2 ** (len(working) - 1)
    bits = (np.arange(count)[:, None] >> np.arange(len(working) - 1)) & 1
    signs = np.ones((count, array.n))
    signs[:, working[1:]] = 1 - 2 * bits
    return signs


def mixed(array: CmgArray) -> np.ndarray:
    """Return the sign patterns that can have elliptic points inside, (k, n).

    Not those of one sign; nor with m of either sign or more: Q has at least a - (m - 1) positive
    and b - (m - 1) negative eigenvalues; nor with two CMGs of equal momentum and parallel axes
    that cancel: turning both alike is a null motion with x^T Q x = 0.
    """
    signs = patterns(array)
    above, below = np.sum(signs > 0, axis=1), np.sum(signs < 0, axis=1)
    kept = (above > 0) & (below > 0) & ((above < array.m) | (below < array.m))
    h0 = np.asarray(array.h0, float)
    parallel = np.abs(array.gimbal_axes @ array.gimbal_axes.T) > 1 - 1e-12
    equal = np.abs(h0[:, None] - h0) < 1e-12 * array.mean_momentum
    for i, j in np.argwhere(np.triu(parallel & equal, 1)):
        kept &= signs[:, i] == signs[:, j]
    return signs[kept]


def checked_signs(array: CmgArray, signs: Any) -> np.ndarray:
    """Return signs (..., n) as floats.

    Raises:
        InputError: For another number of CMGs, or values other than 1 and -1.
    """
    allowed = f"{array.n} signs on the last axis, each 1 or -1"
    try:
        values = np.asarray(signs, float)
    except (TypeError, ValueError) as error:
        raise InputError("signs", signs, allowed) from error
    if values.ndim == 0 or values.shape[-1] != array.n or not (np.abs(values) == 1).all():
        raise InputError("signs", values.tolist(), allowed)
    return values


def checked_directions(array: CmgArray, u: Any, key: str = "u") -> np.ndarray:
    """Return unit vectors along u (..., m).

    Raises:
        InputError: For another number of components, and vectors that are zero or not finite.
    """
    allowed = f"{array.m} components on the last axis, finite and not all zero"
    try:
        values = np.asarray(u, float)
    except (TypeError, ValueError) as error:
        raise InputError(key, u, allowed) from error
    if values.ndim == 0 or values.shape[-1] != array.m:
        raise InputError(key, f"shape {values.shape}", allowed)
    size = np.linalg.norm(values, axis=-1, keepdims=True)
    if not (np.isfinite(size) & (size > 0)).all():
        raise InputError(key, values.reshape(-1, array.m)[0].tolist(), allowed)
    return values / size
