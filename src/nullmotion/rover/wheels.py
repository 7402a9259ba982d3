"""Rovers that reaction wheels inside roll over their edges: Hedgehog and a tetrahedral variant.

Three equal wheels lie along orthogonal axes, so that an edge in any direction r is driven alike:
each wheel takes its share r_i of torque and speed, and sum r_i^2 = 1. The wheels count as one
about r.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from nullmotion.errors import InputError
from nullmotion.rover.chassis import Chassis, positive
from nullmotion.rover.edge_frame import EdgeFrame
from nullmotion.rover.rover import Site
from nullmotion.rover.step_model import StepModel

_SLACK = 1e-9  # a slope as steep as allowed is allowed


@dataclass(frozen=True, eq=False)
class WheelRover:
    """A chassis with three equal reaction wheels along its body axes.

    Args:
        chassis: Shape, mass and inertia; the wheels are included in both.
        wheel_inertia: I_RW, of each wheel about its axis [kg m^2].
        speed_limit: Greatest speed of a wheel against the body [rad/s].
        torque_limit: Greatest torque of a wheel's motor [N m]; a brake has none.
        name: What to call it.

    Raises:
        InputError: For a value that is not above 0, or wheels heavier than the rover.
    """

    chassis: Chassis
    wheel_inertia: float
    speed_limit: float = math.inf
    torque_limit: float = math.inf
    name: str = "wheel rover"

    def __post_init__(self) -> None:
        """Check what can be checked."""
        object.__setattr__(self, "wheel_inertia", positive("wheel_inertia", self.wheel_inertia))
        least = float(np.linalg.eigvalsh(self.chassis.inertia)[0])
        if self.wheel_inertia >= least:
            allowed = f"less than the rover's own inertia, {least:.4g} kg m^2"
            raise InputError("wheel_inertia", self.wheel_inertia, allowed)
        for key in ("speed_limit", "torque_limit"):
            if not getattr(self, key) > 0:
                raise InputError(key, getattr(self, key), "a number above 0")

    @property
    def mass(self) -> float:
        """Mass of the whole rover [kg]."""
        return self.chassis.mass

    def model(self, frame: EdgeFrame, site: Site) -> StepModel:
        """Return the constants of a step; the wheels are part of the body."""
        J = frame.axes @ self.chassis.inertia @ frame.axes.T
        still = (0.0, 0.0, 0.0)
        x, y, z = (float(v) for v in frame.com)
        f, r, p = (float(v) for v in site.vector)
        return StepModel(
            mass=self.mass,
            N=float(J[1, 1] + self.mass * frame.com_distance**2),
            coupling=(float(J[0, 1]), float(J[2, 1])),
            com=(x, y, z),
            half_edge=frame.length / 2,
            gravity=(f, r, p),
            s0=(1.0, 0.0, 0.0),
            g=(0.0, 1.0, 0.0),
            o0=(0.0, 0.0, -1.0),
            h=0.0,
            A=still,
            h_rotor=0.0,
        )


def hedgehog() -> WheelRover:
    """Return Hedgehog: a cube of 18.75 kg and 0.25 m (Elliott 2019, Table 5)."""
    return WheelRover(Chassis.named("cube", 0.25, 18.75), 0.00095, name="Hedgehog")


def hypothesised() -> WheelRover:
    """Return Hedgehog's tetrahedral variant (Elliott 2019, Section 5.6).

    Its inscribed sphere is the cube's, so L = sqrt(6) 0.25 m (0.61 m in print); mass, inertia
    and wheels are Hedgehog's, which is what its printed energies come from.
    """
    cube = hedgehog()
    points = Chassis.named("tetrahedron", math.sqrt(6) * 0.25).vertices
    chassis = Chassis(points, cube.mass, cube.chassis.inertia, "tetrahedron")
    return WheelRover(chassis, cube.wheel_inertia, name="hypothesised rover")


def pitch(frame: EdgeFrame, gravity: np.ndarray) -> float:
    """Return the slope that gravity across an edge sees, uphill above 0 [rad].

    Args:
        frame: Frame of the step.
        gravity: Gravitational acceleration along f, r, p [m/s^2], (3,).
    """
    return math.atan2(-gravity[0], -gravity[2])


def check_stays(chassis: Chassis, frame: EdgeFrame, site: Site) -> None:
    """Refuse a slope on which a chassis does not stay before and after a step.

    Raises:
        InputError: With the slope that would do.
    """
    for when, held in zip(("before", "after"), _held(chassis, frame, site), strict=True):
        if not held:
            face = frame.start_face if when == "before" else frame.end_face
            limit = math.degrees(chassis.edge_frame(frame.edge, face).alpha)
            allowed = (
                f"a slope on which the {chassis.name} stays {when} the step without its "
                f"actuator (straight over this edge: {limit:.4g} deg)"
            )
            raise InputError("incline_deg", round(math.degrees(site.incline), 6), allowed)


def stays_around(chassis: Chassis, frame: EdgeFrame, site: Site) -> bool:
    """Return whether a chassis stays on a slope before and after a step."""
    return all(_held(chassis, frame, site))


def _held(chassis: Chassis, frame: EdgeFrame, site: Site) -> tuple[bool, bool]:
    ends = ((frame.start_face, 0.0), (frame.end_face, frame.turn))
    first, last = (
        stays(chassis, face, frame.rotation(theta).T @ site.vector) for face, theta in ends
    )
    return first, last


def stays(chassis: Chassis, face: int, gravity: np.ndarray) -> bool:
    """Return whether a chassis stays on a face under gravity in body axes [m/s^2], (3,)."""
    loop = set(chassis.faces[face])
    for edge, pair in enumerate(chassis.edges, 1):
        if loop >= {int(i) for i in pair}:
            frame = chassis.edge_frame(edge, face)
            if -pitch(frame, frame.axes @ gravity) > frame.alpha + _SLACK:
                return False
    return True
