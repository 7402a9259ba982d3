"""The control moment gyroscope of a rover.

    h_cmg = h s,   s = s0 cos(delta) + o0 sin(delta),   o = g x s

A step over an edge turns about r; the CMG drives it through o . r (Elliott 2019, Chapter 5).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from nullmotion.errors import InputError
from nullmotion.rover.chassis import positive
from nullmotion.spacecraft.body import checked_vector


@dataclass(frozen=True, eq=False)
class Cmg:
    """The rover's control moment gyroscope, fixed in the chassis.

    Args:
        gimbal_axis: g in body axes; normalised here, (3,).
        spin_axis: s at delta = 0; made perpendicular to g and normalised here, (3,).
        momentum: h [N m s].
        rate_limit: Greatest gimbal rate [rad/s].
        acceleration_limit: Greatest gimbal acceleration [rad/s^2].
        inertia: Rotor and gimbal together along s, g, o [kg m^2], (3,): I_r + I_g.
        rotor_inertia: Rotor about its spin axis [kg m^2].
        rotor_speed: Speed of the rotor against the gimbal, held by its motor [rad/s].

    `momentum` acts in the dynamics; `rotor_inertia * rotor_speed` in the energy of Eq 88, as
    Table 2 gives both (115 and 112 N m s for PETER).

    Raises:
        InputError: For a value that is not finite or not above 0, or s along g.
    """

    gimbal_axis: np.ndarray
    spin_axis: np.ndarray
    momentum: float
    rate_limit: float
    acceleration_limit: float
    inertia: np.ndarray = field(default_factory=lambda: np.zeros(3))
    rotor_inertia: float = 0.0
    rotor_speed: float = 0.0

    def __post_init__(self) -> None:
        """Check what can be checked."""
        put = object.__setattr__
        g = _unit("gimbal_axis", self.gimbal_axis)
        s = _unit("spin_axis", self.spin_axis)
        put(self, "gimbal_axis", g)
        put(self, "spin_axis", _unit("spin_axis", s - (s @ g) * g, "a direction away from g"))
        for key in ("momentum", "rate_limit", "acceleration_limit"):
            put(self, key, positive(key, getattr(self, key)))
        put(self, "inertia", checked_vector("inertia", self.inertia))
        values = [*self.inertia, self.rotor_inertia, self.rotor_speed]
        if not all(0 <= value < np.inf for value in values):
            raise InputError("inertia, rotor_inertia, rotor_speed", values, "0 or more")

    def axes(self, delta: Any) -> tuple[Any, Any, Any]:
        """Return s, g, o at a gimbal angle, in body axes."""
        c, s = np.cos(delta), np.sin(delta)
        g, s0 = self.gimbal_axis, self.spin_axis
        o0 = np.cross(g, s0)
        return c * s0 + s * o0, g, c * o0 - s * s0


def _unit(key: str, value: Any, allowed: str = "a vector that is not zero") -> np.ndarray:
    v = checked_vector(key, value)
    length = float(np.linalg.norm(v))
    if length < 1e-9:
        raise InputError(key, v.tolist(), allowed)
    return v / length
