"""Singularity-robust inverse: torque is traded for finite rates near a singular state."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, Literal

import numpy as np

from nullmotion import linalg, ops
from nullmotion.array.model import CmgArray
from nullmotion.errors import InputError
from nullmotion.law import Claim, Law, Observation, check_parameters

Schedule = Literal["manipulability", "exponential", "det", "constant"]
_MU = {"manipulability": 0.2, "exponential": 10.0, "det": 10.0, "constant": 0.0}


@dataclass(frozen=True)
class SingularityRobust(Law):
    """Damped least squares.

        delta_dot = A^T (A A^T + lambda I)^-1 hdot,     w = sqrt(det(A A^T))

    A and hdot are divided by the mean momentum, so lambda, w and mu have no unit. Schedules:

        manipulability   lambda0 (1 - w / mu)^2 for w < mu, else 0   Nakamura & Hanafusa, Eq 26
        exponential      lambda0 exp(-mu w)                          Papakonstantinou, Eqs 19-21
        det              lambda0 exp(-mu w^2)                        Wie, Bailey & Heiberg 2001
        constant         lambda0

    Only the first gives the torque exactly, where w >= mu (w >= sigma_min^m, so at
    the latest where sigma_min >= mu^(1/m)). At a singular state the torque along the
    singular direction is given up and a command along it moves no gimbal.

    Args:
        lambda0: Damping at a singular state.
        mu: Threshold of w (manipulability) or decay rate (exponential, det); None for
            0.2, 10 and 10.
        schedule: How the damping falls off away from singular states.
    """

    name: ClassVar[str] = "sr"
    full_name: ClassVar[str] = "Singularity-robust inverse"
    aliases: ClassVar[tuple[str, ...]] = ("sri", "damped-least-squares")
    citation: ClassVar[str] = (
        "Nakamura & Hanafusa, J. Dyn. Sys. Meas. Control 108 (1986); "
        "Papakonstantinou et al. (2021), Eqs 19-21"
    )
    claims: ClassVar[frozenset[Claim]] = frozenset(Claim)

    lambda0: float = 0.01
    mu: float | None = None
    schedule: Schedule = "manipulability"

    def __post_init__(self) -> None:
        """Check the parameters."""
        if self.schedule not in _MU:
            allowed = f"one of {', '.join(_MU)}"
            raise InputError("law.schedule", self.schedule, allowed)
        check_parameters(self, positive=("lambda0", "mu"))

    def exact_above(self, array: CmgArray) -> float:
        """Return mu^(1/m), or infinity for a schedule that is never quite zero."""
        mu = _MU[self.schedule] if self.mu is None else self.mu
        return float(mu ** (1.0 / array.m)) if self.schedule == "manipulability" else float("inf")

    def damping(self, w: Any) -> Any:
        """Return lambda at the manipulability w."""
        mu = _MU[self.schedule] if self.mu is None else self.mu
        if self.schedule == "constant":
            return self.lambda0
        if self.schedule == "manipulability":
            short = ops.maximum(1.0 - w / mu, 0.0)
            return self.lambda0 * (short * short)
        return self.lambda0 * ops.exp(-mu * (w if self.schedule == "exponential" else w * w))

    def step(self, array: CmgArray, obs: Observation, state: Any) -> tuple[Any, Any]:
        """Return the damped least-squares rates."""
        A = array.unit_jacobian(obs.delta)
        AAT = A @ A.T
        damping = self.damping(ops.sqrt(ops.maximum(linalg.det(AAT), 0.0)))
        y = linalg.solve(AAT + damping * np.eye(array.m), obs.hdot / array.mean_momentum)
        return A.T @ y, state
