"""A rover that one CMG rolls over its edges, and the place where it does so (Elliott 2019)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nullmotion.errors import InputError
from nullmotion.rover.chassis import Chassis, positive
from nullmotion.rover.cmg import Cmg
from nullmotion.rover.edge_frame import EdgeFrame

MARS = 3.711  # [m/s^2], Table 2


@dataclass(frozen=True, eq=False)
class Rover:
    """A chassis with one CMG inside.

    Args:
        chassis: Shape, mass and inertia.
        cmg: The CMG.
        friction: Coulomb's coefficient of the spikes on the ground; None: they never slip.
        name: What to call it.

    Raises:
        InputError: For a friction coefficient that is not above 0.
    """

    chassis: Chassis
    cmg: Cmg
    friction: float | None = None
    name: str = "rover"

    def __post_init__(self) -> None:
        """Check what can be checked."""
        if self.friction is not None:
            object.__setattr__(self, "friction", positive("friction", self.friction))

    @property
    def mass(self) -> float:
        """Mass of the whole rover [kg]."""
        return self.chassis.mass

    def edge_frame(self, edge: int, face: int | None = None) -> EdgeFrame:
        """Return the frame of a step over an edge, as `Chassis.edge_frame` does."""
        return self.chassis.edge_frame(edge, face)


@dataclass(frozen=True)
class Site:
    """Gravity and slope where a step is made.

    Args:
        gravity: Gravitational acceleration [m/s^2].
        incline: Slope of the ground, uphill above 0 [rad].
        heading: Direction of the climb seen from the step, positive towards r [rad].

    Raises:
        InputError: For a gravity that is not above 0, or a slope of 90 deg or more.
    """

    gravity: float = MARS
    incline: float = 0.0
    heading: float = 0.0

    def __post_init__(self) -> None:
        """Check what can be checked."""
        positive("gravity", self.gravity)
        if not abs(self.incline) < np.pi / 2:
            raise InputError("incline", self.incline, "an angle within +-pi/2 (rad)")
        if not np.isfinite(self.heading):
            raise InputError("heading", self.heading, "a finite angle (rad)")

    @property
    def vector(self) -> np.ndarray:
        """Gravitational acceleration along f, r, p of the step [m/s^2], (3,)."""
        level = np.sin(self.incline)
        uphill = np.array([np.cos(self.heading), np.sin(self.heading), 0.0])
        return -self.gravity * (level * uphill + np.cos(self.incline) * np.array([0.0, 0.0, 1.0]))


def peter() -> Rover:
    """Return the rover of Elliott 2019: a tetrahedron of 47 kg and 1 m (Table 2, Eq 67).

    At delta = 0 the spin axis is as near to e1 as it can be, so that o . r = 0 on e1.
    """
    chassis = Chassis.named("tetrahedron", edge_length=1.0, mass=47.0)
    cmg = Cmg(
        gimbal_axis=chassis.gimbal_axis(),
        spin_axis=np.array([1.0, 0.0, 0.0]),
        momentum=115.0,
        rate_limit=2.0,
        acceleration_limit=20.0,
        inertia=np.array([0.55, 0.45, 0.36]),
        rotor_inertia=0.14,
        rotor_speed=800.0,
    )
    return Rover(chassis, cmg, name="PETER")
