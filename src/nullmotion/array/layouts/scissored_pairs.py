"""Three scissored pairs: each pair gives torque along one body axis."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from nullmotion.array.layout import Layout


@dataclass(frozen=True)
class ScissoredPairs(Layout):
    """CMGs (1, 2), (3, 4), (5, 6) with torque axes t = x, y, z and s = y, z, x.

        h_a = h0 (s cos delta_a + t sin delta_a),    h_b = -h0 (s cos delta_b + t sin delta_b)

    With delta_b = -delta_a the pair's sum is 2 h0 t sin delta_a: along one axis only.
    """

    name: ClassVar[str] = "scissored_pairs"
    full_name: ClassVar[str] = "Three scissored pairs"
    aliases: ClassVar[tuple[str, ...]] = ("scissored-pairs",)
    citation: ClassVar[str] = "Brown and Peck, J. Guid. Control Dyn. 31 (2008)"

    def axes(self) -> tuple[Any, Any]:
        """Return gimbal axes and spin axes."""
        along = np.eye(3)
        spin = np.roll(along, -1, axis=0)  # y, z, x
        gimbal = np.cross(spin, along)
        return np.repeat(gimbal, 2, axis=0), np.stack([spin, -spin], axis=1).reshape(6, 3)
