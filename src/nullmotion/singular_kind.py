"""Types of singular gimbal angles: what null motion can do there.

Along u (A^T u = 0) the momentum changes in second order only. For a null motion x = N c,

    u . dh = -1/2 c^T Q c,    Q = N^T diag(h_i . u) N,    A N = 0

(Bedrossian et al., J. Guid. Control Dyn. 13 (1990), 1083-1089; Papakonstantinou et al. 2021,
Eq 26). Q without zero eigenvalues settles it: definite, no null motion at all; indefinite, null
motions that leave the singular set in first order, A^T u changing by -diag(h_i . u) x. A
semidefinite Q, and two singular directions at once, are left to `nullmotion.singular_vicinity`.
"""

from __future__ import annotations

from enum import StrEnum
from typing import NamedTuple

import numpy as np

from nullmotion.array.model import CmgArray
from nullmotion.singular_vicinity import Vicinity, explore

TOLERANCE = 1e-6
_PENCIL = 720  # directions looked at in a plane of singular directions


class Kind(StrEnum):
    """What null motion can do at given gimbal angles.

    Attributes:
        SATURATION: No gimbal angles at all have more momentum along u.
        ELLIPTIC: No null motion: these angles are isolated among those of their momentum.
        HYPERBOLIC: Null motion leads out of the singular set.
        DEGENERATE: There is null motion, but close by all of it stays singular.
        REGULAR: Not singular.
    """

    SATURATION = "saturation"
    ELLIPTIC = "elliptic"
    HYPERBOLIC = "hyperbolic"
    DEGENERATE = "degenerate-hyperbolic"
    REGULAR = "regular"


KINDS = tuple(Kind)
_OF = {
    Vicinity.ISOLATED: Kind.ELLIPTIC,
    Vicinity.SINGULAR: Kind.DEGENERATE,
    Vicinity.REGULAR: Kind.HYPERBOLIC,
}


class Form(NamedTuple):
    """The second order of the momentum at singular angles, over the mean momentum.

    Attributes:
        u: Orthonormal singular directions as columns, (m, q).
        null: Orthonormal basis of the null space of A as columns, (n, k).
        along: h_i . u, (n, q).
    """

    u: np.ndarray
    null: np.ndarray
    along: np.ndarray

    def matrix(self, weights: np.ndarray) -> np.ndarray:
        """Return Q for directions u @ weights, (..., k, k), for weights (..., q)."""
        return np.einsum("ik,...i,il->...kl", self.null, weights @ self.along.T, self.null)


def form(array: CmgArray, delta: np.ndarray, tolerance: float = TOLERANCE) -> Form | None:
    """Return the second order at gimbal angles (n,) [rad]; None where A is not singular.

    Args:
        array: The array.
        delta: Gimbal angles [rad], (n,).
        tolerance: Singular value of unit A that counts as none.
    """
    left, sigma, right = np.linalg.svd(array.unit_jacobian(delta))
    rank = int(np.sum(sigma > tolerance))
    if rank == array.m:
        return None
    u = left[:, rank:]
    along = np.asarray(array.rotor_momenta(delta)) @ u / array.mean_momentum
    return Form(u, right[rank:].T, along)


def kind(array: CmgArray, delta: np.ndarray, tolerance: float = TOLERANCE) -> Kind:
    """Return the type of gimbal angles (n,) [rad]; see `nullmotion.singularity.classify`."""
    array, delta = working(array, delta)
    found = form(array, delta, tolerance)
    if found is None:
        return Kind.REGULAR
    weights = _weights(found.u.shape[1])
    if len(saturating(found, tolerance)):
        return Kind.SATURATION
    value = np.linalg.eigvalsh(found.matrix(weights))
    if (value > tolerance).all(axis=1).any():
        return Kind.ELLIPTIC
    if len(weights) == 2 and value[0, 0] < -tolerance and value[0, -1] > tolerance:
        return Kind.HYPERBOLIC
    exact = snapped(array, delta, found, tolerance)
    return _OF[explore(array, exact, found.null)]


def working(array: CmgArray, delta: np.ndarray) -> tuple[CmgArray, np.ndarray]:
    """Return the array of the CMGs that have momentum, and their gimbal angles."""
    idle = np.flatnonzero(np.asarray(array.h0) == 0)
    if not len(idle):
        return array, delta
    return array.without(idle), np.delete(delta, idle)


def snapped(array: CmgArray, delta: np.ndarray, found: Form, tolerance: float) -> np.ndarray:
    """Return nearly singular angles (n,) made singular to rounding for their first u [rad]."""
    assert array.torque_axes is not None
    axes = array.torque_axes.T @ found.u[:, 0]
    sign = np.where(found.along[:, 0] < 0, -1.0, 1.0)
    angle = np.arctan2(sign * (array.transverse_axes @ axes), sign * (array.spin_axes @ axes))
    move = (angle - delta + np.pi) % (2 * np.pi) - np.pi
    near = (np.abs(found.along[:, 0]) > tolerance) & (np.abs(move) < 10 * tolerance**0.5)
    return np.where(near, delta + move, delta)


def _weights(q: int) -> np.ndarray:
    """Return unit vectors of the space of singular directions, (p, q), with their opposites."""
    if q == 1:
        return np.array([[1.0], [-1.0]])
    if q > 2:  # no working CMG has a column: every direction
        return np.concatenate([np.eye(q), -np.eye(q)])
    angle = 2 * np.pi * np.arange(_PENCIL) / _PENCIL
    return np.stack([np.cos(angle), np.sin(angle)], axis=1)


def saturating(found: Form, tolerance: float = TOLERANCE) -> np.ndarray:
    """Return weights (k, q) of singular directions that have all rotors on one side; or none.

    With two directions the borders of the angle in which such a u can be are normal to a rotor.
    """
    q = found.u.shape[1]
    weights = _weights(1) if q == 1 else np.eye(q)
    if q == 2:
        normal = np.stack([-found.along[:, 1], found.along[:, 0]], axis=1)
        size = np.linalg.norm(normal, axis=1, keepdims=True)
        normal = normal[size[:, 0] > tolerance] / size[size[:, 0] > tolerance]
        weights = np.concatenate([normal, -normal])
    if q > 2:
        return weights
    there: np.ndarray = (weights @ found.along.T >= -tolerance).all(axis=1)
    return weights[there]
