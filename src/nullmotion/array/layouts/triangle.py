"""The triangle: three CMGs with parallel gimbal axes, 120 deg apart."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from nullmotion.array.layout import Layout


@dataclass(frozen=True)
class Triangle(Layout):
    """Three planar CMGs whose angles are counted from directions 120 deg apart.

        t = delta + (2 pi/3, 0, -2 pi/3),    column i of A = h0 (cos t_i, sin t_i)

    so that h_i = h0 (sin t_i, -cos t_i, 0); gimbal axes +z, torque along x and y. The
    singular set is a family of lines along (1, 1, 1) in gimbal space.
    """

    name: ClassVar[str] = "triangle"
    full_name: ClassVar[str] = "Triangle (three parallel CMGs)"
    citation: ClassVar[str] = "Pereira (2022), Eq 7"

    def axes(self) -> tuple[Any, Any]:
        """Return gimbal axes and spin axes."""
        phase = np.array([2, 0, -2]) * np.pi / 3
        spin = np.stack([np.sin(phase), -np.cos(phase), np.zeros(3)], axis=1)
        return np.tile([0.0, 0.0, 1.0], (3, 1)), spin
