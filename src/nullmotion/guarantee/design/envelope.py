"""Where no plane is saturated nor without momentum: bounds on Psi, linear in its coefficients.

    r_1 <= n_1    <=>    |Psi - h_x| <= 2 sqrt(n_1^2 - h_y^2)
    r_2 <= n_2    <=>    |Psi + h_x| <= 2 sqrt(n_2^2 - h_z^2)
    r_1 > 0 (r_2 > 0) is wanted where h_y = 0 (h_z = 0):    Psi > |h_x|

What is best over a ball without singularity is so found by linear programs, for certain.
"""

from __future__ import annotations

import numpy as np

from nullmotion.guarantee.design.family import Family
from nullmotion.guarantee.design.program import Program

_SHELLS = 40
_SATURATED = 0.015  # room left in r^2, for what is between the samples
_EMPTY = 0.03  # least 2 r left to a plane
_THIN = 0.06  # |h_y| over the extent that counts as none
_BISECTIONS = 12
_GREATEST = 30.0  # size of a coefficient


def bias_bounds(
    family: Family, degree: int, directions: np.ndarray, radius: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return A (k, n) and b (k,): A c + b >= 0 leaves no singularity at samples |h| <= radius."""
    shells = radius * np.arange(1, _SHELLS + 1) / _SHELLS
    h = (shells[:, None, None] * directions).reshape(-1, 3)
    psi = family.powers(degree, h)[:, 0]
    slopes, values = [], []
    for sign, other, count in ((1.0, 1, family.counts[0]), (-1.0, 2, family.counts[1])):
        x = sign * h[:, 0]
        room = 2.0 * np.sqrt(np.maximum(count**2 - h[:, other] ** 2 - _SATURATED, 0.0))
        thin = np.abs(h[:, other]) < _THIN * family.extent
        slopes += [-psi, psi, psi[thin]]
        values += [room + x, room - x, -x[thin] - _EMPTY]
    return np.concatenate(slopes), np.concatenate(values)


def nearest_bias(
    start: np.ndarray, bounds: tuple[np.ndarray, np.ndarray]
) -> tuple[np.ndarray, float]:
    """Return the coefficients nearest to some that keep the bounds, and what is left to them.

    Below 0 it is what they miss. Nearest by the greatest change.
    """
    slope, value = bounds
    n = len(start)
    program = Program(n, 1)  # the change and its size; the slack is what the bounds miss
    program.need(value + slope @ start, slope, elastic=True)
    eye = np.eye(n)
    for sign in (1.0, -1.0):
        program.need(np.zeros(n), sign * eye, np.ones(n), 0)
    found = program.solve(np.zeros(n), np.array([-1e-6]), 1.0, _GREATEST, np.array([_GREATEST]))
    if found is None:
        return start, -np.inf
    return start + found.change, -found.slack


def greatest_envelope(family: Family, degree: int, directions: np.ndarray) -> float:
    """Return the greatest radius without singularity that a bias of a degree can have."""
    low, high, start = 0.0, family.extent, family.start(degree)
    for _ in range(_BISECTIONS):
        middle = 0.5 * (low + high)
        bounds = bias_bounds(family, degree, directions, middle)
        _, left = nearest_bias(start, bounds)
        low, high = (middle, high) if left > -1e-7 else (low, middle)
    return low
