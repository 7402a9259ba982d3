"""Eigenaxis slew: saturated quaternion feedback that keeps the axis and limits the rate."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from nullmotion import linalg, ops
from nullmotion.law import check_parameters
from nullmotion.spacecraft.controller import AttitudeObservation, Controller

_DEGREE = np.pi / 180.0
_BRAKING = 2.0 / 3.0  # the rest of the acceleration makes up for the lag 1/c behind the profile
_TINY = 1e-150


@dataclass(frozen=True)
class EigenaxisSlew(Controller):
    """Turn about the one axis that leads to the target, at a limited rate.

        T = J sat_a(-2k sat_L(e) - c omega) + omega x J omega,    k = w^2,  c = 2 zeta w
        L = (c / 2k) min( sqrt(4 b |e|), omega_max ),             b = 2/3 a

    e is the vector part of the attitude error; sat shortens a vector to a length and keeps
    its direction, so that from rest the body turns about one axis whatever its inertia. While
    saturated, the rate follows 2k L / c: first omega_max, then what an acceleration b brakes
    to the target; without a, from omega_max straight into the linear range. From rest the
    rate stays below omega_max.

    In the source each axis has limits of its own (a: the torque limit over its inertia) and
    the torque is saturated, not the acceleration. The gyroscopic term does not count for a.

    Args:
        natural_frequency_rad_s: w of a small error [rad/s].
        damping: zeta of a small error.
        slew_rate_deg_s: omega_max [deg/s].
        acceleration_deg_s2: a, largest angular acceleration asked [deg/s^2]; None for no limit:
            a slew then begins with c omega_max.
        feed_forward: Whether omega x J omega is compensated; the axis keeps its direction
            only if it is.
    """

    name: ClassVar[str] = "eigenaxis-slew"
    full_name: ClassVar[str] = "Eigenaxis slew"
    citation: ClassVar[str] = "Wie, Bailey & Heiberg, J. Guid. Control Dyn. 25 (2002)"

    natural_frequency_rad_s: float = 0.5
    damping: float = 1.0
    slew_rate_deg_s: float = 3.0
    acceleration_deg_s2: float | None = None
    feed_forward: bool = True

    def __post_init__(self) -> None:
        """Check the parameters."""
        response = ("natural_frequency_rad_s", "damping")
        limits = ("slew_rate_deg_s", "acceleration_deg_s2")
        check_parameters(self, (*response, *limits), kind="controller")

    def step(self, obs: AttitudeObservation, state: Any) -> tuple[Any, Any]:
        """Return the saturated feedback torque."""
        J, omega, e = obs.inertia, obs.omega_BN_B, obs.q_BR[1:]
        k = self.natural_frequency_rad_s * self.natural_frequency_rad_s
        c = 2.0 * self.damping * self.natural_frequency_rad_s
        rate = self.slew_rate_deg_s * _DEGREE
        if self.acceleration_deg_s2 is not None:
            braking = (4.0 * _BRAKING * _DEGREE) * self.acceleration_deg_s2
            rate = ops.minimum(ops.sqrt(braking * linalg.norm(e)), rate)
        acceleration = -(2.0 * k) * _shortened(e, c / (2.0 * k) * rate) - c * omega
        if self.acceleration_deg_s2 is not None:
            acceleration = _shortened(acceleration, self.acceleration_deg_s2 * _DEGREE)
        torque = J @ acceleration
        return (torque + linalg.cross(omega, J @ omega) if self.feed_forward else torque), state


def _shortened(v: Any, length: Any) -> Any:
    """Return v with at most a length, in its direction; the zero vector stays."""
    return v * (length / ops.maximum(ops.maximum(linalg.norm(v), length), _TINY))
