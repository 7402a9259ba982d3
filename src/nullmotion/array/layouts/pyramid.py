"""The pyramid: gimbal axes normal to the faces of a pyramid on a regular polygon."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from nullmotion.array.layout import Layout
from nullmotion.errors import InputError


@dataclass(frozen=True)
class Pyramid(Layout):
    """n gimbal axes at skew beta around +z, azimuth psi_i = 2 pi i / n.

        g_i = (sin beta cos psi_i, sin beta sin psi_i, cos beta)
        s_i = (-sin psi_i, cos psi_i, 0)

    For n = 4: g = (sB,0,cB), (0,sB,cB), (-sB,0,cB), (0,-sB,cB) and s = +y, -x, -y, +x.

    Args:
        skew: Angle beta between gimbal axes and z [rad]; 54.73 deg gives a nearly
            spherical momentum envelope.
        n: Number of CMGs.
    """

    name: ClassVar[str] = "pyramid"
    full_name: ClassVar[str] = "Pyramid"
    citation: ClassVar[str] = (
        "Mao et al., IEEE Access 7 (2019), Fig 2; Papakonstantinou et al. (2021), Eq 6"
    )

    skew: float = field(default=float(np.radians(54.73)), metadata={"unit": "deg"})
    n: int = 4

    def __post_init__(self) -> None:
        """Refuse a flat or impossible pyramid."""
        if not 0 < self.skew <= np.pi / 2:
            raise InputError("array.skew", self.skew, "above 0, at most pi/2 rad (90 deg)")
        if self.n < 3 or self.n % 1:
            raise InputError("array.n", self.n, "a whole number from 3")

    def axes(self) -> tuple[Any, Any]:
        """Return gimbal axes and spin axes."""
        psi = 2 * np.pi * np.arange(self.n) / self.n
        s, c = np.sin(self.skew), np.cos(self.skew)
        gimbal = np.stack([s * np.cos(psi), s * np.sin(psi), np.full(self.n, c)], axis=1)
        return gimbal, np.stack([-np.sin(psi), np.cos(psi), np.zeros(self.n)], axis=1)
