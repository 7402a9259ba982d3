"""Non-directional null motion: keep moving through the null space, whatever the command."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from nullmotion import linalg, ops
from nullmotion.array.model import CmgArray
from nullmotion.law import Claim, Law, Observation, check_parameters

_FLOOR = 1e-4
_LEAST_MEASURE = 1e-3  # m^-6 stays below 1e18


@dataclass(frozen=True)
class NonDirectionalNullMotion(Law):
    """Pseudo-inverse rates and null motion by the singularity measure alone.

        delta_dot = A^+ hdot + lambda z,   lambda = gain m^6 if m >= 1 else gain m^-6
        m = sqrt(det(A A^T)) = sigma_1 sigma_2 sigma_3

    A and hdot are divided by the mean momentum. z is the unit vector along the signed
    minors of A: A z = 0, and unlike a singular vector, whose sign is arbitrary, it turns
    continuously. With more than one degree of freedom, z is along the sum of the minors'
    vectors over all choices of m + 1 columns.

    m^-6 grows without limit towards a singular state and m^6 with the number of CMGs;
    scaled to a rate limit, such null motion leaves no torque. The rates of the null
    motion therefore stay below the array's reference rate; the paper's runs do without.

    Args:
        gain: Rate at m = 1 [rad/s]; None for reference_rate / pi.
        as_published: No limit on the null motion.
    """

    name: ClassVar[str] = "nd"
    full_name: ClassVar[str] = "Non-directional null motion"
    aliases: ClassVar[tuple[str, ...]] = ("non-directional",)
    citation: ClassVar[str] = (
        "Bedrossian et al., J. Guid. Control Dyn. 13 (1990); Mao et al., IEEE Access 7 (2019), Eq 7"
    )
    claims: ClassVar[frozenset[Claim]] = frozenset(Claim) - {Claim.BOUNDED, Claim.HOMOGENEOUS}

    gain: float | None = None
    as_published: bool = False

    def __post_init__(self) -> None:
        """Check the gain."""
        check_parameters(self, not_negative=("gain",))

    def supports(self, array: CmgArray) -> str:
        """Ask for a null space."""
        if array.n > array.m:
            return ""
        return f"{array.n} CMGs leave no null motion beside {array.m} torque dimensions"

    def exact_above(self, array: CmgArray) -> float:
        """Return the floor of the singular values."""
        return _FLOOR

    def step(self, array: CmgArray, obs: Observation, state: Any) -> tuple[Any, Any]:
        """Return least rates and null motion."""
        A = array.unit_jacobian(obs.delta)
        rows = linalg.rows(A, obs.hdot / array.mean_momentum)
        squares = ops.maximum(rows.squares, _FLOOR * _FLOOR)
        rates = rows.solve(squares)
        minors = linalg.null_vector(A)
        length = linalg.norm(minors)
        z = minors / ops.where(ops.less(1e-12, length), length, 1.0)
        measure = ops.sqrt(ops.maximum(np.prod(rows.squares), _LEAST_MEASURE**2))
        gain = array.reference_rate / np.pi if self.gain is None else self.gain
        size = gain * ops.maximum(measure, 1.0 / measure) ** 6
        if not self.as_published:
            size = ops.minimum(size, array.reference_rate)
        return rates + size * z, state
