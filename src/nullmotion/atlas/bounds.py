"""A number that is known from both sides."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np


@dataclass(frozen=True, eq=False)
class Bounds:
    """A number between two bounds.

    Attributes:
        lower: Lower bound.
        upper: Upper bound.
        at: Where the number is found, if that is a momentum [N m s], along the torque axes and
            without the array's bias, (m,): for a radius one that is not reachable, or has no
            room beyond it; for a greatest momentum one of that size.
        estimate: Value between the bounds, where there is one.
        basis: What the bounds rest on.
        seconds: Time it took [s].
    """

    lower: float
    upper: float
    at: np.ndarray | None = None
    estimate: float | None = None
    basis: str = ""
    seconds: float = 0.0

    @property
    def value(self) -> float:
        """The estimate, or the mean of both bounds."""
        return 0.5 * (self.lower + self.upper) if self.estimate is None else self.estimate

    @property
    def gap(self) -> float:
        """Difference of the bounds over the upper one; 0 where that is 0."""
        return (self.upper - self.lower) / self.upper if self.upper > 0 else 0.0

    def as_dict(self) -> dict[str, Any]:
        """Return the bounds for a JSON file."""
        at = None if self.at is None else [float(v) for v in self.at]
        found = {"lower": self.lower, "upper": self.upper, "at": at, "basis": self.basis}
        if self.estimate is not None:
            found["estimate"] = self.estimate
        return found | {"seconds": round(self.seconds, 3)}
