"""Singular direction avoidance: only the least singular value is damped."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from nullmotion import linalg, ops
from nullmotion.array.model import CmgArray
from nullmotion.law import Claim, Law, Observation, check_parameters

_FLOOR = 1e-4  # of the other singular values, which vanish only where A loses two ranks


@dataclass(frozen=True)
class SingularDirectionAvoidance(Law):
    """The singularity-robust inverse confined to the direction that needs it.

        delta_dot = sum_{j<m} v_j (1 / sigma_j) u_j^T hdot
                    + v_m sigma_m / (sigma_m^2 + alpha) u_m^T hdot
        alpha     = alpha0 exp(-kappa det(A A^T))

    A = U S V^T and hdot are divided by the mean momentum: alpha0 and kappa have no unit.
    The torque error lies along the singular direction u_m alone.

    Args:
        alpha0: Damping at a singular state.
        kappa: Decay of the damping with det(A A^T).
    """

    name: ClassVar[str] = "sda"
    full_name: ClassVar[str] = "Singular direction avoidance"
    aliases: ClassVar[tuple[str, ...]] = ("singular-direction-avoidance",)
    citation: ClassVar[str] = "Ford & Hall, J. Guid. Control Dyn. 23 (2000), 648-656"
    claims: ClassVar[frozenset[Claim]] = frozenset(Claim) - {Claim.EXACT_TORQUE}

    alpha0: float = 0.01
    kappa: float = 10.0

    def __post_init__(self) -> None:
        """Check the parameters."""
        check_parameters(self, positive=("alpha0",), not_negative=("kappa",))

    def step(self, array: CmgArray, obs: Observation, state: Any) -> tuple[Any, Any]:
        """Return rates whose torque lacks only part of the singular direction."""
        rows = linalg.rows(array.unit_jacobian(obs.delta), obs.hdot / array.mean_momentum)
        det = np.prod(rows.squares)
        alpha = self.alpha0 * ops.exp(-self.kappa * det)
        least = np.eye(array.m)[-1]
        squares = ops.maximum(rows.squares + alpha * least, _FLOOR * _FLOOR)
        return rows.solve(squares), state
