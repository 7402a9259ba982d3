"""The gimbals' squared rates."""

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
class Energy(Cost):
    """Minus the mean of |delta_dot|^2 over the run [rad^2/s^2], to be maximised.

    Times the duration it is the integral of the squared rates, which the viscous losses of
    the gimbals follow.
    """

    name: ClassVar[str] = "energy"
    title: ClassVar[str] = "- mean squared rates"
    citation: ClassVar[str] = "Geng, Hou & Huang, J. Guid. Control Dyn. 40 (2017)"

    def terms(self, setup: Setup) -> tuple[Metric, ...]:
        """Return the squared rates."""
        return (terms.SquaredRates(),)

    def value(self, totals: np.ndarray, samples: int) -> Any:
        """Return minus the mean."""
        return -totals[0] / samples

    def bound(self, totals: np.ndarray, done: int, samples: int, array: CmgArray) -> Any:
        """Return the value if the gimbals stood still from now on."""
        return -totals[0] / samples

    def parts(self, totals: np.ndarray, samples: int) -> dict[str, Any]:
        """Return the mean squared rates."""
        return {"mean_squared_rates_rad2_s2": totals[0] / samples}
