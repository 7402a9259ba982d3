"""The least manipulability on the way."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from nullmotion.array.model import CmgArray
from nullmotion.metrics.base import Metric
from nullmotion.plan import terms
from nullmotion.plan.cost import Cost, greatest_manipulability
from nullmotion.sim.setup import Setup


@dataclass(frozen=True)
class MinManipulability(Cost):
    """Least sqrt(det(A A^T)) of A / mean momentum over the run, to be maximised."""

    name: ClassVar[str] = "min-manipulability"
    title: ClassVar[str] = "least manipulability"
    citation: ClassVar[str] = "Papakonstantinou et al. (2021), Sec. V"

    def terms(self, setup: Setup) -> tuple[Metric, ...]:
        """Return the manipulability."""
        return (terms.LeastManipulability(),)

    def value(self, totals: np.ndarray, samples: int) -> Any:
        """Return the least manipulability."""
        return totals[0]

    def bound(self, totals: np.ndarray, done: int, samples: int, array: CmgArray) -> Any:
        """Return the least so far: it cannot grow again."""
        return np.minimum(totals[0], greatest_manipulability(array, "sqrt-det"))

    def parts(self, totals: np.ndarray, samples: int) -> dict[str, Any]:
        """Return the least manipulability."""
        return {"least_manipulability": totals[0]}
