"""Three orthogonal pairs: two CMGs with parallel gimbal axes in each coordinate plane."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from nullmotion.array.layout import Layout


@dataclass(frozen=True)
class OrthogonalPairs(Layout):
    """CMGs 1, 2 turn in the x-y plane, 3, 4 in y-z, 5, 6 in z-x.

        h_1, h_2 = (cos delta, sin delta, 0),    g = +z
        h_3, h_4 = (0, cos delta, sin delta),    g = +x
        h_5, h_6 = (sin delta, 0, cos delta),    g = +y

    Each body axis lies in two of the planes.
    """

    name: ClassVar[str] = "orthogonal_pairs"
    full_name: ClassVar[str] = "Three orthogonal pairs"
    aliases: ClassVar[tuple[str, ...]] = ("orthogonal-pairs",)
    citation: ClassVar[str] = "Elliott, dissertation (2019), Fig 3E"

    def axes(self) -> tuple[Any, Any]:
        """Return gimbal axes and spin axes."""
        gimbal = np.roll(np.eye(3), 1, axis=0)  # z, x, y
        return np.repeat(gimbal, 2, axis=0), np.repeat(np.eye(3), 2, axis=0)

    def home(self) -> Any:
        """Return opposed rotors in each plane [rad]: no momentum, A A^T = 2 I."""
        return np.tile([0.0, np.pi], 3)
