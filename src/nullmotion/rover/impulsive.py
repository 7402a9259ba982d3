"""An impulsive step: a wheel is spun up and braked at once, and its momentum rolls the rover.

    U = M g d (1 - cos(alpha + Phi))       lifts the mass centre above the edge       (Eq 89)
    H = sqrt(2 N U)                        momentum about the edge that gives it U
    E = H^2 / (2 I_RW) = N U / I_RW        energy of the wheels that hold it          (Eq 90)

The least that a step takes: the rover comes to rest above the edge and tips over. g and Phi are
those of gravity across the edge. Elliott 2019, Section 5.6.1.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from nullmotion.rover.rover import Site
from nullmotion.rover.wheels import WheelRover, check_stays, pitch


@dataclass(frozen=True)
class ImpulsiveStep:
    """What an impulsive step takes.

    Attributes:
        lift: U [J].
        momentum: H [N m s].
        wheel_speed: Speed of the fastest wheel before braking [rad/s].
        energy: E [J].
        distance: How far the mass centre gets along the ground [m].
        cost_of_travel: E/(M distance) [J/(kg m)].
        outcome: ``landed``, or ``stalled`` where a wheel cannot turn as fast.
    """

    lift: float
    momentum: float
    wheel_speed: float
    energy: float
    distance: float
    cost_of_travel: float
    outcome: str


def impulsive_step(
    rover: WheelRover, edge: int = 1, site: Site | None = None, face: int | None = None
) -> ImpulsiveStep:
    """Return what an impulsive step over an edge takes.

    Args:
        rover: The rover.
        edge: Edge, from 1.
        site: Gravity and slope; level ground on Mars by default.
        face: Face on the ground before the step; the lower number of the two by default.

    Raises:
        InputError: For an edge that it does not have, or a slope on which it does not stay.
    """
    site = site or Site()
    frame = rover.chassis.edge_frame(edge, face)
    check_stays(rover.chassis, frame, site)
    model = rover.model(frame, site)
    across = math.hypot(model.gravity[0], model.gravity[2])
    climb = max(frame.alpha + pitch(frame, site.vector), 0.0)
    U = model.mass * across * frame.com_distance * (1 - math.cos(climb))
    H = math.sqrt(2 * model.N * U)
    E = model.N * U / rover.wheel_inertia
    speed = H / rover.wheel_inertia * float(abs(frame.r).max())
    outcome = "landed" if speed <= rover.speed_limit else "stalled"
    cost = E / (rover.mass * frame.distance)
    return ImpulsiveStep(U, H, speed, E, frame.distance, cost, outcome)
