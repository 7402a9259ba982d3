"""Generalised singularity-robust inverse: damping with a dither that breaks deadlocks."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from nullmotion.array.model import CmgArray
from nullmotion.law import Claim, Law, Observation
from nullmotion.laws._dither import check_dither, dithered_rates


@dataclass(frozen=True)
class GeneralisedSingularityRobust(Law):
    """The singularity-robust inverse with a time-varying, off-diagonal damping.

        delta_dot = A^T (A A^T + mu E)^-1 hdot
        E   = [[1, e3, e2], [e3, 1, e1], [e2, e1, 1]],  e_i = epsilon0 sin(omega t + phase_i)
        mu  = mu0 exp(-kappa det(A A^T))

    A and hdot are divided by the mean momentum. The e_i leave no state at which a
    command along the singular direction moves no gimbal. With two torque dimensions E
    is its upper left corner. mu never vanishes quite: the torque is not exact.

    Args:
        epsilon0: Amplitude of the dither, below 1/2 (E stays positive definite).
        mu0: Damping at a singular state.
        kappa: Decay of the damping with det(A A^T).
        omega: Frequency of the dither [rad/s]; None for reference_rate / pi.
        phase: Phases of e1, e2, e3 [rad]; Mao's Table 1 has pi/2 for all.
        as_published: The reading under which Mao's tables come back: W = I with mu off
            its diagonal as in `odsr`, and a clock half a step ahead, t + period/2.
    """

    name: ClassVar[str] = "gsr"
    full_name: ClassVar[str] = "Generalised singularity-robust inverse"
    aliases: ClassVar[tuple[str, ...]] = ("generalized-singularity-robust",)
    citation: ClassVar[str] = "Wie, Bailey & Heiberg, J. Guid. Control Dyn. 24 (2001), 865-872"
    claims: ClassVar[frozenset[Claim]] = frozenset(
        {Claim.FINITE, Claim.BOUNDED, Claim.SCALING, Claim.HOMOGENEOUS, Claim.STATELESS}
    )

    epsilon0: float = 0.1
    mu0: float = 0.01
    kappa: float = 10.0
    omega: float | None = None
    phase: tuple[float, float, float] = (0.5 * np.pi, 0.5 * np.pi, 0.5 * np.pi)
    as_published: bool = False

    def __post_init__(self) -> None:
        """Check the parameters."""
        check_dither(self)

    def step(self, array: CmgArray, obs: Observation, state: Any) -> tuple[Any, Any]:
        """Return the dithered, damped rates."""
        return dithered_rates(self, array, obs, np.ones(array.n), self.as_published), state
