"""Which rotations lay an array's gimbal axes on those of a layout, and which CMG falls where."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import permutations, product

import numpy as np

from nullmotion.array.model import CmgArray

CLOSE = 1e-7  # axes that agree to this are the same


def rotations(gimbal: np.ndarray, spin: np.ndarray, model: CmgArray) -> Iterator[np.ndarray]:
    """Return rotations that lay two gimbal axes on two of the layout's, (3, 3) each.

    With parallel gimbal axes: the first gimbal axis, either way, and its spin axis.
    """
    lines = model.gimbal_axes
    apart = [j for j in range(model.n) if np.linalg.norm(np.cross(lines[0], lines[j])) > CLOSE]
    if not apart:
        frame = _triad(lines[0], model.spin_axes[0])
        yield from (frame.T @ _triad(sign * gimbal[0], spin[0]) for sign in (1.0, -1.0))
        return
    frame, wanted = _triad(lines[0], lines[apart[0]]), lines[0] @ lines[apart[0]]
    for a, b in permutations(range(len(gimbal)), 2):
        for p, q in product((1.0, -1.0), repeat=2):
            if abs(p * q * (gimbal[a] @ gimbal[b]) - wanted) < CLOSE:
                yield frame.T @ _triad(p * gimbal[a], q * gimbal[b])


def places(turned: np.ndarray, lines: np.ndarray) -> list[int] | None:
    """Return a place of the layout for each CMG, its own number where it can; None if none.

    Args:
        turned: Gimbal axes in the layout's frame, (n, 3).
        lines: The layout's gimbal axes, (n, 3).
    """
    same = np.linalg.norm(np.cross(turned[:, None], lines[None]), axis=2) < CLOSE
    n = len(turned)
    found = [i if same[i, i] else -1 for i in range(n)]
    for i in range(n):
        if found[i] < 0:
            free = [j for j in range(n) if same[i, j] and j not in found]
            if not free:
                return None
            found[i] = free[0]
    return found


def _triad(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return three unit vectors at right angles: along a, towards b, across both; as rows."""
    c = np.cross(a, b)
    c = c / np.linalg.norm(c)
    return np.stack([a, np.cross(c, a), c])
