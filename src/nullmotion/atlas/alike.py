"""Arrays that are the same but for a turn of the body, a mirror, and the order of their CMGs.

The reachable momenta of such arrays are turned alike, so that all radii about no momentum are
equal. What a CMG can hold depends on its gimbal axis up to the sign and on its momentum: two
arrays are alike when a permutation and signs make their matrices g_i . g_j equal, and their h0.
With fewer torque dimensions the vector across them, or along the only one, is one more axis that
only fits itself.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from nullmotion.array.model import CmgArray

_EQUAL = 1e-9


def classes(arrays: Sequence[CmgArray]) -> list[int]:
    """Return for each array the index of the first one that it is like (its own if none)."""
    found: list[int] = []
    for i, array in enumerate(arrays):
        first = (j for j in range(i) if found[j] == j and alike(arrays[j], array))
        found.append(next(first, i))
    return found


def alike(one: CmgArray, other: CmgArray) -> bool:
    """Return whether two arrays differ by a turn, a mirror and the order of their CMGs only."""
    if one.m != other.m or one.n != other.n:
        return False
    a, b = _scaled(one), _scaled(other)
    return bool(abs(np.sort(a[0]) - np.sort(b[0])).max() < _EQUAL) and _matched(a, b, [], [])


def _scaled(array: CmgArray) -> tuple[np.ndarray, np.ndarray]:
    """Return momenta and g_i . g_j, with the mark of the torque dimensions last."""
    g, h0 = np.asarray(array.gimbal_axes, float), np.asarray(array.h0, float)
    assert array.torque_axes is not None
    if array.m < 3:
        basis = np.asarray(array.torque_axes, float)
        mark = np.cross(basis[0], basis[1]) if array.m == 2 else basis[0]
        g, h0 = np.concatenate([g, mark[None]]), np.append(h0, -1.0)
    return h0, g @ g.T


def _matched(
    a: tuple[np.ndarray, np.ndarray],
    b: tuple[np.ndarray, np.ndarray],
    order: list[int],
    signs: list[float],
) -> bool:
    """Return whether the first CMGs' places among the others can be continued to all."""
    k = len(order)
    if k == len(a[0]):
        return True
    for j in set(range(len(a[0]))) - set(order):
        if abs(a[0][k] - b[0][j]) > _EQUAL * abs(a[0][k]):
            continue
        for sign in (1.0, -1.0) if k else (1.0,):
            theirs = sign * np.array(signs) * b[1][j, order] if k else np.zeros(0)
            if (np.abs(a[1][k, :k] - theirs) < _EQUAL).all() and _matched(
                a, b, [*order, j], [*signs, sign]
            ):
                return True
    return False
