"""Whether the array can go on from singular gimbal angles.

At a point: null motion leads out of the singular set. In a direction d: the momentum can go on
along h + tau d with the gimbals staying close by. With a definite Q (sign s),

    s d . u < 0                             yes: towards the side that the null motion bends to
    s d . u > 0                             no
    d . u = 0                               yes where s kappa < 0: there the sheet curves away
    kappa = min over x with A x = d of s x^T diag(h_i . u) x, times s  (= d^T C^-1 d)

An indefinite Q lets every direction pass. (Directional passability: Yamada and Jikuya, Acta
Astronautica 102 (2014), 103-123.)
"""

from __future__ import annotations

from typing import Any

import numpy as np

from nullmotion.array.model import CmgArray
from nullmotion.atlas.signs import checked_directions
from nullmotion.singular_kind import TOLERANCE, Form, Kind, form, kind, working
from nullmotion.singular_vicinity import reachable
from nullmotion.singularity import checked_angles

_AHEAD = 1e-4  # of the mean momentum; looked ahead where the second order is silent
_NEAR = 0.1  # rad; gimbal rotation that counts as close by


def passable(array: CmgArray, delta: Any, direction: Any = None) -> bool:
    """Return whether the array can go on from gimbal angles, by null motion or along a direction.

    Args:
        array: The array; end stops are not looked at.
        delta: Gimbal angles [rad], (n,).
        direction: Wanted change of momentum, of any length, (m,). Without it: whether null
            motion leaves the singular set (regular or hyperbolic).

    Raises:
        InputError: For angles or directions of another size, not finite, or without length.
    """
    array, angles = working(array, checked_angles(array, delta, single=True))
    what = kind(array, angles)
    if what in (Kind.REGULAR, Kind.HYPERBOLIC):
        return True
    if direction is None:
        return False
    d = checked_directions(array, np.reshape(direction, -1), "direction")
    found = form(array, angles)
    assert found is not None
    second = _second_order(array, angles, found, d)
    if second is None:
        ahead = array.momentum(angles) + _AHEAD * array.mean_momentum * d
        return reachable(array, angles, found.null, ahead, _NEAR)
    return second


def _second_order(array: CmgArray, delta: np.ndarray, found: Form, d: np.ndarray) -> bool | None:
    """Return whether a direction can be passed; None where a definite Q does not tell."""
    if found.u.shape[1] != 1:
        return None
    Q = found.matrix(np.ones((1, 1)))[0]
    value = np.linalg.eigvalsh(Q)
    if len(value) and np.abs(value).min() <= TOLERANCE:
        return None
    side = -1.0 if len(value) and value[0] < 0 else 1.0
    along = float(d @ found.u[:, 0])
    if abs(along) > TOLERANCE:
        return bool(len(value)) and side * along < 0
    x = np.linalg.pinv(array.unit_jacobian(delta), rcond=TOLERANCE) @ d
    pull = found.along[:, 0] * x
    bend = x @ pull
    if len(value):
        across = found.null.T @ pull
        bend = bend - across @ np.linalg.solve(Q, across)
    return None if abs(bend) <= TOLERANCE else bool(len(value)) and side * bend < 0
