"""Moore-Penrose pseudo-inverse: the least gimbal rates that give the torque."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from nullmotion import linalg, ops
from nullmotion.array.model import CmgArray
from nullmotion.law import Claim, Law, Observation, check_parameters


@dataclass(frozen=True)
class PseudoInverse(Law):
    """Least-squares rates through the singular values sigma_j of A = U S V^T.

        delta_dot = sum_j v_j (sigma_j / max(sigma_j, sigma_floor)^2) u_j^T hdot

    A and hdot are divided by the mean momentum: sigma_j is dimensionless, rates are in
    rad/s. Above the floor this is A^+ hdot. Mao's Eq 40 replaces 1/sigma_3 by
    1/sigma_floor below it; here the factor falls to zero with sigma_3 instead: at a
    singular state v_3 is any vector of a null space, Eq 40 picks one by rounding and
    multiplies it by 10^4, while sigma_3 v_3 = A^T u_3 is what it is.

    Args:
        sigma_floor: Singular value below which the rates along it fall off.
    """

    name: ClassVar[str] = "pseudo-inverse"
    full_name: ClassVar[str] = "Moore-Penrose pseudo-inverse"
    aliases: ClassVar[tuple[str, ...]] = ("pi", "mp")
    citation: ClassVar[str] = "Mao et al., IEEE Access 7 (2019), Eqs 5, 40"
    claims: ClassVar[frozenset[Claim]] = frozenset(Claim)

    sigma_floor: float = 1e-4

    def __post_init__(self) -> None:
        """Check the parameter."""
        check_parameters(self, positive=("sigma_floor",))

    def exact_above(self, array: CmgArray) -> float:
        """Return the floor."""
        return self.sigma_floor

    def step(self, array: CmgArray, obs: Observation, state: Any) -> tuple[Any, Any]:
        """Return the least rates that give hdot."""
        rows = linalg.rows(array.unit_jacobian(obs.delta), obs.hdot / array.mean_momentum)
        squares = ops.maximum(rows.squares, self.sigma_floor * self.sigma_floor)
        return rows.solve(squares), state
