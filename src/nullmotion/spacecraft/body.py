"""A rigid spacecraft that carries an array.

    q_dot     = 1/2 q * [0, omega]
    H         = J omega + h + sum_i I_i delta_dot_i g_i
    J omega_dot = T_ext - omega x H - (d/dt of h and the gimbals' own momentum, seen in B)

J holds everything on board, wheels and gimbals included, at any gimbal angle. Without
`momentum_coupling` the term omega x h is left out, as some papers do: angular momentum
is then not conserved.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from nullmotion import linalg
from nullmotion.errors import InputError


@dataclass(frozen=True, eq=False)
class Spacecraft:
    """A rigid body and its state at the start.

    Args:
        inertia: Inertia about the mass centre in B [kg m^2], (3, 3), or its diagonal (3,).
        q_BN: Attitude at the start, scalar first; normalised here.
        omega_BN_B: Body rate at the start, in B [rad/s].
        momentum_coupling: Whether the array's momentum couples into the body (omega x h).

    Raises:
        InputError: For an inertia that no mass distribution has, or a zero quaternion.
    """

    inertia: np.ndarray
    q_BN: np.ndarray = field(default_factory=lambda: np.array([1.0, 0.0, 0.0, 0.0]))
    omega_BN_B: np.ndarray = field(default_factory=lambda: np.zeros(3))
    momentum_coupling: bool = True

    def __post_init__(self) -> None:
        """Check what can be checked."""
        put = object.__setattr__
        put(self, "inertia", checked_inertia("inertia", self.inertia))
        put(self, "q_BN", checked_quaternion("q_BN", self.q_BN))
        put(self, "omega_BN_B", checked_vector("omega_BN_B", self.omega_BN_B))

    @property
    def inverse_inertia(self) -> Any:
        """J^-1 [1/(kg m^2)], (3, 3)."""
        adjugate = linalg.adjugate(self.inertia)
        return adjugate / (self.inertia[0] @ adjugate[:, 0])


def checked_inertia(key: str, value: Any) -> np.ndarray:
    """Return a 3 x 3 inertia, or refuse one that is not physical.

    Raises:
        InputError: Unless symmetric, positive definite, and each principal moment is at
            most the sum of the other two.
    """
    given = np.asarray(value, float)
    J = np.diag(given) if given.shape == (3,) else given
    if J.shape != (3, 3) or not np.isfinite(J).all():
        raise InputError(key, given.tolist(), "3 or 3 x 3 finite numbers (kg m^2)")
    if not np.allclose(J, J.T, rtol=1e-9, atol=0.0):
        raise InputError(key, given.tolist(), "a symmetric matrix")
    moments = np.linalg.eigvalsh(J)
    if moments[0] <= 0:
        raise InputError(
            key, given.tolist(), f"positive principal moments (here {_list(moments)} kg m^2)"
        )
    if moments[2] > (moments[0] + moments[1]) * (1 + 1e-9):
        raise InputError(
            key,
            given.tolist(),
            "principal moments each at most the sum of the other two, as every body has "
            f"(here {_list(moments)} kg m^2)",
        )
    return 0.5 * (J + J.T)


def checked_quaternion(key: str, value: Any) -> np.ndarray:
    """Return a quaternion of length one, or refuse what has no direction."""
    q = np.asarray(value, float)
    if q.shape != (4,) or not np.isfinite(q).all():
        raise InputError(key, q.tolist(), "4 finite numbers, scalar first")
    length = float(np.linalg.norm(q))
    if length < 1e-6:
        raise InputError(key, q.tolist(), "a quaternion that is not zero")
    return q / length


def checked_vector(key: str, value: Any, size: int = 3) -> np.ndarray:
    """Return a vector of finite numbers."""
    v = np.asarray(value, float)
    if v.shape != (size,) or not np.isfinite(v).all():
        raise InputError(key, v.tolist(), f"{size} finite numbers")
    return v


def _list(values: np.ndarray) -> str:
    return ", ".join(f"{v:.4g}" for v in values)
