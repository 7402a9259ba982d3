"""The greatest gimbal rate."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from nullmotion.array.model import CmgArray
from nullmotion.metrics.base import Metric
from nullmotion.plan import terms
from nullmotion.plan.cost import Cost
from nullmotion.sim.setup import Setup


@dataclass(frozen=True)
class PeakRate(Cost):
    """Minus the greatest |delta_dot_i| of the run [rad/s], to be maximised."""

    name: ClassVar[str] = "peak-rate"
    title: ClassVar[str] = "- peak rate"

    def terms(self, setup: Setup) -> tuple[Metric, ...]:
        """Return the greatest rate."""
        return (terms.GreatestRate(),)

    def value(self, totals: np.ndarray, samples: int) -> Any:
        """Return minus the greatest rate."""
        return -totals[0]

    def bound(self, totals: np.ndarray, done: int, samples: int, array: CmgArray) -> Any:
        """Return minus the greatest rate so far: it cannot shrink again."""
        return np.minimum(-totals[0], 0.0)

    def parts(self, totals: np.ndarray, samples: int) -> dict[str, Any]:
        """Return the greatest rate."""
        return {"peak_rate_rad_s": totals[0]}
