"""Ground under the spikes: how it yields, damps and holds.

    F_n = K_c s - C_c z'   upwards only            F_t = -C_d v_t,  |F_t| <= mu F_n

s is the sinkage of a spike, z' its speed off the ground, v_t its speed along it. The default is
the stiff rock of Elliott 2019, Table 3, which holds whatever pulls along it. A spike there creeps:
with C_c / K_c = 10 s it takes that long to sink under a load, and it slides 1 mm/s under 100 N.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from nullmotion.errors import InputError
from nullmotion.rover.contact_forces import GroundNumbers

_GRIP = 0.01  # of the weight
_HIGHEST = 1e12  # beyond it rounding moves the ground more than the rover does


@dataclass(frozen=True)
class Ground:
    """Spring, dampers and friction at each spike.

    Args:
        stiffness: K_c, across the ground [N/m].
        damping: C_c, across the ground [N s/m].
        drag: C_d, along the ground [N s/m].
        friction: mu, greatest force along the ground over that across it; None: without bound.
        name: What to call it.

    Raises:
        InputError: For a stiffness that is not above 0, or another value below 0.
    """

    stiffness: float = 1e5
    damping: float = 1e6
    drag: float = 1e5
    friction: float | None = None
    name: str = "rock"

    def __post_init__(self) -> None:
        """Check what can be checked."""
        put = object.__setattr__
        put(self, "stiffness", _number("stiffness", self.stiffness, above=True))
        put(self, "damping", _number("damping", self.damping))
        put(self, "drag", _number("drag", self.drag))
        if self.friction is not None:
            put(self, "friction", _number("friction", self.friction))

    def numbers(self, weight: float, friction: float | None = None) -> GroundNumbers:
        """Return plain numbers; a ground without friction of its own has the spikes'.

        Args:
            weight: Of the rover [N]; on less than a hundredth of it a spike grips in part.
            friction: Friction coefficient of the rover's spikes, if they have one.
        """
        mu = friction if self.friction is None else self.friction
        cone = (0.0, 0.0) if mu is None else (mu, 1.0)
        return GroundNumbers(self.stiffness, self.damping, self.drag, *cone, _GRIP * weight)


def _number(key: str, value: Any, above: bool = False) -> float:
    """Return a finite number at least 0, or above it, or refuse it."""
    allowed = f"{'above 0' if above else 'at least 0'} and at most {_HIGHEST:g}"
    if isinstance(value, bool) or not isinstance(value, int | float | np.number):
        raise InputError(f"ground.{key}", value, f"a number {allowed}")
    if not (0 <= value <= _HIGHEST and (value > 0 or not above)):
        raise InputError(f"ground.{key}", value, f"a number {allowed}")
    return float(value)
