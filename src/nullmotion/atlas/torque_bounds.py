"""What bounds the torque of an array at gimbal angles: logarithms of all bounds, with slopes.

The torque capability is the least of bounds, one for each CMG or for each facet of the torques
within reach (`nullmotion.array.minors` and `torque_set` have the symbols; l_k are rate limits):

    pseudo-inverse   f_i = log l_i - log |q_i|,                     q_i = G^-1 a_i,  G = A A^T
    optimal          f_S = log sum_k l_k |a_k . c_S| - log |c_S|,   c_S normal to m - 1 columns

With d a_k / d delta_k = -h_k their slopes are sums and products of the same vectors. This is
source: it runs on floats and on symbols.
"""

from __future__ import annotations

from itertools import combinations
from typing import Any, NamedTuple

import numpy as np

from nullmotion import linalg, ops

_NOTHING = 1e-30  # squared length added to rows of the pseudo-inverse
_PARALLEL = 1e-8  # length below which a facet's normal is none
_RANK = 1e-9  # added to the eigenvalues of A A^T


class State(NamedTuple):
    """An array at gimbal angles, in units of its mean momentum.

    Attributes:
        momenta: h_k, (n, m).
        columns: a_k, (n, m).
        inverse: G^-1, (m, m).
    """

    momenta: Any
    columns: Any
    inverse: Any


class Bound(NamedTuple):
    """The logarithm of a bound and its slope by the gimbal angles (n,)."""

    value: Any
    slope: Any


def state(spin: np.ndarray, torque: np.ndarray, delta: Any) -> State:
    """Return an array's state at angles (n,).

    Args:
        spin: h_k at the angle 0, (n, m).
        torque: h_k at the angle of 90 degrees, (n, m).
        delta: Gimbal angles [rad], (n,).
    """
    c, s = ops.cos(delta)[:, None], ops.sin(delta)[:, None]
    columns = c * torque - s * spin
    gram = columns.T @ columns + _RANK * np.eye(spin.shape[1])
    adjugate = linalg.adjugate(gram)
    return State(c * spin + s * torque, columns, adjugate * (1.0 / (gram[0] @ adjugate[:, 0])))


def pseudo_inverse(at: State, limits: np.ndarray) -> list[Bound]:
    """Return the bound of each CMG's rate under the pseudo-inverse.

    d q_i / d delta_k = (a_k . q_i) G^-1 h_k + (h_k . q_i) q_k - [i = k] G^-1 h_k
    """
    rows, turned = at.columns @ at.inverse, at.momenta @ at.inverse
    along, ahead = rows @ at.columns.T, rows @ at.momenta.T
    square, mixed = rows @ rows.T, rows @ turned.T
    found = []
    for i, limit in enumerate(limits):
        size = square[i, i] + _NOTHING
        change = mixed[i] * along[i] + square[i] * ahead[i]
        change[i] = change[i] - mixed[i, i]
        found.append(Bound(np.log(limit) - 0.5 * np.log(size), -change * (1.0 / size)))
    return found


def optimal(at: State, limits: np.ndarray) -> list[Bound]:
    """Return the bound of each facet of the torques within the rate limits."""
    n, m = at.columns.shape
    return [_facet(at, limits, members) for members in combinations(range(n), m - 1)]


def _facet(at: State, limits: np.ndarray, members: tuple[int, ...]) -> Bound:
    """Return the bound of the facet with normal c to its members' columns.

    With s_k = l_k sign(a_k . c), v = sum_k s_k a_k and D = c . v its slope is

        for others    -s_k h_k . c / D
        for members   c' . (v / D - c / |c|^2),   c' the normal with -h_k for a_k
    """
    a = at.columns
    normal = _turned(a[members[0]], a[members[-1]])
    others = [k for k in range(len(a)) if k not in members]
    products = {k: a[k] @ normal for k in others}
    signed = {k: ops.where(ops.less(products[k], 0.0), -limits[k], limits[k]) for k in others}
    far = sum(signed[k] * products[k] for k in others) + 10 * len(a) * _PARALLEL
    square = normal @ normal + _PARALLEL**2
    pull = sum(signed[k] * a[k] for k in others) * (1.0 / far) - normal * (1.0 / square)
    slope = [0.0] * len(a)
    for k in others:
        slope[k] = -signed[k] * (at.momenta[k] @ normal) * (1.0 / far)
    for place, k in enumerate(members):
        moved = [a[i] for i in members]
        moved[place] = -at.momenta[k]
        slope[k] = _turned(moved[0], moved[-1]) @ pull
    return Bound(0.5 * np.log(far * far / square), np.array(slope))


def _turned(x: Any, y: Any) -> Any:
    """Return the normal of two columns in three dimensions, of x alone in two."""
    return linalg.cross(x, y) if len(x) == 3 else np.stack([-x[1], x[0]])
