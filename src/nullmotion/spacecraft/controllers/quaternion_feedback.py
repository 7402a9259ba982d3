"""Quaternion feedback."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from nullmotion.spacecraft.controller import AttitudeObservation, Controller


@dataclass(frozen=True)
class QuaternionFeedback(Controller):
    """T = -(kp q_v + kw omega), q_v: vector part of the attitude error q_BR, scalar part >= 0.

    Args:
        kp: Gain of the attitude error [N m], one number or one for each axis.
        kw: Gain of the body rate [N m s].
    """

    name: ClassVar[str] = "quaternion-feedback"
    full_name: ClassVar[str] = "Quaternion feedback"
    citation: ClassVar[str] = "Papakonstantinou et al. (2021), Eq 10"

    kp: float | tuple[float, float, float] | None = None
    kw: float | tuple[float, float, float] | None = None

    def step(self, obs: AttitudeObservation, state: Any) -> tuple[Any, Any]:
        """Return the feedback torque."""
        return -(np.asarray(self.kp) * obs.q_BR[1:] + np.asarray(self.kw) * obs.omega_BN_B), state
