"""The gimbal servo: how a commanded rate becomes a gimbal's motion."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from nullmotion.errors import InputError


@dataclass(frozen=True, eq=False)
class Servo:
    """A rate servo on each gimbal; every value is one number or one for each CMG.

    The drive asks for the acceleration that a first-order lag towards the commanded rate
    has, and compensates the gyroscopic torque; what it asks is limited in acceleration
    and motor torque, and Coulomb friction takes its share or holds the gimbal:

        a    = (u - r)(1 - exp(-dt / tau)) / dt,    |a| <= acceleration_limit
        T    = I a - omega . c,                     |T| <= torque_limit,   c: column of A
        v+   = shrink(v + dt (T + omega . c) / I, dt friction / I),  |v+| <= rate_limit

    u is the commanded rate, v the rate, r what the drive measures of it: v itself, or the
    encoder's difference over a step when the encoder has a resolution. shrink(x, y) =
    sign(x) max(|x| - y, 0).

    Args:
        time_constant: Lag tau [s]; 0 if the rate follows in one step.
        rate_limit: Largest rate the drive turns [rad/s].
        acceleration_limit: Largest gimbal acceleration [rad/s^2].
        torque_limit: Largest motor torque [N m]; needs `inertia`.
        friction: Coulomb friction [N m]; needs `inertia`.
        inertia: Inertia about the gimbal axis [kg m^2].
        encoder_resolution: Step of the angle that law and drive see [rad]; 0 if none.

    Raises:
        InputError: For values that cannot be.
    """

    time_constant: Any = 0.0
    rate_limit: Any = np.inf
    acceleration_limit: Any = np.inf
    torque_limit: Any = np.inf
    friction: Any = 0.0
    inertia: Any = 0.0
    encoder_resolution: Any = 0.0

    def __post_init__(self) -> None:
        """Check signs; make every value an array."""
        for key in ("rate_limit", "acceleration_limit", "torque_limit"):
            self._check(key, "above 0", lambda v: v > 0)
        for key in ("time_constant", "friction", "inertia", "encoder_resolution"):
            self._check(key, "finite and from 0", lambda v: (v >= 0) & np.isfinite(v))
        needs = [k for k in ("torque_limit", "friction") if self.has(k)]
        if needs and not np.all(self.inertia > 0):
            raise InputError("servo.inertia", self.inertia.tolist(), f"above 0 with {needs[0]}")

    def _check(self, key: str, allowed: str, good: Any) -> None:
        value = np.asarray(getattr(self, key), float)
        if value.ndim > 1 or not np.all(good(value)):
            raise InputError(f"servo.{key}", value.tolist(), allowed)
        object.__setattr__(self, key, value)

    def has(self, key: str) -> bool:
        """Return whether a value is other than the ideal servo's."""
        ideal = np.inf if key.endswith("limit") else 0.0
        return any(not isinstance(v, float) or v != ideal for v in np.ravel(getattr(self, key)))
