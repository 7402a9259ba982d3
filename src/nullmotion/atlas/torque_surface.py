"""What torque a singular state still gives: in the plane across its singular direction."""

from __future__ import annotations

from typing import Literal, get_args

import numpy as np

from nullmotion.array.capability_batch import scaled_limits
from nullmotion.array.minors import least_rates
from nullmotion.array.model import CmgArray
from nullmotion.array.torque_set import inradius, least_rates_capability
from nullmotion.atlas.surfaces import Surface
from nullmotion.errors import InputError, UnknownNameError
from nullmotion.singularity import tangents

Measure = Literal["sigma", "pseudo-inverse", "optimal"]

_CHUNK = 8192


def surface_torque(array: CmgArray, surface: Surface, measure: Measure = "sigma") -> np.ndarray:
    """Return the torque capability left in the plane across u, at each point of a singular surface.

    With B an orthonormal basis of that plane, of B^T A, (m - 1) x n:

        sigma             its least singular value over the mean momentum: the second smallest
                          one of A, dimensionless
        pseudo-inverse    its torque capability under the pseudo-inverse [N m]
        optimal           its torque capability under the best of all laws [N m]

    (`nullmotion.atlas.torque` says what makes a torque capability N m.)

    Args:
        array: The array.
        surface: One of its `surfaces`, of P points.
        measure: What is asked for.

    Returns:
        The values, (P,).

    Raises:
        InputError: For a surface of another array's size, or one torque dimension.
        UnknownNameError: For another measure.
    """
    if measure not in get_args(Measure):
        raise UnknownNameError("measure", measure, get_args(Measure))
    if surface.delta.shape[1] != array.n or surface.u.shape[1] != array.m:
        size = f"{surface.delta.shape[1]} CMGs, {surface.u.shape[1]} torque dimensions"
        raise InputError("surface", size, f"a surface of {array.n} CMGs, {array.m} dimensions")
    if array.m < 2:
        raise InputError("array", f"{array.m} torque dimension", "2 or 3 torque dimensions")
    parts = [slice(i, i + _CHUNK) for i in range(0, len(surface.u), _CHUNK)]
    found = [_left(array, surface.delta[part], surface.u[part], measure) for part in parts]
    return np.concatenate(found)


def _left(array: CmgArray, delta: np.ndarray, u: np.ndarray, measure: Measure) -> np.ndarray:
    A = tangents(u).mT @ array.unit_jacobian(delta)  # (P, m - 1, n)
    if measure == "sigma":
        return _least_sigma(A)
    limits, unit = scaled_limits(array)
    unit = unit * float(array.mean_momentum)
    if array.n < A.shape[1]:
        return np.zeros(len(A))
    if measure == "optimal":
        return unit * np.asarray(inradius(A, limits))
    columns = np.moveaxis(A, (-1, -2), (0, 1))
    return unit * np.asarray(least_rates_capability(least_rates(columns), limits))


def _least_sigma(A: np.ndarray) -> np.ndarray:
    """Return the least singular value of matrices with one or two rows, (P, 1 or 2, n).

    With columns as complex numbers z_k, 2 sigma_1^2 = sum |z_k|^2 + |sum z_k^2|, and
    sigma_1 sigma_2 is the root of the sum of all squared minors.
    """
    if A.shape[1] == 1:
        return np.linalg.norm(A[:, 0], axis=1)
    x, y = A[:, 0], A[:, 1]
    even = np.sum(x * x + y * y, axis=1)
    odd = np.hypot(np.sum(x * x - y * y, axis=1), 2 * np.sum(x * y, axis=1))
    i, j = np.triu_indices(A.shape[2], 1)
    product = np.linalg.norm(x[:, i] * y[:, j] - x[:, j] * y[:, i], axis=1)
    greatest = np.sqrt(0.5 * (even + odd))
    least: np.ndarray = product / np.where(greatest > 0, greatest, 1.0)
    return least
