"""The roof: CMGs in two planes that meet in a ridge along the x axis."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from nullmotion.array.layout import Layout
from nullmotion.errors import InputError


@dataclass(frozen=True)
class Roof(Layout):
    """n/2 CMGs in each of two planes through x, inclined by -+skew from the x-y plane.

        h_i = (cos delta, cos(skew) sin delta, -sin(skew) sin delta)    first half of the CMGs
        h_i = (cos delta, cos(skew) sin delta, +sin(skew) sin delta)    second half

    At 45 deg the planes are orthogonal: four CMGs are then the box-90 turned by -45 deg about x.

    Args:
        skew: Inclination of each plane [rad].
        n: Number of CMGs, half of them in each plane.
    """

    name: ClassVar[str] = "roof"
    full_name: ClassVar[str] = "Roof"
    citation: ClassVar[str] = "Elliott, dissertation (2019), Ch. 4"

    skew: float = field(default=float(np.pi / 4), metadata={"unit": "deg"})
    n: int = 4

    def __post_init__(self) -> None:
        """Refuse planes that coincide, and CMGs that cannot be shared out evenly."""
        if not 0 < self.skew < np.pi / 2:
            raise InputError("array.skew", self.skew, "above 0, below pi/2 rad (90 deg)")
        if self.n < 4 or self.n % 2:
            raise InputError("array.n", self.n, "an even whole number from 4")

    def axes(self) -> tuple[Any, Any]:
        """Return gimbal axes and spin axes."""
        s, c = np.sin(self.skew), np.cos(self.skew)
        gimbal = np.repeat([[0.0, s, c], [0.0, -s, c]], self.n // 2, axis=0)
        return gimbal, np.tile([1.0, 0.0, 0.0], (self.n, 1))

    def home(self) -> Any:
        """Return zero-momentum angles [rad]: each plane spread evenly, two in a plane biased.

        Two CMGs in a plane hold +-2 cos(theta) along x (evenly spread they would be in line);
        A A^T = diag(4 s^2, 4 c^2 cos^2 skew, 4 c^2 sin^2 skew), and theta maximises its least.
        """
        if self.n > 4:
            half = 4 * np.pi * np.arange(self.n // 2) / self.n
            return np.concatenate([half, half])
        theta = np.arctan(min(np.sin(self.skew), np.cos(self.skew)))
        return np.array([theta, -theta, np.pi - theta, np.pi + theta])
