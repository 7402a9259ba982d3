"""Every singular point of an array, by direction and signs.

The array gives no torque along the unit vector u when every rotor lies in the plane of u and
its gimbal axis, on either side:

    h_i / h0_i = epsilon_i p_i / |p_i|,    p_i = u - (u . g_i) g_i,    epsilon_i = 1 or -1

(Margulies and Aubrun, J. Astronaut. Sci. 26 (1978), 159-191). So a sign pattern and the
directions u of a sphere make one sheet; (u, epsilon) and (-u, -epsilon) are one point. Where u
is along g_i, p_i vanishes and CMG i may have any angle: a circle of singular points, the rim of
a hole in the sheet, along which the sheets of epsilon_i = 1 and -1 meet.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from nullmotion.array.model import CmgArray
from nullmotion.atlas.signs import checked_directions, checked_signs

FREE = 1e-13  # |p_i| below which u counts as along the gimbal axis


@dataclass(frozen=True, eq=False)
class SingularPoints:
    """Singular points of given directions and signs.

    Attributes:
        u: Unit singular directions along the torque axes, (..., m): A^T u = 0.
        signs: epsilon, (..., n).
        delta: Gimbal angles in (-pi, pi] [rad], (..., n).
        momentum: h(delta) with the array's bias [N m s], (..., m).
        across: |p_i|, the part of u across each gimbal axis, (..., n).
        free: CMGs that are singular at any angle: u along the gimbal axis, or no momentum.
    """

    u: np.ndarray
    signs: np.ndarray
    delta: np.ndarray
    momentum: np.ndarray
    across: np.ndarray
    free: np.ndarray


def singular_points(array: CmgArray, u: Any, signs: Any, towards: Any = None) -> SingularPoints:
    """Return the singular points of directions u and signs epsilon.

    Args:
        array: The array; its momentum bias is in the result.
        u: Directions along the torque axes, of any length, (..., m).
        signs: 1 or -1 for each CMG, (..., n); leading axes broadcast against u's.
        towards: For CMGs with u along the gimbal axis: the side from which the limit is taken,
            vectors (..., m). Turned around u it gives the whole circle. Without it such a CMG
            stays at the angle 0.

    Raises:
        InputError: For vectors without length, other numbers of components, other signs.
    """
    direction, sign = checked_directions(array, u), checked_signs(array, signs)
    lead = np.broadcast_shapes(direction.shape[:-1], sign.shape[:-1])
    cosine, sine, across = polar(array, direction)
    if towards is not None:
        side = polar(array, checked_directions(array, towards, "towards"))
        on_axis = across < FREE
        cosine, sine = np.where(on_axis, side[0], cosine), np.where(on_axis, side[1], sine)
        lead = np.broadcast_shapes(lead, cosine.shape[:-1])
    shape = (*lead, array.n)
    delta = np.broadcast_to(np.arctan2(sign * sine, sign * cosine), shape)
    if towards is None:
        delta = np.where(across < FREE, 0.0, delta)
    free = (across < FREE) | (np.asarray(array.h0) == 0)
    return SingularPoints(
        np.broadcast_to(direction, (*lead, array.m)),
        np.broadcast_to(sign, shape),
        delta,
        array.momentum(delta),
        np.broadcast_to(across, shape),
        np.broadcast_to(free, shape),
    )


def polar(array: CmgArray, u: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return cosine and sine of the singular angles with epsilon = 1, and |p_i|, (..., n) each."""
    assert array.torque_axes is not None
    along_spin = u @ (array.spin_axes @ array.torque_axes.T).T
    along_torque = u @ (array.transverse_axes @ array.torque_axes.T).T
    across = np.hypot(along_spin, along_torque)
    on_axis = across < FREE
    size = np.where(on_axis, 1.0, across)
    cosine, sine = along_spin / size, along_torque / size
    return np.where(on_axis, 1.0, cosine), np.where(on_axis, 0.0, sine), across
