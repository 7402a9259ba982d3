"""Adaptive tracking that knows neither the body's inertia nor the gimbals'."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

import numpy as np

from nullmotion import linalg, ops, rotation
from nullmotion.array.model import CmgArray
from nullmotion.law import check_parameters
from nullmotion.spacecraft.controller import AttitudeObservation, Controller

_ENTRIES = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))  # of a symmetric 3 x 3 matrix


class Estimates(NamedTuple):
    """What the controller has learned: theta_1 (6 + n), theta_2 (2n), the outside torque (3).

    ``begun`` is 0 before the first sample, which has nothing to learn from, then 1.
    """

    theta1: Any
    theta2: Any
    torque: Any
    begun: Any


class Errors(NamedTuple):
    """The tracking errors: e, r, and the reference's rate and its derivative in B."""

    e: Any
    r: Any
    a: Any  # theta_1 enters as J a - omega x J omega
    x: Any  # theta_2 enters through dJ/d(delta) x


@dataclass(frozen=True)
class Adaptive(Controller):
    """Adaptive attitude tracking of a VSCMG spacecraft (Kim et al., Eqs 18-38).

        r = omega - C omega_R + alpha e,      hdot + omega x h = Y_1 theta_1 + k r + kp e
        theta_1_dot = proj(Gamma1 Y_1^T r),   theta_2_dot = proj(Gamma2 Y_2^T r)

    e is the vector part of q_BR, C = C_BR. theta_1 holds six entries of the inertia and
    J_s - J_t of each unit (J = const + sum (J_s - J_t) s s^T), theta_2 the gimbal inertias
    J_g and J_s - J_t again, as they act through the gimbal rates: -Y_2 theta_2 is
    the uncertain part of Q [wheel accelerations, gimbal rates], which the law is given. All
    start from zero. While a limit cuts the command, nothing is learned. Beyond the paper, a
    constant torque from outside is learned too: its estimate d grows by Gamma3 r and is taken off.

    V = kp (e.e + (1 - e0)^2) + r.J r / 2 + theta~.Gamma^-1 theta~ / 2 falls at least as
    alpha kp e.e + k r.r (Eq 50), if nothing is cut and the units' acceleration torque is small.

    Args:
        k: Gain of r [N m s].
        alpha: Rate at which e is to fall [1/s].
        kp: Gain of e [N m]; the paper has 1.
        Gamma1: Adaptation gain of theta_1; 0 learns nothing.
        Gamma2: Of theta_2.
        Gamma3: Of the outside torque [1/s]; the paper has none.
        inertia_bound: Greatest entry of theta_1 in size [kg m^2].
        unit_inertia_bound: Greatest entry of theta_2.
    """

    name: ClassVar[str] = "adaptive"
    full_name: ClassVar[str] = "Adaptive tracking"
    citation: ClassVar[str] = (
        "Kim, Leve, Fitz-Coy & Dixon, J. Guid. Control Dyn. 35 (2012), Eqs 18-38"
    )
    follows_profile: ClassVar[bool] = True
    learns_inertia: ClassVar[bool] = True
    knows_torque_matrix: ClassVar[bool] = True

    k: float = 0.05
    alpha: float = 0.5
    kp: float = 1.0
    Gamma1: float = 0.01
    Gamma2: float = 0.01
    Gamma3: float = 0.0
    inertia_bound: float = 1e3
    unit_inertia_bound: float = 1e2

    def __post_init__(self) -> None:
        """Check the gains."""
        positive = ("k", "alpha", "kp", "inertia_bound", "unit_inertia_bound")
        check_parameters(self, positive, ("Gamma1", "Gamma2", "Gamma3"), kind="controller")

    def init(self, array: CmgArray | None = None) -> Estimates:
        """Return zero knowledge."""
        n = 0 if array is None else array.n
        return Estimates(np.zeros(6 + n), np.zeros(2 * n), np.zeros(3), 0.0)

    def step(self, obs: AttitudeObservation, state: Estimates) -> tuple[Any, Estimates]:
        """Return the torque on the vehicle -(Y_1 theta_1 + k r + kp e + d), and the estimates."""
        errors = self._errors(obs)
        Y1 = self._regressor(obs, errors)
        on = obs.period * state.begun * (1.0 - obs.limited)
        theta1 = _within(state.theta1 + on * self.Gamma1 * (Y1.T @ errors.r), self.inertia_bound)
        theta2 = state.theta2
        if obs.array is not None and obs.rates is not None:
            own, inertial = _unit_columns(obs, errors)
            rates = np.concatenate([obs.rates, obs.rates])
            Y2 = -np.concatenate([own, inertial], axis=1) * rates
            moved = theta2 + on * self.Gamma2 * (Y2.T @ errors.r)
            theta2 = _within(moved, self.unit_inertia_bound)
        outside = state.torque + on * self.Gamma3 * errors.r
        torque = -(Y1 @ theta1) - self.k * errors.r - self.kp * errors.e - outside
        return torque, Estimates(theta1, theta2, outside, 1.0)

    def torque_matrix(self, obs: AttitudeObservation, state: Estimates) -> Any:
        """Return Q with the estimates: the wheels' columns are known, the gimbals' are not."""
        array, n = obs.array, obs.array.n
        own, inertial = _unit_columns(obs, self._errors(obs))
        gimbal = array.torque_axes.T @ array.jacobian(obs.delta)
        gimbal = gimbal + own * state.theta2[:n] + inertial * state.theta2[n:]
        wheel = (array.torque_axes.T @ array.wheel_axes(obs.delta)) * array.wheels.inertia
        return np.concatenate([wheel, gimbal], axis=1)

    def _errors(self, obs: AttitudeObservation) -> Errors:
        e0, e = obs.q_BR[0], obs.q_BR[1:]
        C = rotation.matrix(obs.q_BR)
        wanted, omega = C @ obs.omega_RN_R, obs.omega_BN_B
        off = omega - wanted
        turning = 0.5 * self.alpha * (linalg.cross(e, off) + e0 * off)
        a = linalg.cross(omega, wanted) - C @ obs.alpha_RN_R + turning
        r = off + self.alpha * e
        return Errors(e, r, a, 0.5 * r + wanted - self.alpha * e)

    def _regressor(self, obs: AttitudeObservation, errors: Errors) -> Any:
        """Return Y_1: -omega x E omega + E a for each matrix E that theta_1 weighs, (3, 6 + n)."""
        omega, columns = obs.omega_BN_B, []
        for i, j in _ENTRIES:
            E = np.zeros((3, 3))
            E[i, j] = E[j, i] = 1.0
            columns.append(E @ errors.a - linalg.cross(omega, E @ omega))
        if obs.array is not None:
            for s in _axes(obs)[0]:
                columns.append(s * (s @ errors.a) - linalg.cross(omega, s) * (s @ omega))
        return np.stack(columns, axis=1)


def _axes(obs: AttitudeObservation) -> tuple[Any, Any]:
    """Return s and t of each unit in B, (n, 3) each."""
    array, delta = obs.array, obs.delta
    c, d = ops.cos(delta)[:, None], ops.sin(delta)[:, None]
    s0, t0 = array.spin_axes, array.transverse_axes
    return c * s0 + d * t0, c * t0 - d * s0


def _unit_columns(obs: AttitudeObservation, errors: Errors) -> tuple[Any, Any]:
    """Return what J_g and J_s - J_t of each unit add to its gimbal's column of Q, (3, n) each.

    C_W omega_t - C_T omega_s, and (t s^T + s t^T) x: the derivative of J by the angle.
    """
    s, t = _axes(obs)
    omega, x = obs.omega_BN_B, errors.x
    own = s * (t @ omega)[:, None] - t * (s @ omega)[:, None]
    inertial = t * (s @ x)[:, None] + s * (t @ x)[:, None]
    return own.T, inertial.T


def _within(theta: Any, bound: float) -> Any:
    """Return the projection of Eq 39: each parameter within its bounds."""
    return ops.clip(theta, -bound, bound)
