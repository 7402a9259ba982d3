"""What a chassis's shape does for a rover: slopes, torque to step, robustness.

    slope    = least alpha over all steps: the steepest ground on which it stays whichever way
               it stands (Table 8)
    tau_r    = M g d            torque about the edge with the mass centre level with it
    tau_dist = M g c            torque across it that takes the weight off one spike
    eta      = tau_r / tau_dist = d / c                                                (Eq 163)

d is the distance of the mass centre from the edge and c its distance along the edge from the
nearer end: L/2 for a regular chassis. Smaller eta means more robustness for less torque
(Table 9). Elliott 2019, Section 7.4.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from nullmotion.rover.chassis import Chassis, positive
from nullmotion.rover.polyhedron import NAMES
from nullmotion.rover.rover import MARS


@dataclass(frozen=True)
class ChassisRow:
    """How a chassis compares with others.

    Attributes:
        name: Its name.
        slope: Steepest ground on which it stays, whichever way it stands [rad].
        ratio: The greatest eta of any edge; inf if the mass centre is beyond an edge's end.
        step_torque: The greatest tau_r of any edge [N m].
        disturbance_torque: The least tau_dist of any edge [N m].
        distance: The shortest step [m].
    """

    name: str
    slope: float
    ratio: float
    step_torque: float
    disturbance_torque: float
    distance: float


def chassis_row(chassis: Chassis, gravity: float = MARS) -> ChassisRow:
    """Return how a chassis compares.

    Args:
        chassis: The chassis.
        gravity: g [m/s^2].

    Raises:
        InputError: For a gravity that is not above 0.
    """
    weight = chassis.mass * positive("gravity", gravity)
    frames = [
        chassis.edge_frame(edge, face)
        for edge in range(1, len(chassis.edges) + 1)
        for face in chassis.faces_at(edge)
    ]
    d = np.array([frame.com_distance for frame in frames])
    c = np.array([max(frame.length / 2 - abs(frame.com[1]), 0.0) for frame in frames])
    with np.errstate(divide="ignore"):
        ratio = float((d / c).max())
    return ChassisRow(
        chassis.name,
        slope=min(frame.alpha for frame in frames),
        ratio=ratio,
        step_torque=weight * float(d.max()),
        disturbance_torque=weight * float(c.min()),
        distance=min(frame.distance for frame in frames),
    )


def platonic_rows(
    names: Iterable[str] = NAMES,
    edge_length: float = 1.0,
    mass: float = 1.0,
    gravity: float = MARS,
) -> list[ChassisRow]:
    """Return how the platonic solids compare, as in Tables 8 and 9.

    Args:
        names: Which.
        edge_length: L [m].
        mass: M [kg].
        gravity: g [m/s^2].

    Raises:
        InputError: For an unknown solid, or a value that is not above 0.
    """
    return [chassis_row(Chassis.named(name, edge_length, mass), gravity) for name in names]
