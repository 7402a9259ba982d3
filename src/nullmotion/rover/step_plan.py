"""A planned step: body and gimbal over time, and what it leaves to spare."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nullmotion.rover.edge_frame import EdgeFrame
from nullmotion.rover.rover import Rover, Site


@dataclass(frozen=True, eq=False)
class StepPlan:
    """A step over an edge as planned; arrays over the nodes and midway between them, (k,).

    Attributes:
        rover: The rover.
        frame: Frame of the step; `frame.edge` is the edge.
        site: Gravity and slope.
        t: Times, evenly spaced [s].
        theta: Angle turned about r [rad].
        theta_dot: Its rate [rad/s].
        theta_ddot: Its acceleration [rad/s^2].
        delta: Gimbal angle [rad].
        delta_dot: Gimbal rate [rad/s].
        delta_ddot: Gimbal acceleration [rad/s^2].
        margin: Torque to spare before a spike lifts off [N m].
        least_margin: The least of it on a grid ten times denser [N m].
        energy: Energy of gimbal and rotor motor, Eq 88 [J].
        branch: Sign of o . r over the whole step.
        seconds: How long planning took.
    """

    rover: Rover
    frame: EdgeFrame
    site: Site
    t: np.ndarray
    theta: np.ndarray
    theta_dot: np.ndarray
    theta_ddot: np.ndarray
    delta: np.ndarray
    delta_dot: np.ndarray
    delta_ddot: np.ndarray
    margin: np.ndarray
    least_margin: float
    energy: float
    branch: int
    seconds: float = 0.0

    @property
    def duration(self) -> float:
        """t_f [s]."""
        return float(self.t[-1])

    @property
    def x(self) -> np.ndarray:
        """theta, its rate and acceleration, delta, its rate and acceleration, (6, k)."""
        body = (self.theta, self.theta_dot, self.theta_ddot)
        return np.array([*body, self.delta, self.delta_dot, self.delta_ddot])

    @property
    def cost_of_travel(self) -> float:
        """Energy per mass and distance [J/(kg m)], as in Table 4."""
        return self.energy / (self.rover.mass * self.frame.distance)
