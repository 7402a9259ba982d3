"""The planar array: parallel gimbal axes, torque in two dimensions."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from nullmotion.array.layout import Layout
from nullmotion.errors import InputError


@dataclass(frozen=True)
class Planar(Layout):
    """n CMGs with gimbal axis z: h_i = (cos delta_i, sin delta_i, 0), torque along x and y.

    Args:
        n: Number of CMGs.
    """

    name: ClassVar[str] = "planar"
    full_name: ClassVar[str] = "Planar"
    citation: ClassVar[str] = "Elliott, dissertation (2019), Ch. 3"

    n: int = 4

    def __post_init__(self) -> None:
        """Refuse an array without freedom to turn its momentum."""
        if self.n < 2 or self.n % 1:
            raise InputError("array.n", self.n, "a whole number from 2")

    def axes(self) -> tuple[Any, Any]:
        """Return gimbal axes and spin axes."""
        return np.tile([0.0, 0.0, 1.0], (self.n, 1)), np.tile([1.0, 0.0, 0.0], (self.n, 1))

    def home(self) -> Any:
        """Return evenly spread angles [rad]: no momentum, A A^T = (n/2) I.

        Two CMGs are singular without momentum: they start at right angles instead.
        """
        if self.n == 2:
            return np.array([-0.25 * np.pi, 0.25 * np.pi])
        return 2 * np.pi * np.arange(self.n) / self.n
