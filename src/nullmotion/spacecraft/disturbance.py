"""Torques from outside: constant, sinusoidal, gravity gradient; and desaturation."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from nullmotion import linalg, ops, rotation
from nullmotion.errors import InputError
from nullmotion.spacecraft.body import checked_vector

EARTH_MU = 3.986004418e14  # m^3/s^2
EARTH_RADIUS = 6378137.0  # m


@dataclass(frozen=True, eq=False)
class Orbit:
    """A circular orbit, for the gravity gradient 3 w^2 o x J o (o: unit vector to nadir in B).

    Args:
        rate: Orbital rate w [rad/s].
        inclination: Against the x-y plane of N [rad].
        ascending_node: Angle of the ascending node from x of N [rad].
        argument_of_latitude: Angle from the node at t = 0 [rad].
    """

    rate: Any
    inclination: Any = 0.0
    ascending_node: Any = 0.0
    argument_of_latitude: Any = 0.0

    def __post_init__(self) -> None:
        """Check that every value is a number."""
        for key in ("rate", "inclination", "ascending_node", "argument_of_latitude"):
            _check(self, f"orbit.{key}", "a finite number")

    @staticmethod
    def at_altitude(altitude: float, **angles: float) -> Orbit:
        """Return the orbit of the Earth at an altitude above its equatorial radius [m]."""
        if not (np.isfinite(altitude) and altitude > 0):
            raise InputError("altitude", altitude, "above 0 m")
        return Orbit(float(np.sqrt(EARTH_MU / (EARTH_RADIUS + altitude) ** 3)), **angles)

    def position(self, t: Any) -> Any:
        """Return the unit vector from the Earth's centre to the spacecraft in N, (3,)."""
        node = ops.cos(self.ascending_node), ops.sin(self.ascending_node)
        tilt = ops.cos(self.inclination), ops.sin(self.inclination)
        along = np.array([node[0], node[1], 0.0])
        across = np.array([-node[1] * tilt[0], node[0] * tilt[0], tilt[1]])
        u = self.argument_of_latitude + self.rate * t
        return ops.cos(u) * along + ops.sin(u) * across


@dataclass(frozen=True, eq=False)
class Disturbance:
    """Torque on the vehicle from outside, in B.

        T(t) = constant + amplitude sin(2 pi frequency t + phase) + 3 w^2 o x J o

    Args:
        constant: [N m], (3,).
        amplitude: Of the sinusoid [N m], (3,).
        frequency: [Hz].
        phase: [rad].
        orbit: Where the gravity gradient comes from; None for none.
    """

    constant: Any = field(default_factory=lambda: np.zeros(3))
    amplitude: Any = field(default_factory=lambda: np.zeros(3))
    frequency: Any = 0.0
    phase: Any = 0.0
    orbit: Orbit | None = None

    def __post_init__(self) -> None:
        """Check shapes and signs."""
        for key in ("constant", "amplitude"):
            value = checked_vector(f"disturbance.{key}", getattr(self, key))
            object.__setattr__(self, key, value)
        _check(self, "disturbance.frequency", "a finite number from 0", least=0.0)
        _check(self, "disturbance.phase", "a finite number")

    def torque(self, t: Any, q_BN: Any, inertia: Any) -> Any:
        """Return the torque at a time and attitude [N m], (3,)."""
        total = self.constant + ops.sin(2.0 * np.pi * self.frequency * t + self.phase) * (
            self.amplitude
        )
        if self.orbit is None:
            return total
        up = rotation.matrix(q_BN) @ self.orbit.position(t)  # its sign does not matter
        return total + (3.0 * self.orbit.rate**2) * linalg.cross(up, inertia @ up)


@dataclass(frozen=True, eq=False)
class Desaturation:
    """Limited torque from outside (thrusters, magnetorquers) that takes momentum off the array.

    While the array's momentum is above `threshold`: T = -gain h, at most `torque_limit`.

    Args:
        torque_limit: Largest torque [N m]; infinite for none.
        gain: Torque per momentum [1/s].
        threshold: |h| above which it works [N m s].
    """

    torque_limit: Any
    gain: Any = 0.1
    threshold: Any = 0.0

    def __post_init__(self) -> None:
        """Check signs."""
        if not self.torque_limit > 0:
            raise InputError("desaturation.torque_limit", self.torque_limit, "above 0")
        object.__setattr__(self, "torque_limit", float(self.torque_limit))
        _check(self, "desaturation.gain", "a finite number above 0", least=5e-324)
        _check(self, "desaturation.threshold", "a finite number from 0", least=0.0)

    def torque(self, momentum: Any) -> Any:
        """Return the torque for the array's momentum in B [N m], (3,)."""
        size = linalg.norm(momentum)
        safe = ops.where(ops.less(1e-12, size), size, 1.0)
        wanted = ops.minimum(self.gain * size, self.torque_limit)
        return momentum * ops.where(ops.less(self.threshold, size), -wanted / safe, 0.0)


def _check(record: Any, key: str, allowed: str, least: float = -np.inf) -> None:
    """Make a field a float, or refuse it unless it is finite and at least a value."""
    field = key.rpartition(".")[2]
    value = float(getattr(record, field))
    if not (np.isfinite(value) and value >= least):
        raise InputError(key, value, allowed)
    object.__setattr__(record, field, value)
