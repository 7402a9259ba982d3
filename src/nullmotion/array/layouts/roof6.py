"""The six-CMG roof: three CMGs in each of two orthogonal planes that share the x axis."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from nullmotion.array.layout import Layout


@dataclass(frozen=True)
class Roof6(Layout):
    """CMGs 1 to 3 turn in the x-y plane, CMGs 4 to 6 in the x-z plane: box-90's planes.

        h_1..3 = (cos delta, sin delta, 0),    g = +z
        h_4..6 = (cos delta, 0, sin delta),    g = -y

    `Roof` with n = 6 at 45 deg is the same array turned by -45 deg about x.
    """

    name: ClassVar[str] = "roof6"
    full_name: ClassVar[str] = "Six-CMG roof"
    aliases: ClassVar[tuple[str, ...]] = ("roof-6",)
    citation: ClassVar[str] = "Elliott, dissertation (2019), Fig 3C"

    def axes(self) -> tuple[Any, Any]:
        """Return gimbal axes and spin axes."""
        gimbal = np.repeat([[0.0, 0.0, 1.0], [0.0, -1.0, 0.0]], 3, axis=0)
        return gimbal, np.tile([1.0, 0.0, 0.0], (6, 1))

    def home(self) -> Any:
        """Return angles 120 deg apart in each plane [rad]: A A^T = diag(3, 3/2, 3/2)."""
        return np.tile(2 * np.pi * np.arange(3) / 3, 2)
