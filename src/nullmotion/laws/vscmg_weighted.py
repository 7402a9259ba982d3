"""Weighted VSCMG steering: gimbals give the torque, wheels where gimbals cannot."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, ClassVar, Literal

import numpy as np

from nullmotion import linalg, ops
from nullmotion.array.model import CmgArray
from nullmotion.errors import InputError
from nullmotion.law import Claim, Law, Observation, check_parameters
from nullmotion.vscmg.hardware import torque_matrix
from nullmotion.vscmg.weighted import Command, Weighted

Goal = Literal["momentum", "equalise", "power", "none"]
_RATE = 0.07  # 1/s: a startup in a minute
_STILL = 1e-30  # (N m s)^2
_NEAR = 0.05  # det(C_T C_T^T) below which symmetry may hide the way out
_TURN = np.pi * (3.0 - np.sqrt(5.0))  # golden angle: no two gimbals are nudged alike


@dataclass(frozen=True)
class VscmgWeighted(Law):
    """Weighted inverse of the whole VSCMG array with null motion (Kim et al., Eqs 27-35).

        [Omega_dot; delta_dot] = Q_W^+ hdot + N S sigma,   Q = [C_W I_W, C_T I_W Omega + ...]
        Q_W^+ = W Q^T (Q W Q^T)^-1,   N = 1 - Q_W^+ Q,   W = diag(W_Omega0 e^(lambda1 f), W_delta)
        f = -det(C_T C_T^T),   S = diag(sech(1 / (k_d det + epsilon)), sech(k_g det))

    sigma holds, for the gimbals, -k_gamma d gamma / d delta (gamma = gamma0 e^(lambda2 f) falls on
    the way out of a singularity; the paper's sign climbs it), and for the wheels what makes
    Omega_dot = a (Eqs 42-43): a = k_m mu for momentum management, mu = I_W (Omega_d - Omega).
    With the halves Q_1, Q_2 of Q the inverse in Eq 43 is, by Woodbury's identity,
    1 + W_Omega Q_1^T (Q_2 W_delta Q_2^T)^-1 Q_1. It does not exist where gimbals give no torque:
    Q_2 W_delta Q_2^T + damping / s_w^2 (Q_1 W_Omega Q_1^T) is inverted instead, and there the
    wheels serve the torque.

    Unless `as_published`, the torque keeps its direction when a gimbal rate or a wheel's torque,
    power or speed would pass its limit: first Q_W^+ hdot is scaled, then null motion gets what
    is left. Wheels without torque (a dead motor) have weight 0.

    Args:
        W_Omega0: Weight of wheel accelerations at a regular state.
        W_delta: Weight of gimbal rates.
        lambda1: How much the wheels' weight falls off away from singular states.
        lambda2: Decay of gamma.
        gamma0: gamma at a singular state.
        k_gamma: Gain of the gimbals' null motion [rad/s].
        k_d: In s_w.
        k_g: In s_g.
        epsilon: In s_w.
        k_m: Gain of the wheels' goal [1/(kg m^2 s)]; mu falls as e^(-I_W k_m t). None for
            0.07 / I_W: to 2 % in a minute.
        wheel_speed_rad_s: Omega_d; None for h0 / I_W of the array as it was designed.
        goal: What null motion does to the wheels: ``momentum`` brings each to Omega_d, ``equalise``
            to their mean, ``power`` gives `power_W` to them (negative: takes it), ``none`` keeps
            their speeds.
        power_W: Power into the wheels [W].
        damping: Of the inverse in Eq 43, as above.
        nudge: Null motion [rad/s] at a singular state, a different one for each gimbal: where
            rotors are aligned, det has no slope and gamma shows no way out.
        as_published: Limits are left to the array.
    """

    name: ClassVar[str] = "vscmg-weighted"
    full_name: ClassVar[str] = "Weighted VSCMG steering"
    citation: ClassVar[str] = (
        "Kim, Leve, Fitz-Coy & Dixon, J. Guid. Control Dyn. 35 (2012), Eqs 27-43; "
        "Schaub, Vadali & Junkins, J. Astronaut. Sci. 46 (1998)"
    )
    claims: ClassVar[frozenset[Claim]] = frozenset({Claim.FINITE, Claim.STATELESS, Claim.TIMELESS})
    information: ClassVar[tuple[str, ...]] = ("wheel_speed", "torque_matrix")
    turns_wheels: ClassVar[bool] = True

    W_Omega0: float = 100.0
    W_delta: float = 1.0
    lambda1: float = 1.0
    lambda2: float = 1.0
    gamma0: float = 1.0
    k_gamma: float = 0.1
    k_d: float = 10.0
    k_g: float = 1.0
    epsilon: float = 0.1
    k_m: float | None = None
    wheel_speed_rad_s: float | None = None
    goal: Goal = "momentum"
    power_W: float = 0.0
    damping: float = 1.0
    nudge: float = 0.2
    as_published: bool = False

    def __post_init__(self) -> None:
        """Check the parameters."""
        if self.goal not in ("momentum", "equalise", "power", "none"):
            allowed = "'momentum', 'equalise', 'power' or 'none'"
            raise InputError("law.goal", self.goal, allowed)
        positive = ("W_Omega0", "W_delta", "k_d", "epsilon", "damping")
        gains = ("lambda1", "lambda2", "gamma0", "k_gamma", "k_g", "k_m")
        check_parameters(self, positive, (*gains, "nudge", "wheel_speed_rad_s"))

    def supports(self, array: CmgArray) -> str:
        """Ask for flywheels whose speed may change."""
        return "" if array.wheels is not None else "needs variable-speed wheels (array.wheels)"

    def init(self, array: CmgArray, delta: Any) -> Any:
        """Return the wheel speeds that the array was designed for [rad/s], (n,)."""
        return array.design_speed

    def step(self, array: CmgArray, obs: Observation, state: Any) -> tuple[Any, Any]:
        """Return gimbal rates and wheel accelerations as a pair, and the state."""
        n, wheels = array.n, array.flywheels
        if obs.wheel_speed is None:
            obs = replace(obs, wheel_speed=array.design_speed)
        Q = obs.torque_matrix
        if Q is None:
            Q = torque_matrix(array, obs.delta, obs.wheel_speed)
        C_T, C_W = array.transverse_directions(obs.delta), array.wheel_axes(obs.delta)
        gram = C_T @ C_T.T
        det = ops.maximum(linalg.det(gram), 0.0)
        alive = ops.where(ops.less(0.0, wheels.torque_limit), 1.0, 0.0)
        weights = self.W_Omega0 * ops.exp(-self.lambda1 * det) * alive
        split = Weighted(Q[:, :n], Q[:, n:], Command(weights, np.full(n, self.W_delta)))
        low, high = self._bounds(array, obs)
        torque = obs.hdot
        command = split.ranged(torque) if self.as_published else split.within(torque, low, high)
        goal = self._acceleration(array, obs, state, alive) - command.wheel
        s_w = _sech(1.0 / (self.k_d * det + self.epsilon))
        turn = self._climb(C_T, C_W, gram, det)
        null = split.null(goal, turn, s_w, self.damping)
        if not self.as_published:
            null = null.scaled(null.share_within(low.plus(command, -1.0), high.plus(command, -1.0)))
        whole = command.plus(null)
        return (whole.gimbal, whole.wheel), state

    def _climb(self, C_T: Any, C_W: Any, gram: Any, det: Any) -> Any:
        """Return -s_g k_gamma d gamma / d delta: the way out of a singularity, (n,)."""
        adjugate = linalg.adjugate(gram)
        slope = -2.0 * np.array([C_T[:, i] @ (adjugate @ C_W[:, i]) for i in range(C_T.shape[1])])
        gamma = self.gamma0 * ops.exp(-self.lambda2 * det)
        climb = (_sech(self.k_g * det) * self.k_gamma * self.lambda2 * gamma) * slope
        if self.as_published:
            return climb
        near = ops.maximum(1.0 - det * (1.0 / _NEAR), 0.0)
        return climb + (self.nudge * near * near) * np.cos(_TURN * np.arange(len(slope)))

    def _acceleration(self, array: CmgArray, obs: Observation, design: Any, alive: Any) -> Any:
        """Return the wheel accelerations that null motion aims at [rad/s^2], (n,)."""
        inertia, speed = alive * array.flywheels.inertia, obs.wheel_speed
        rate = alive * _RATE if self.k_m is None else self.k_m * inertia
        if self.goal == "momentum":
            aim = design if self.wheel_speed_rad_s is None else self.wheel_speed_rad_s
            return rate * (aim - speed)
        if self.goal == "equalise":  # the mean that leaves the mean of the speeds as it is
            mean = (inertia @ speed) / ops.maximum(sum(inertia), _STILL)
            return rate * (mean - speed)
        if self.goal == "power":
            h = inertia * speed
            return (self.power_W / ops.maximum(h @ h, _STILL)) * h
        return 0.0 * speed

    def _bounds(self, array: CmgArray, obs: Observation) -> tuple[Command, Command]:
        low, high = array.flywheels.bounds(obs.wheel_speed, obs.period)
        return Command(low, -array.rate_limit), Command(high, array.rate_limit)


def _sech(x: Any) -> Any:
    """Return 1 / cosh x for x >= 0."""
    e = ops.exp(-ops.minimum(x, 700.0))
    return 2.0 * e / (1.0 + e * e)
