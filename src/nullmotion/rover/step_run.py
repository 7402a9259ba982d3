"""A step as it came out in closed loop."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nullmotion.rover.step_plan import StepPlan


@dataclass(frozen=True, eq=False)
class StepRun:
    """A step under the tracking controller; arrays over time, (k,).

    Attributes:
        plan: What was tracked.
        t: Times [s].
        theta: Angle turned about r [rad].
        theta_dot: Its rate [rad/s].
        theta_ddot: Its acceleration [rad/s^2].
        delta: Gimbal angle [rad].
        delta_dot: Gimbal rate [rad/s].
        delta_ddot: Gimbal acceleration [rad/s^2].
        angle_error: Planned less true angle [rad].
        turning: Whether the body turns about the edge; before that it lies on its face.
        margin: Torque to spare [N m]: while turning before a spike of the edge lifts off, at rest
            before the body tips over another edge of its face.
        energy: Energy of gimbal and rotor motor, Eq 88 [J].
        work: Work of the two motors, signed [J].
        energy_change: Change of kinetic and potential energy [J].
        lift_off: When the body begins to turn [s].
        outcome: ``landed``, ``tipped`` or ``stalled``.
    """

    plan: StepPlan
    t: np.ndarray
    theta: np.ndarray
    theta_dot: np.ndarray
    theta_ddot: np.ndarray
    delta: np.ndarray
    delta_dot: np.ndarray
    delta_ddot: np.ndarray
    angle_error: np.ndarray
    turning: np.ndarray
    margin: np.ndarray
    energy: float
    work: float
    energy_change: float
    lift_off: float
    outcome: str

    @property
    def max_angle_error(self) -> float:
        """Greatest |planned less true angle| [rad]."""
        return float(np.abs(self.angle_error).max())

    @property
    def least_margin(self) -> float:
        """Least margin while turning [N m], the counterpart of the plan's."""
        return float(self.margin[self.turning].min(initial=np.inf))

    @property
    def least_static_margin(self) -> float:
        """Least margin at rest [N m]."""
        return float(self.margin[~self.turning].min(initial=np.inf))

    @property
    def cost_of_travel(self) -> float:
        """Energy per mass and distance [J/(kg m)], as in Table 4."""
        return self.energy / (self.plan.rover.mass * self.plan.frame.distance)

    @property
    def energy_balance(self) -> float:
        """|work - change of energy| over the energy turned over."""
        return abs(self.work - self.energy_change) / self.energy
