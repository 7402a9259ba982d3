"""What an attitude controller is and what it sees."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

from nullmotion import rotation
from nullmotion.array.model import CmgArray


@dataclass(frozen=True)
class AttitudeObservation:
    """What a controller sees at a sample, as floats or symbols.

    Attributes:
        q_BN: Measured attitude, (4,).
        omega_BN_B: Measured body rate in B [rad/s], (3,).
        q_RN: Reference attitude now, (4,): the target, or a point of a profile.
        omega_RN_R: Rate of the reference in its own frame R [rad/s], (3,); zero at a target.
        alpha_RN_R: Its derivative [rad/s^2], (3,).
        inertia: Inertia as the controller knows it [kg m^2], (3, 3).
        momentum: Momentum of the array as measured, in B [N m s], (3,).
        t: Time [s].
        period: Time to the next sample [s].
        array: The array as known, its momenta as they are now; None if not told.
        delta: Measured gimbal angles [rad], (n,).
        rates: Gimbal rates over the period that ends [rad/s], (n,).
        limited: Whether the command of that period was cut by a limit (1 or 0).
    """

    q_BN: Any
    omega_BN_B: Any
    q_RN: Any
    omega_RN_R: Any
    alpha_RN_R: Any
    inertia: Any
    momentum: Any
    t: Any
    period: Any
    array: Any = None
    delta: Any = None
    rates: Any = None
    limited: Any = 0.0

    @cached_property
    def q_BR(self) -> Any:
        """Attitude error q_RN^-1 * q_BN with a scalar part that is not negative, (4,).

        Of q and -q, which are the same attitude, the nearer to the identity: a
        controller on it never unwinds.
        """
        return rotation.shortest(rotation.multiply(rotation.conjugate(self.q_RN), self.q_BN))


@dataclass(frozen=True)
class Controller:
    """Base of attitude controllers: from an observation to a torque on the vehicle.

    A controller is one file under ``spacecraft/controllers/`` with one frozen dataclass;
    its fields are the parameters. It never branches on values (`nullmotion.ops`). The
    array is then commanded with hdot = -torque - omega x h.

    Class attributes:
        name: Name on the command line and in files.
        full_name: Name in the field.
        aliases: Other names.
        citation: Where it comes from.
        follows_profile: Whether it uses the reference's rate and acceleration.
        learns_inertia: Whether it finds the inertia out while it flies: its feed-forward is
            not exact from the start.
        knows_torque_matrix: Whether it estimates how VSCMGs act (`torque_matrix`).
    """

    name: ClassVar[str] = ""
    full_name: ClassVar[str] = ""
    aliases: ClassVar[tuple[str, ...]] = ()
    citation: ClassVar[str] = ""
    follows_profile: ClassVar[bool] = False
    learns_inertia: ClassVar[bool] = False
    knows_torque_matrix: ClassVar[bool] = False

    def init(self, array: CmgArray | None = None) -> Any:
        """Return the controller's state before its first sample, for an array."""
        return ()

    def torque_matrix(self, obs: AttitudeObservation, state: Any) -> Any:
        """Return Q of hdot = Q [wheel accelerations, gimbal rates], (3, 2n), as estimated."""
        raise NotImplementedError

    def step(self, obs: AttitudeObservation, state: Any) -> tuple[Any, Any]:
        """Return the torque wanted on the vehicle in B [N m], (3,), and the next state."""
        raise NotImplementedError
