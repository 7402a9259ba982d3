"""How much momentum an array can still give along a command (Mao et al. 2019, Eqs 28, 29).

The paper's tau_d is the torque on the vehicle, -hdot. Written with e = hdot/|hdot|:
theta_i is the angle between the rotor's direction and e (the paper's pi - gamma_i),
alpha_i the acute angle between the gimbal axis and the line of e. A rotor can come
as near to e as pi/2 - alpha_i; there its share is used up:

    eram_i = (theta_i + alpha_i - pi/2) / pi          from 0 to 2 alpha_i / pi
    rrss   = sum_i eram_i
    sse    = rrss + sigma_min(A / mean momentum)
"""

from __future__ import annotations

from typing import Any

import numpy as np

from nullmotion import ops
from nullmotion.array.model import CmgArray


def rotor_directions(array: CmgArray, delta: Any) -> Any:
    """Return the unit vectors of the rotors' momenta in B, (..., n, 3)."""
    c, s = ops.cos(delta)[..., None], ops.sin(delta)[..., None]
    return c * array.spin_axes + s * array.transverse_axes


def command_direction(array: CmgArray, hdot: Any) -> Any:
    """Return the unit vector of hdot in B, zero when nothing is commanded, (..., 3)."""
    size = ops.sqrt((hdot * hdot).sum(axis=-1, keepdims=True))
    return (hdot / ops.where(ops.less(0.0, size), size, 1.0)) @ array.torque_axes


def working(array: CmgArray) -> Any:
    """Return 1 for each CMG that has momentum and 0 for the others, (n,)."""
    return ops.where(ops.less(0.0, array.h0), 1.0, 0.0)


def eram(array: CmgArray, delta: Any, hdot: Any) -> Any:
    """Return each CMG's effective residual angular momentum along hdot (dimensionless).

    Args:
        array: The array.
        delta: Gimbal angles [rad], (..., n).
        hdot: Commanded rate of momentum [N m], (..., m); 1/2 for each CMG when it is zero.

    Returns:
        eram_i in [0, 1], (..., n); 0 for a CMG without momentum. Mao 2019, Eq 28.
    """
    e = command_direction(array, hdot)
    theta = _angles(rotor_directions(array, delta), e)
    along_axis = _angles(array.gimbal_axes, e)
    alpha = ops.minimum(along_axis, np.pi - along_axis)
    share = ops.maximum(theta + alpha - 0.5 * np.pi, 0.0) / np.pi
    return share * working(array)


def rrss(array: CmgArray, delta: Any, hdot: Any) -> Any:
    """Return the sum of `eram` over the CMGs (Mao 2019, Sec. IV-B)."""
    return eram(array, delta, hdot).sum(axis=-1)


def sse(array: CmgArray, delta: Any, hdot: Any, sigma_min: Any) -> Any:
    """Return the state of the array's momentum, rrss + sigma_min (Mao 2019, Eq 29).

    Args:
        array: The array.
        delta: Gimbal angles [rad], (n,).
        hdot: Commanded rate of momentum [N m], (m,).
        sigma_min: Least singular value of A divided by the mean momentum.
    """
    return rrss(array, delta, hdot) + sigma_min


def _angles(vectors: Any, e: Any) -> Any:
    """Return the angle of each unit vector to e; pi/2 when e is zero."""
    e = e[..., None, :]
    along = (vectors * e).sum(axis=-1)
    across = vectors - along[..., None] * e
    return ops.atan2(ops.sqrt((across * across).sum(axis=-1)), along)


def describe(sse_value: float, epsilon: float = 0.2, epsilon1: float = 0.8) -> str:
    """Return the state of the momentum in words (Mao 2019, Eq 29)."""
    if np.isnan(sse_value):
        return "unknown"
    if sse_value < epsilon:
        return "exhausted"
    return "sufficient" if sse_value > epsilon1 else "in the middle"


def desaturation_due(
    sse_values: np.ndarray,
    sigma_min: np.ndarray,
    epsilon: float = 0.2,
    epsilon1: float = 0.8,
    sigma_c: float = 0.1,
) -> np.ndarray:
    """Return where Mao 2019, Eq 39, calls for desaturation: a branch that the paper leaves blank.

    True where momentum is exhausted (sse < epsilon), or the array is near singular
    (sigma_min < sigma_c) with too little left to be worth an escape (sse < epsilon1).
    """
    return (sse_values < epsilon) | ((sigma_min < sigma_c) & (sse_values < epsilon1))
