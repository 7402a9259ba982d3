"""The singular set of arrays with parallel gimbal axes: lines in gimbal space, known exactly.

Column i of A / h0_i is the unit vector at the angle t_i = phase_i + sense_i delta_i in the
torque plane. The array is singular when all columns are parallel,

    t_i = c + k_i pi    for any c and whole numbers k_i,

a family of lines along the senses, for the triangle along (1, 1, 1), pi sqrt(2/3) = 2.565 rad
apart. With the column j as the one from which the others are counted, k is settled:

    k_i = floor((t_i - t_j) / pi),   f_i = t_i - t_j - k_i pi in [0, pi),
    d^2 = min over j of sum_i (f_i - mean f)^2

for the nearest k has all t_i - k_i pi within pi of each other. So n candidates are enough for
angles of any number of turns, and d is the same for delta and delta + 2 pi k.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from nullmotion import ops
from nullmotion.array.model import CmgArray
from nullmotion.errors import InputError


class NearestLine(NamedTuple):
    """The singular configuration of a planar array nearest to given gimbal angles.

    Attributes:
        distance: 2-norm of the gimbal rotation to get there [rad], (...).
        delta_s: The singular gimbal angles [rad], (..., n).
        k: Half turns between the columns; even from one column to the next: same direction,
            (..., n).
        momentum: |sum of the rotors' momenta| there over h0, (...): 3 on the triangle's lines
            of saturation (3h), 1 on the internal ones (1h).
    """

    distance: Any
    delta_s: Any
    k: Any
    momentum: Any


@lru_cache(maxsize=64)
def lies_in_a_plane(array: CmgArray) -> bool:
    """Return whether all gimbal axes are parallel and all CMGs work: the lines are then exact."""
    axes = np.asarray(array.gimbal_axes, float)
    parallel = np.abs(axes @ axes[0]) > 1 - 1e-12
    return array.m == 2 and bool(parallel.all()) and bool(np.all(np.asarray(array.h0) > 0))


def frame(array: CmgArray) -> tuple[np.ndarray, np.ndarray]:
    """Return phase_i [rad] and sense_i (1 or -1) of a planar array's columns, (n,) each.

    Raises:
        InputError: For an array whose singular set is no family of lines.
    """
    if not lies_in_a_plane(array):
        raise InputError("array", array.label, "parallel gimbal axes and no wheel at rest")
    assert array.torque_axes is not None
    basis = np.asarray(array.torque_axes, float)
    column = array.transverse_axes @ basis.T
    sense = np.sign(array.gimbal_axes @ np.cross(basis[0], basis[1]))
    return np.arctan2(column[:, 1], column[:, 0]), sense


def nearest(array: CmgArray, delta: Any) -> NearestLine:
    """Return the nearest point of the nearest singular line, for angles (..., n) [rad].

    Raises:
        InputError: For an array whose singular set is no family of lines.
    """
    phase, sense = frame(array)
    angles = np.asarray(delta, float)
    t = phase + sense * angles
    candidates = [_from(j, t) for j in range(array.n)]
    squares = np.stack([square for square, _, _ in candidates])
    best = np.argmin(squares, axis=0)[None, ..., None]
    offset, k = (
        np.take_along_axis(np.stack([c[i] for c in candidates]), best, axis=0)[0] for i in (1, 2)
    )
    rotors = np.exp(1j * (t - offset))  # all along one direction, some against it
    momentum = np.abs(rotors @ array.h0) / array.mean_momentum
    distance = np.sqrt(squares.min(axis=0))
    return NearestLine(distance[()], angles - sense * offset, k, momentum[()])


def offset(t: Any) -> tuple[Any, Any]:
    """Return d^2 [rad^2] and the vector t - t_s [rad] of column angles (n,), floats or symbols."""
    square, found, _ = _from(0, t)
    for j in range(1, len(t)):
        other, vector, _ = _from(j, t)
        closer = ops.less(other, square)
        square, found = ops.where(closer, other, square), ops.where(closer, vector, found)
    return square, found


def _from(j: int, t: Any) -> tuple[Any, Any, Any]:
    """Return d^2, t - t_s and k where all columns are counted from column j on."""
    turns = (t - t[..., j : j + 1]) * (1.0 / np.pi)
    k = ops.rint(turns)
    k = ops.where(ops.less(turns, k), k - 1.0, k)  # floor
    f = (turns - k) * np.pi
    vector = f - f @ np.full((t.shape[-1],) * 2, 1.0 / t.shape[-1])
    return (vector * vector).sum(axis=-1), vector, k
