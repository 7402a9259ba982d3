"""Which CMG goes to which target angle: CMGs with one gimbal axis may change places.

The targets of a group are matched to its gimbal angles on the circle, so that the sum of the
squared differences is least. A best matching keeps the order around the circle: with both in
rising order it is one of k cyclic shifts. All of it is source: ranks by counting, selection by
comparison.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from nullmotion import ops

_TIE = 1e-9  # half a turn to this is half a turn; sums of squares to this are equal
_GRID = float(2**30)  # angles nearer than 1/_GRID rank by index
_SEAM = 0.5772156649  # where the circle is cut for ranks: no state of symmetry lies there


def wrapped(angle: Any) -> Any:
    """Return an angle within half a turn [rad]; half a turn, to rounding, is -pi; source."""
    turns = ops.rint((angle + _TIE) * (0.5 / np.pi))
    return angle - turns * (2.0 * np.pi)


def nearest(angles: Any, targets: Any, carried: Any, working: Any | None = None) -> tuple[Any, Any]:
    """Return the way to the nearest matching of targets, and what the targets carry; source.

    Args:
        angles: Gimbal angles [rad], (p,).
        targets: Target angles [rad], (k,), k <= p, in any order.
        carried: A value of each target, (k,).
        working: For each angle whether it takes part; k of them do. All by default.

    Returns:
        Wrapped differences target - angle, (p,), and carried values, (p,); 0 for what does
        not take part.
    """
    p, k = len(angles), len(targets)
    theirs = _ranked(angles, p if working is None else k, working)
    ours = _ranked(targets, k, None)
    a = [_picked(row, angles) for row in theirs]
    t, c = ([_picked(row, values) for row in ours] for values in (targets, carried))
    way = [[wrapped(t[j] - a[r]) for j in range(k)] for r in range(k)]
    best: Any = None
    for shift in range(k):
        moved = [(r + shift) % k for r in range(k)]
        new = np.array([[way[r][j] for r, j in enumerate(moved)], [c[j] for j in moved]])
        cost = new[0] @ new[0]
        if best is None:
            least, best = cost, new
        else:
            better = ops.less(cost, least - _TIE)
            least, best = ops.where(better, cost, least), ops.where(better, new, best)
    back = [[theirs[r][i] for r in range(k)] for i in range(p)]
    return np.array([_picked(row, best[0]) for row in back]), np.array(
        [_picked(row, best[1]) for row in back]
    )


def in_order(
    angles: Any, targets: Any, carried: Any, working: Any | None = None
) -> tuple[Any, Any]:
    """Return the same as `nearest` with the targets dealt out by number; source."""
    if working is None:
        return wrapped(targets - angles), np.array(list(carried))
    way, values, before = [], [], 0.0
    for angle, flag in zip(angles, working, strict=True):
        mine = [ops.logical_and(flag, ops.equal(before, float(k))) for k in range(len(targets))]
        way.append(ops.where(flag, wrapped(_picked(mine, targets) - angle), 0.0))
        values.append(_picked(mine, carried))
        before = before + ops.where(flag, 1.0, 0.0)
    return np.array(way), np.array(values)


def _ranked(angles: Any, k: int, working: Any | None) -> list[list[Any]]:
    """Return for each rank r < k whether each angle has it; ties rank by index."""
    place = ops.rint(wrapped(angles - _SEAM) * _GRID)
    p = len(angles)
    takes = [True] * p if working is None else list(working)
    before = [[0.0] * p for _ in range(p)]  # before[i][j]: 1 where j comes before i
    for i in range(p):
        for j in range(i):
            first = ops.less_equal(place[j], place[i])
            before[i][j] = ops.where(ops.logical_and(first, takes[j]), 1.0, 0.0)
            before[j][i] = ops.where(ops.logical_and(ops.logical_not(first), takes[i]), 1.0, 0.0)
    rank = [sum(row) for row in before]
    return [
        [ops.logical_and(ops.equal(rank[i], float(r)), takes[i]) for i in range(p)]
        for r in range(k)
    ]


def _picked(chosen: list[Any], values: Any) -> Any:
    """Return the value that is chosen, 0 where none is."""
    result: Any = 0.0
    for flag, value in zip(chosen, values, strict=True):
        result = ops.where(flag, value, result)
    return result
