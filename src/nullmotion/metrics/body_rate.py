"""Body rate."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from nullmotion import linalg
from nullmotion.metrics.base import Metric, Reduction, Sample


@dataclass(frozen=True)
class BodyRate(Metric):
    """|omega_BN|, in degrees per second."""

    name: ClassVar[str] = "body_rate_deg_s"
    title: ClassVar[str] = "body rate"
    unit: ClassVar[str] = "deg/s"
    reductions: ClassVar[tuple[Reduction, ...]] = ("max", "final")
    needs_body: ClassVar[bool] = True

    def of(self, sample: Sample) -> Any:
        """Return the length of the body rate [deg/s]."""
        return np.degrees(1.0) * linalg.norm(sample.omega_BN_B)
