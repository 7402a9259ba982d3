"""The box-90: two pairs of CMGs in two orthogonal planes that share the x axis."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from nullmotion.array.layout import Layout


@dataclass(frozen=True)
class Box90(Layout):
    """CMGs 1, 2 turn in the x-y plane, CMGs 3, 4 in the x-z plane.

        h_1, h_2 = (cos delta, sin delta, 0),    g = +z
        h_3, h_4 = (cos delta, 0, sin delta),    g = -y

    The planes share the x axis only.
    """

    name: ClassVar[str] = "box90"
    full_name: ClassVar[str] = "Box-90 (four-CMG roof)"
    aliases: ClassVar[tuple[str, ...]] = ("box-90",)
    citation: ClassVar[str] = "Elliott, dissertation (2019), Ch. 4 and Fig 16"

    def axes(self) -> tuple[Any, Any]:
        """Return gimbal axes and spin axes."""
        gimbal = [[0, 0, 1], [0, 0, 1], [0, -1, 0], [0, -1, 0]]
        return np.array(gimbal, float), np.tile([1.0, 0.0, 0.0], (4, 1))

    def home(self) -> Any:
        """Return the zero-momentum angles of greatest sigma_min (2/sqrt 3) [rad].

        The planes hold +-2 cos(theta) along x; A A^T = diag(4 s^2, 2 c^2, 2 c^2), equal at
        tan^2(theta) = 1/2.
        """
        theta = np.arctan(np.sqrt(0.5))
        return np.array([theta, -theta, np.pi - theta, np.pi + theta])
