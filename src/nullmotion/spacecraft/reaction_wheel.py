"""A reaction wheel that gives the torque a planar array cannot."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from nullmotion import ops
from nullmotion.array.model import CmgArray
from nullmotion.errors import InputError
from nullmotion.spacecraft.body import checked_vector

_NORMAL = 1e-9  # sine of the angle between the axis and the torque plane's normal


@dataclass(frozen=True, eq=False)
class ReactionWheel:
    """A wheel on a fixed axis a, with momentum h_w a beside the array's.

        h_w_dot = a . hdot_B within  |h_w_dot| <= torque_limit,  |h_w| <= momentum_limit

    at each sample of the law, held until the next. hdot_B is the rate of momentum that the
    controller wants of array and wheel together; the vehicle gets -h_w_dot a - omega x h_w a.
    The rotor's inertia is part of the spacecraft's: h_w is its momentum against the body.

    Args:
        axis: Unit vector a in B, (3,); normal to the array's torque plane.
        torque_limit: Largest torque [N m].
        momentum_limit: Momentum at the highest speed [N m s].
        momentum: Momentum at the start [N m s].

    Raises:
        InputError: For values that cannot be.
    """

    axis: np.ndarray
    torque_limit: Any = np.inf
    momentum_limit: Any = np.inf
    momentum: Any = 0.0

    def __post_init__(self) -> None:
        """Check the values."""
        axis = checked_vector("reaction_wheel.axis", self.axis)
        length = float(np.linalg.norm(axis))
        if length < 1e-6:
            raise InputError("reaction_wheel.axis", axis.tolist(), "a vector that is not zero")
        object.__setattr__(self, "axis", axis / length)
        for key in ("torque_limit", "momentum_limit"):
            if not getattr(self, key) > 0:
                raise InputError(f"reaction_wheel.{key}", getattr(self, key), "above 0")
            object.__setattr__(self, key, float(getattr(self, key)))
        if not abs(self.momentum) <= self.momentum_limit:
            allowed = f"at most the limit, {self.momentum_limit:g} N m s"
            raise InputError("reaction_wheel.momentum", self.momentum, allowed)
        object.__setattr__(self, "momentum", float(self.momentum))

    def check_beside(self, array: CmgArray) -> None:
        """Refuse an array with which the wheel does not give torque in three dimensions.

        Raises:
            InputError: Unless the axis is the normal of the array's torque plane.
        """
        basis = array.torque_axes
        assert basis is not None
        if len(basis) != 2 or np.abs(basis @ self.axis).max() > _NORMAL:
            allowed = "the normal of a planar array's torque plane"
            raise InputError("reaction_wheel.axis", self.axis.tolist(), allowed)

    def limited(self, wanted: Any, momentum: Any, period: Any) -> Any:
        """Return the rate of momentum over a period that the limits leave of one [N m]."""
        rate = ops.clip(wanted, -self.torque_limit, self.torque_limit)
        room = self.momentum_limit - momentum, self.momentum_limit + momentum
        return ops.clip(rate, -room[1] / period, room[0] / period)
