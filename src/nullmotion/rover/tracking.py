"""The step in closed loop: computed torque about the edge (Elliott 2019, Eq 87).

    delta'_c = (M (cm/o x g).r - N (kp e + kd e' + theta_r'')) / (h o . r),   e = theta_r - theta
    delta''  = clip(k (clip(delta'_c) - delta'))          within the CMG's limits, from delta' = 0

T drives the CMG here, so that Eq 87's sign is turned round. N is without the CMG's own inertia, as
in the paper; the rover that is driven has it. Until the CMG lifts it, the body stays on its face.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from nullmotion.rover import step_dynamics as step
from nullmotion.rover.chassis import positive
from nullmotion.rover.dense import interpolated, interpolated_at
from nullmotion.rover.step_energy import motor_powers, used_power
from nullmotion.rover.step_model import StepModel, step_model
from nullmotion.rover.step_plan import StepPlan

_LEAST = 1e-3  # |o.r| below which Eq 87 asks for more than any gimbal gives


@dataclass(frozen=True)
class Gains:
    """Gains of the step controller.

    Args:
        kp: On the angle [1/s^2].
        kd: On the rate [1/s].
        gimbal: Of the gimbal's rate loop [1/s].

    Raises:
        InputError: For a gain that is not above 0.
    """

    kp: float = 25.0
    kd: float = 10.0
    gimbal: float = 200.0

    def __post_init__(self) -> None:
        """Check what can be checked."""
        for key in ("kp", "kd", "gimbal"):
            positive(key, getattr(self, key))


class Loop(NamedTuple):
    """The closed loop of one step.

    Attributes:
        model: Constants of the step.
        plan: Planned trajectories (6, n).
        rows: The same as a list of nodes, for single times.
        t_f: Planned time [s].
        gains: The controller's.
        rate: Limit of the gimbal rate [rad/s].
        acceleration: Limit of the gimbal acceleration [rad/s^2].
    """

    model: StepModel
    plan: np.ndarray
    rows: list[list[float]]
    t_f: float
    gains: Gains
    rate: float
    acceleration: float

    def reference(self, t: Any) -> Any:
        """Return the plan at a time or at times, theta first."""
        if isinstance(t, float):
            return interpolated_at(self.rows, self.t_f, t)
        return interpolated(self.plan, self.t_f, t)

    def commanded_rate(self, t: Any, theta: Any, theta_dot: Any, delta: Any) -> Any:
        """Return delta'_c within the limit [rad/s] (Eq 87)."""
        planned, rate, acceleration = self.reference(t)[:3]
        wanted = self.gains.kp * (planned - theta) + self.gains.kd * (rate - theta_dot)
        needed = self.model.N * (wanted + acceleration)
        torque = step.gravity_torque(self.model, theta) - needed
        drive = self.model.h * _away(step.authority(self.model, delta))
        return _limited(torque / drive, self.rate)

    def state(self, t: Any, y: Any) -> step.State:
        """Return the state with the gimbal's acceleration; y = theta, theta', delta, delta', ..."""
        error = self.commanded_rate(t, y[0], y[1], y[2]) - y[3]
        swing = _limited(self.gains.gimbal * error, self.acceleration)
        return step.State(y[0], y[1], y[2], y[3], swing)

    def resting(self, t: float, y: np.ndarray) -> list[float]:
        """Return the rates of y, work and energy while the body lies on its face."""
        return self._rates(self.state(t, y.tolist()), 0.0)

    def turning(self, t: float, y: np.ndarray) -> list[float]:
        """Return the rates of y, work and energy while the body turns about the edge."""
        state = self.state(t, y.tolist())
        return self._rates(state, step.acceleration(self.model, state))

    def _rates(self, state: step.State, theta_ddot: float) -> list[float]:
        gimbal, rotor = motor_powers(self.model, state, theta_ddot)
        used = used_power(self.model, state, theta_ddot)
        body = [state.theta_dot, theta_ddot, state.delta_dot, state.delta_ddot]
        return [*body, gimbal + rotor, used]


def _limited(value: Any, size: float) -> Any:
    if isinstance(value, float):
        return max(-size, min(size, value))
    return np.clip(value, -size, size)


def _away(drive: Any) -> Any:
    """Return o . r, kept away from 0."""
    if isinstance(drive, float):
        return math.copysign(max(abs(drive), _LEAST), drive)
    return np.copysign(np.maximum(np.abs(drive), _LEAST), drive)


def loop(plan: StepPlan, gains: Gains) -> Loop:
    """Return the closed loop around a plan."""
    cmg = plan.rover.cmg
    model = step_model(plan.rover, plan.frame, plan.site)
    x = plan.x
    return Loop(
        model, x, x.T.tolist(), plan.duration, gains, cmg.rate_limit, cmg.acceleration_limit
    )
