"""Momentum held by the array."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from nullmotion import linalg
from nullmotion.metrics.base import Metric, Reduction, Sample


@dataclass(frozen=True)
class Momentum(Metric):
    """|h(delta)|."""

    name: ClassVar[str] = "momentum_Nms"
    title: ClassVar[str] = "array momentum"
    unit: ClassVar[str] = "N m s"
    reductions: ClassVar[tuple[Reduction, ...]] = ("max", "final")

    def of(self, sample: Sample) -> Any:
        """Return the length of the array's momentum [N m s]."""
        return linalg.norm(sample.momentum)
