"""The flywheels of variable-speed CMGs: their inertia and what their motors can do."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from nullmotion import ops
from nullmotion.array.checks import per_cmg

_STILL = 1e-9  # rad/s: speed below which a power limit asks nothing


def _endless() -> np.ndarray:
    return np.array(np.inf)


@dataclass(frozen=True, eq=False)
class Wheels:
    """Flywheels whose speed may change.

    A wheel with spin inertia I turns at Omega against its gimbal frame: h0 = I Omega. Its motor
    gives at most `torque_limit`, at most `power_limit` / |Omega|, and nothing that would take
    the speed beyond `speed_limit`.

    Args:
        inertia: I about the spin axis [kg m^2], one number or (n,).
        torque_limit: Greatest motor torque [N m]; infinite if none; 0 for a dead motor.
        speed_limit: Greatest speed [rad/s].
        power_limit: Greatest |torque x speed| [W].

    Raises:
        InputError: For an inertia that is not above 0, or a negative limit.
    """

    inertia: np.ndarray
    torque_limit: np.ndarray = field(default_factory=_endless)
    speed_limit: np.ndarray = field(default_factory=_endless)
    power_limit: np.ndarray = field(default_factory=_endless)

    def __post_init__(self) -> None:
        """Check signs."""
        put = object.__setattr__
        parts = [getattr(self, key) for key in self.__dataclass_fields__]
        n = max(np.size(part) for part in parts)

        def positive(v: np.ndarray) -> np.ndarray:
            return (v > 0) & np.isfinite(v)

        put(self, "inertia", per_cmg("wheels.inertia", self.inertia, n, "above 0", positive))
        for key in ("torque_limit", "speed_limit", "power_limit"):
            given = getattr(self, key)
            put(self, key, per_cmg(f"wheels.{key}", given, n, "from 0", lambda v: v >= 0))

    def for_n(self, n: int) -> Wheels:
        """Return the wheels of n CMGs."""
        own = [
            per_cmg(f"wheels.{key}", getattr(self, key), n, "one number or one for each CMG", _any)
            for key in self.__dataclass_fields__
        ]
        return Wheels(*own)

    def kept(self, which: list[int]) -> Wheels:
        """Return the wheels of some of the CMGs."""
        return Wheels(*(getattr(self, key)[which] for key in self.__dataclass_fields__))

    def altered(self, **fields: Any) -> Wheels:
        """Return a copy with some fields replaced, unchecked: they may hold symbols."""
        copy = object.__new__(Wheels)
        for name in self.__dataclass_fields__:
            object.__setattr__(copy, name, fields.get(name, getattr(self, name)))
        return copy

    def greatest(self, speed: Any) -> Any:
        """Return the greatest motor torque at a speed [N m], (n,)."""
        powered = self.power_limit / ops.maximum(ops.absolute(speed), _STILL)
        return ops.minimum(powered, self.torque_limit)

    def bounds(self, speed: Any, period: Any) -> tuple[Any, Any]:
        """Return the least and the greatest acceleration for a time from a speed [rad/s^2], (n,).

        Args:
            speed: Omega [rad/s], (n,).
            period: How long the acceleration is held [s].
        """
        most = self.greatest(speed) / self.inertia
        low = ops.maximum((-self.speed_limit - speed) / period, -most)
        high = ops.minimum((self.speed_limit - speed) / period, most)
        return ops.minimum(low, most), ops.maximum(high, -most)


def _any(value: np.ndarray) -> np.ndarray:
    return ~np.isnan(value)
