"""Momentum reserve: how far the array is from saturation along the command."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from nullmotion import linalg, ops
from nullmotion.array.momentum_state import command_direction
from nullmotion.metrics.base import Metric, Reduction, Sample

_ALONG_AXIS = 1e-12  # sine of the angle between command and gimbal axis; below it is rounding


@dataclass(frozen=True)
class MomentumReserve(Metric):
    """|sum_i h_i^s + bias| - |h|, with every rotor turned as far along the command as it goes.

        h_i^s = h0_i p_i / |p_i|,    p_i = e - (g_i . e) g_i,    e = hdot / |hdot|

    A CMG whose gimbal axis is along e adds nothing, nor does any when nothing is commanded.
    """

    name: ClassVar[str] = "momentum_reserve_Nms"
    title: ClassVar[str] = "momentum reserve"
    unit: ClassVar[str] = "N m s"
    citation: ClassVar[str] = "Mao et al., IEEE Access 7 (2019), Tables 4 to 6"
    reductions: ClassVar[tuple[Reduction, ...]] = ("final",)

    def of(self, sample: Sample) -> Any:
        """Return the momentum at saturation less the momentum now [N m s]."""
        array = sample.working
        e = command_direction(array, sample.hdot)
        p = e - (array.gimbal_axes @ e)[:, None] * array.gimbal_axes
        length = ops.sqrt((p * p).sum(axis=1))
        turned = ops.less(_ALONG_AXIS, length)
        share = ops.where(turned, array.h0 / ops.where(turned, length, 1.0), 0.0)
        saturated = array.torque_axes @ (share @ p + array.momentum_bias)
        return linalg.norm(saturated) - linalg.norm(sample.momentum)
