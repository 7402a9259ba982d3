"""Off-diagonal singularity-robust inverse: weights that avoid, a dither that escapes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from nullmotion.array.model import CmgArray
from nullmotion.errors import InputError
from nullmotion.law import Claim, Law, Observation, check_parameters
from nullmotion.laws._dither import check_dither, dithered_rates


@dataclass(frozen=True)
class OffDiagonalSingularityRobust(Law):
    """`gsr` with weights on the gimbals, coupled near a singular state.

        delta_dot = W A^T (A W A^T + V)^-1 hdot,  V = mu E,  mu = mu0 exp(-kappa det(A A^T))
        W = diag(w) + mu (ones - I)
        E = [[1, e3, e2], [e3, 1, e1], [e2, e1, 1]],  e_i = epsilon0 sin(omega t + phase_i)

    A and hdot are divided by the mean momentum. A gimbal of small weight holds back and
    so leads the array past singular states; which one should is a matter of the
    manoeuvre. Mao's ODSR1 has w = (0.01, 1, 1, 1), the default; ODSR2 (1, 0.01, 1, 1).

    Args:
        epsilon0: Amplitude of the dither, below 1/2.
        mu0: Damping at a singular state; not above the least weight (W stays positive).
        kappa: Decay of the damping with det(A A^T).
        omega: Frequency of the dither [rad/s]; None for reference_rate / pi.
        phase: Phases of e1, e2, e3 [rad].
        w: Diagonal of W, one number for each CMG; None for (0.01, 1, ..., 1).
        as_published: The reading under which Mao's tables come back: a clock half a step
            ahead, t + period/2.
    """

    name: ClassVar[str] = "odsr"
    full_name: ClassVar[str] = "Off-diagonal singularity-robust inverse"
    aliases: ClassVar[tuple[str, ...]] = ("off-diagonal-singularity-robust",)
    citation: ClassVar[str] = (
        "Wie, J. Guid. Control Dyn. 28 (2005), 948-956; Mao et al., IEEE Access 7 (2019), Eqs 8-12"
    )
    claims: ClassVar[frozenset[Claim]] = frozenset(
        {Claim.FINITE, Claim.BOUNDED, Claim.SCALING, Claim.HOMOGENEOUS, Claim.STATELESS}
    )

    epsilon0: float = 0.1
    mu0: float = 0.01
    kappa: float = 10.0
    omega: float | None = None
    phase: tuple[float, float, float] = (0.5 * np.pi, 0.5 * np.pi, 0.5 * np.pi)
    w: tuple[float, ...] | None = None
    as_published: bool = False

    def __post_init__(self) -> None:
        """Check the parameters."""
        check_dither(self)
        if self.w is not None:
            object.__setattr__(self, "w", tuple(np.ravel(self.w)))
        check_parameters(self, positive=("w",))
        if min(self.w or (0.01,)) < self.mu0:
            raise InputError("law.mu0", self.mu0, "not above the least weight in law.w")

    def supports(self, array: CmgArray) -> str:
        """Ask for one weight a CMG."""
        given = array.n if self.w is None else len(self.w)
        return "" if given == array.n else f"law.w has {given} weights, the array {array.n} CMGs"

    def step(self, array: CmgArray, obs: Observation, state: Any) -> tuple[Any, Any]:
        """Return the weighted, dithered rates."""
        first = (0.01,) + (1.0,) * (array.n - 1)
        weights = np.array(first if self.w is None else self.w)
        return dithered_rates(self, array, obs, weights, True), state
