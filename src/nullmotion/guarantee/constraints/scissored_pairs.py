"""Scissored pairs: two CMGs that turn by opposite angles."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from nullmotion import ops
from nullmotion.guarantee.constraint import Constraint


@dataclass(frozen=True)
class ScissoredPairs(Constraint):
    """Each pair holds the momentum along one axis: delta_a = asin(h/2), delta_b = -delta_a.

    A pair gives torque along its axis alone, 2 cos delta_a of the rate, so that
    TC = min sqrt(4 - h_i^2): 2 without momentum, and no singularity but saturation, |h_i| = 2.
    """

    name: ClassVar[str] = "scissored-pairs"
    full_name: ClassVar[str] = "Three scissored pairs"
    aliases: ClassVar[tuple[str, ...]] = ("scissored_pairs",)
    citation: ClassVar[str] = "Brown and Peck, J. Guid. Control Dyn. 31 (2008)"
    layout: ClassVar[str] = "scissored_pairs"

    @property
    def reach(self) -> float:
        """Corner of the envelope, a cube."""
        return float(2 * np.sqrt(3.0))

    def angles(self, h: Any) -> Any:
        """Return the gimbal angles [rad], (6,)."""
        half = [0.5 * np.pi - ops.acos(ops.clip(0.5 * c, -1.0, 1.0)) for c in h]
        return np.array([sign * a for a in half for sign in (1.0, -1.0)])

    def inside(self, h: Any) -> Any:
        """Return whether every |h_i| < 2."""
        return ops.less(ops.amax(ops.absolute(h)), 2.0)

    def gimbal_jacobian(self, h: Any) -> Any:
        """Return d angles / d h, (6, 3)."""
        rates = [1.0 / ops.sqrt(s) for s in self._slack(h)]
        return np.array([[sign * rates[i] * float(i == j) for j in range(3)]
                         for i in range(3) for sign in (1.0, -1.0)])  # fmt: skip

    def squares(self, h: Any) -> Any:
        """Return the squared row norms, one a pair."""
        return np.array([1.0 / s for s in self._slack(h)])

    def edges(self, h: Any) -> list[Any]:
        """Return |h_i| - 2."""
        return [ops.absolute(c) - 2.0 for c in h]

    def _slack(self, h: Any) -> list[Any]:
        return [4.0 - c * c for c in h]
