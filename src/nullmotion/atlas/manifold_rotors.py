"""Momentum and Jacobian of an array, with all that does not change worked out once."""

from __future__ import annotations

import numpy as np

from nullmotion.array.model import CmgArray


class Rotors:
    """What following a self-motion asks of an array, thousands of times for a few angles.

    Attributes:
        array: The array.
        n: Its number of CMGs.
        m: Its number of torque dimensions.
    """

    def __init__(self, array: CmgArray) -> None:
        """Take the axes and momenta out of the array."""
        assert array.torque_axes is not None
        self.array, self.n, self.m = array, array.n, array.m
        size = (np.asarray(array.h0) / array.mean_momentum)[:, None]
        self._spin = np.ascontiguousarray(size * (array.spin_axes @ array.torque_axes.T))
        self._torque = np.ascontiguousarray(size * (array.transverse_axes @ array.torque_axes.T))
        self._bias = array.torque_axes @ array.momentum_bias / array.mean_momentum

    def unit_jacobian(self, delta: np.ndarray) -> np.ndarray:
        """Return A over the mean momentum, (..., m, n), for angles (..., n) [rad]."""
        c, s = np.cos(delta)[..., None, :], np.sin(delta)[..., None, :]
        A: np.ndarray = c * self._torque.T - s * self._spin.T
        return A

    def unit_momenta(self, delta: np.ndarray) -> np.ndarray:
        """Return each CMG's momentum over the mean momentum, (..., n, m)."""
        h: np.ndarray = np.cos(delta)[..., None] * self._spin
        return h + np.sin(delta)[..., None] * self._torque

    def missing(self, delta: np.ndarray, momentum: np.ndarray) -> np.ndarray:
        """Return what angles lack to a momentum [N m s], over the mean momentum, (..., m)."""
        turning = np.cos(delta) @ self._spin + np.sin(delta) @ self._torque
        lack: np.ndarray = momentum / self.array.mean_momentum - self._bias - turning
        return lack

    def sigma_min(self, delta: np.ndarray) -> np.ndarray:
        """Return the least singular value of A over the mean momentum, (...)."""
        sigma: np.ndarray = np.linalg.svd(self.unit_jacobian(delta), compute_uv=False)
        return sigma[..., -1] if self.n >= self.m else np.zeros(sigma.shape[:-1])

    def sqrt_det_AAT(self, delta: np.ndarray) -> np.ndarray:
        """Return the product of the singular values of A over the mean momentum, (...)."""
        sigma = np.linalg.svd(self.unit_jacobian(delta), compute_uv=False)
        product: np.ndarray = np.prod(sigma, axis=-1)
        return product if self.n >= self.m else np.zeros(product.shape)
