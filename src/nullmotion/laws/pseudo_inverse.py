"""Moore-Penrose pseudo-inverse: the least gimbal rates that give the torque."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from nullmotion import linalg, ops
from nullmotion.array.model import CmgArray
from nullmotion.law import Claim, Law, Observation


@dataclass(frozen=True)
class PseudoInverse(Law):
    """Least-squares rates through the singular value decomposition A = U S V^T.

        delta_dot = V diag(1 / max(sigma_j, sigma_floor)) U^T hdot

    The floor (Mao 2019, Eq 40) keeps the rates finite where A loses rank; it acts on
    A divided by the mean momentum.

    Args:
        sigma_floor: Least singular value divided by (dimensionless).
    """

    name: ClassVar[str] = "pseudo-inverse"
    full_name: ClassVar[str] = "Moore-Penrose pseudo-inverse"
    aliases: ClassVar[tuple[str, ...]] = ("pi", "mp")
    citation: ClassVar[str] = "Mao et al., IEEE Access 7 (2019), Eq 40"
    claims: ClassVar[frozenset[Claim]] = frozenset(
        {Claim.EXACT_TORQUE, Claim.FINITE, Claim.BOUNDED, Claim.ROTATION, Claim.SCALING, Claim.HOMOGENEOUS,
         Claim.STATELESS, Claim.TIMELESS}
    )

    sigma_floor: float = 1e-4

    def step(self, array: CmgArray, obs: Observation, state: Any) -> tuple[Any, Any]:
        """Return the least rates that give hdot."""
        svd = linalg.svd(array.unit_jacobian(obs.delta))
        along = svd.u.T @ (obs.hdot / array.mean_momentum)
        return svd.v @ (along / ops.maximum(svd.s, self.sigma_floor)), state
