"""Impulse across the commanded direction."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from nullmotion import linalg
from nullmotion.metrics.base import Metric, Reduction, Sample


@dataclass(frozen=True)
class OffAxisImpulse(Metric):
    """|L - (L . e) e| of the impulse L = integral of A delta_dot, e = hdot / |hdot|.

    All of |L| without a command.
    """

    name: ClassVar[str] = "off_axis_impulse_Nms"
    title: ClassVar[str] = "off-axis impulse"
    unit: ClassVar[str] = "N m s"
    citation: ClassVar[str] = "Mao et al., IEEE Access 7 (2019), Table 7"
    reductions: ClassVar[tuple[Reduction, ...]] = ("final",)

    def of(self, sample: Sample) -> Any:
        """Return the impulse across the commanded direction [N m s]."""
        e = sample.direction
        return linalg.norm(sample.impulse - (sample.impulse @ e) * e)
