"""Tracking: feedback about the motion of a reference, whose torque is fed forward."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from nullmotion import linalg, rotation
from nullmotion.spacecraft.controller import AttitudeObservation, Controller
from nullmotion.spacecraft.controllers._gains import check_gains, feedback


@dataclass(frozen=True)
class Tracking(Controller):
    """Follow a reference that turns with omega_R and alpha_R.

        T = J (C alpha_R - omega x C omega_R) + omega x J omega - kp q_v - kw (omega - C omega_R)

    C = C_BR turns the reference's own frame R into B; its vector parts are given in R. The
    first two terms are the torque of the reference's motion, the last two act on what is off
    it: J times the acceleration of the error is -kp q_v - kw (error of the rate), exactly and
    for errors of any size. At a target, which stands still, this is quaternion feedback with
    the body's omega x J omega taken out.

    Args:
        kp: Gain of the attitude error [N m], one number or one for each axis.
        kw: Gain of the error of the rate [N m s], likewise.
        natural_frequency_rad_s: w [rad/s] where kp and kw are not given: kp = 2 J w^2,
            kw = 2 zeta J w; None for 0.5.
        damping: zeta where kp and kw are not given; None for 1.

    Raises:
        InputError: For a gain without the other, or beside w or zeta.
    """

    name: ClassVar[str] = "tracking"
    full_name: ClassVar[str] = "Tracking with feed-forward"
    citation: ClassVar[str] = "Wen & Kreutz-Delgado, IEEE Trans. Autom. Control 36 (1991)"
    follows_profile: ClassVar[bool] = True

    kp: float | tuple[float, float, float] | None = None
    kw: float | tuple[float, float, float] | None = None
    natural_frequency_rad_s: float | None = None
    damping: float | None = None

    def __post_init__(self) -> None:
        """Check the gains."""
        check_gains(self)

    def step(self, obs: AttitudeObservation, state: Any) -> tuple[Any, Any]:
        """Return the reference's torque and the feedback's."""
        J, omega, error = obs.inertia, obs.omega_BN_B, obs.q_BR
        C = rotation.matrix(error)
        wanted = C @ obs.omega_RN_R
        motion = J @ (C @ obs.alpha_RN_R - linalg.cross(omega, wanted))
        gyroscopic = linalg.cross(omega, J @ omega)
        return motion + gyroscopic + feedback(self, J, error[1:], omega - wanted), state
