"""Axes of VSCMG units at their gimbal angles."""

from __future__ import annotations

from typing import Any, NamedTuple

from nullmotion import ops
from nullmotion.array.model import CmgArray


class Axes(NamedTuple):
    """Unit axes at some gimbal angles, one row for each CMG, (n, 3)."""

    s: Any
    t: Any
    g: Any


def axes(array: CmgArray, delta: Any) -> Axes:
    """Return the units' axes in B at gimbal angles [rad]."""
    c, d = ops.cos(delta)[:, None], ops.sin(delta)[:, None]
    s0, t0 = array.spin_axes, array.transverse_axes
    return Axes(c * s0 + d * t0, c * t0 - d * s0, array.gimbal_axes)


def outer_sum(weights: Any, directions: Any) -> Any:
    """Return sum_i w_i v_i v_i^T, (3, 3)."""
    return (directions.T * weights) @ directions
