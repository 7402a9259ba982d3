"""Angle between the attitude and the one that is asked."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from nullmotion import rotation
from nullmotion.metrics.base import Metric, Reduction, Sample


@dataclass(frozen=True)
class PointingError(Metric):
    """theta = 2 atan2(|q_v|, |q_0|) of q_RN^-1 * q_BN, in degrees."""

    name: ClassVar[str] = "pointing_error_deg"
    title: ClassVar[str] = "pointing error"
    unit: ClassVar[str] = "deg"
    reductions: ClassVar[tuple[Reduction, ...]] = ("final", "max")
    needs_body: ClassVar[bool] = True

    def of(self, sample: Sample) -> Any:
        """Return the pointing error [deg]."""
        return np.degrees(1.0) * rotation.angle(sample.q_BR)
