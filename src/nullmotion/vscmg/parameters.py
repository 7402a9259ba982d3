"""The parameters that the controller ``adaptive`` learns, as they are."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from nullmotion.vscmg.hardware import rest_inertia


class Parameters(NamedTuple):
    """The true parameters of a run: J = constant + sum_i difference_i s_i s_i^T.

    Attributes:
        constant: [kg m^2], (3, 3).
        difference: J_s - J_t of each unit [kg m^2], (n,).
        gimbal: J_g [kg m^2], (n,).
        torque: The constant torque from outside, in B [N m], (3,).
    """

    constant: np.ndarray
    difference: np.ndarray
    gimbal: np.ndarray
    torque: np.ndarray

    @property
    def theta1(self) -> np.ndarray:
        """Entries xx, yy, zz, xy, xz, yz of the constant part, and J_s - J_t, (6 + n,)."""
        entries = self.constant[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]
        return np.concatenate([entries, self.difference])

    @property
    def theta2(self) -> np.ndarray:
        """J_g and J_s - J_t, (2n,)."""
        return np.concatenate([self.gimbal, self.difference])

    def weighed(self, s: np.ndarray, r: np.ndarray) -> np.ndarray:
        """Return r.J r (k,) for spin axes s as columns (k, 3, n) and vectors r (k, 3)."""
        along = np.einsum("kmn,km->kn", s, r)
        found: np.ndarray = np.sum((r @ self.constant) * r, axis=1) + along**2 @ self.difference
        return found

    def ignorance(self, estimates: np.ndarray, gains: tuple[float, ...]) -> np.ndarray:
        """Return theta~.Gamma^-1 theta~ / 2 (Eq 47), (k,); what is not learned is left out.

        Args:
            estimates: theta_1, theta_2 and the outside torque in a row, (k, 9 + 3n or more).
            gains: Gamma_1, Gamma_2 and that of the outside torque.
        """
        total, at = np.zeros(len(estimates)), 0
        for true, gain in zip((self.theta1, self.theta2, self.torque), gains, strict=True):
            off = estimates[:, at : at + len(true)] - true
            at += len(true)
            if gain > 0:
                total = total + 0.5 * np.sum(off * off, axis=1) / gain
        return total


def true_parameters(setup: Any) -> Parameters:
    """Return the true parameters of a `nullmotion.sim.Setup` with VSCMG units.

    A unit's inertia J_s s s^T + J_t t t^T + J_g g g^T is (J_s - J_t) s s^T + J_t 1 + (J_g - J_t)
    g g^T: only the first part turns with the gimbal.
    """
    array, units = setup.true_array, setup.units
    g, across = array.gimbal_axes, units.transverse_inertia
    constant = rest_inertia(array, units, setup.spacecraft.inertia, setup.delta)
    constant = constant + across.sum() * np.eye(3) + (g.T * (units.gimbal_inertia - across)) @ g
    torque = np.zeros(3) if setup.disturbance is None else setup.disturbance.constant
    return Parameters(constant, units.spin_inertia - across, units.gimbal_inertia, torque)
