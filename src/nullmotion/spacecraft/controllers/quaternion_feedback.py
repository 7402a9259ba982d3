"""Quaternion feedback."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from nullmotion.spacecraft.controller import AttitudeObservation, Controller
from nullmotion.spacecraft.controllers._gains import check_gains, feedback


@dataclass(frozen=True)
class QuaternionFeedback(Controller):
    """T = -(kp q_v + kw omega), q_v: vector part of the attitude error q_BR, scalar part >= 0.

    Without gains, kp = 2 J w^2 and kw = 2 zeta J w with the inertia J: a small error then
    answers about every axis with natural frequency w and damping zeta.

    The body's own omega x J omega is left to the feedback. It does no work: with one number
    for kp the target is reached from every state (Wie, Weiss & Arapostathis 1989).

    Args:
        kp: Gain of the attitude error [N m], one number or one for each axis.
        kw: Gain of the body rate [N m s], likewise.
        natural_frequency_rad_s: w [rad/s] where kp and kw are not given; None for 0.5.
        damping: zeta where kp and kw are not given; None for 1.

    Raises:
        InputError: For a gain without the other, or beside w or zeta.
    """

    name: ClassVar[str] = "quaternion-feedback"
    full_name: ClassVar[str] = "Quaternion feedback"
    citation: ClassVar[str] = "Papakonstantinou et al. (2021), Eq 10"

    kp: float | tuple[float, float, float] | None = None
    kw: float | tuple[float, float, float] | None = None
    natural_frequency_rad_s: float | None = None
    damping: float | None = None

    def __post_init__(self) -> None:
        """Check the gains."""
        check_gains(self)

    def step(self, obs: AttitudeObservation, state: Any) -> tuple[Any, Any]:
        """Return the feedback torque."""
        return feedback(self, obs.inertia, obs.q_BR[1:], obs.omega_BN_B), state
