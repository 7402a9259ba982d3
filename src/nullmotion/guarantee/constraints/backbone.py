"""Planar array: the circular backbone of the robotics literature."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from nullmotion import ops
from nullmotion.guarantee._planar import PlanarConstraint, checked_count
from nullmotion.guarantee.region import Box, Region

_STEPS = 18  # Newton from one side: halves the way while two roots look like one (H near n)


@dataclass(frozen=True)
class Backbone(PlanarConstraint):
    """n >= 3 CMGs with one gimbal axis, in equal steps of angle: the rotors form an arc.

        delta_i = (i - (n+1)/2) phi,    sin(n phi/2) = H sin(phi/2),    phi in [0, 2 pi/n]

    phi is found by Newton's method from 2 pi/n, from where it falls to the root without
    passing it: the function is concave wherever it exceeds the chord.

    Args:
        n: Number of CMGs.
    """

    name: ClassVar[str] = "backbone"
    full_name: ClassVar[str] = "Planar, circular backbone"
    aliases: ClassVar[tuple[str, ...]] = ("circular-backbone",)
    citation: ClassVar[str] = "Chirikjian and Burdick (1994), in Elliott (2019), Section 3.3"

    n: int = 5

    def __post_init__(self) -> None:
        """Refuse two CMGs: they have no null motion."""
        checked_count(self.n)

    def step_angle(self, H: Any) -> Any:
        """Return phi [rad] for a momentum of size H; source."""
        n = float(self.n)
        phi = 2 * np.pi / n
        for _ in range(_STEPS):
            wide, narrow = 0.5 * n * phi, 0.5 * phi
            value = ops.sin(wide) - H * ops.sin(narrow)
            slope = 0.5 * (n * ops.cos(wide) - H * ops.cos(narrow))
            phi = ops.clip(phi - value / slope, 0.0, 2 * np.pi / n)
        return phi

    def half(self, H: Any) -> list[tuple[Any, int]]:
        """Return the cosines of the positive half of the angles, the greatest angle first."""
        return self._half_cosines(self.step_angle(H))

    def claim(self, radius: float, torque_capability: float) -> tuple[Callable[[Any], Any], Region]:
        """Return source over phi: where the momentum is at most the radius, TC holds.

        H(phi) = sum cos delta_i falls from n to 0 as every |delta_i| grows within [0, pi).
        """

        def margins(x: Any) -> Any:
            half = self._half_cosines(x[0])
            beyond = radius - (2.0 * sum(c for c, _ in half) + float(self.n % 2))
            # cleared of fractions: the arc closes up to a line at phi = 0, beyond the radius
            along, across = (v * v for v in self.spread(half))
            squared = [c * c for c, _ in half] + [1.0] * (self.n % 2)
            rows = [
                torque_capability**2 * ((1.0 - q) * along + q * across) - along * across
                for q in squared
            ]
            return np.array([*(ops.minimum(row, beyond) for row in rows), radius - float(self.n)])

        return margins, Box((0.0,), (2 * np.pi / self.n * (1 + 1e-15),))

    def momentum_of(self, point: Any) -> Any:
        """Return the momentum along x of the arc with step point[0]."""
        size = 2.0 * sum(c for c, _ in self._half_cosines(point[0])) + float(self.n % 2)
        return np.array([size, 0.0 * size])

    def offsets(self, H: Any) -> Any:
        """Return gimbal angles from the momentum's direction [rad], (n,), rising."""
        half = self._half_angles(self.step_angle(H))
        return np.array([*[-a for a in half], *[0.0] * (self.n % 2), *half[::-1]])

    def _half_cosines(self, phi: Any) -> list[tuple[Any, int]]:
        return [(ops.cos(a), 1) for a in self._half_angles(phi)]

    def _half_angles(self, phi: Any) -> list[Any]:
        return [(i - (self.n + 1) / 2) * phi for i in range(self.n, (self.n + 1) // 2, -1)]
