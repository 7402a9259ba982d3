"""What the contact simulation moves: a rover as plain numbers, and its state."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from nullmotion.rover.rover import Rover, Site

STATES = 15


class Machine(NamedTuple):
    """A rover and gravity as plain numbers.

    Attributes:
        mass: M [kg].
        inertia: J about the mass centre in B [kg m^2], (3, 3).
        gravity: In ground axes [m/s^2], (3,).
        momentum: h [N m s].
        gimbal_axis: g in B, (3,).
        spin_axis: s_0, spin axis at delta = 0 in B, (3,).
        cmg_inertia: I_s, I_g, I_o: along s, g, o, rotor and gimbal [kg m^2], (3,).
        rotor_share: Rotor inertia times speed, over h: what Eq 88 counts of the rotor's power.
    """

    mass: float
    inertia: np.ndarray
    gravity: np.ndarray
    momentum: float
    gimbal_axis: np.ndarray
    spin_axis: np.ndarray
    cmg_inertia: np.ndarray
    rotor_share: float

    @classmethod
    def of(cls, rover: Rover, site: Site) -> Machine:
        """Return a rover's numbers at a site."""
        cmg = rover.cmg
        return cls(
            mass=float(rover.mass),
            inertia=rover.chassis.inertia,
            gravity=site.vector,
            momentum=float(cmg.momentum),
            gimbal_axis=cmg.gimbal_axis,
            spin_axis=cmg.spin_axis,
            cmg_inertia=cmg.inertia,
            rotor_share=float(cmg.rotor_inertia * cmg.rotor_speed / cmg.momentum),
        )


class State(NamedTuple):
    """Where the rover is: position [m], q_BN, velocity [m/s], omega_B [rad/s], gimbal."""

    position: Any
    attitude: Any
    velocity: Any
    rate: Any
    delta: Any
    delta_dot: Any

    @classmethod
    def of(cls, x: Any) -> State:
        """Return the state in a row of 15 numbers, or states in the columns of (15, ...)."""
        return cls(x[:3], x[3:7], x[7:10], x[10:13], x[13], x[14])

    @classmethod
    def at_rest(cls) -> State:
        """Return a state at the origin, as an example."""
        return cls(np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0]), np.zeros(3), np.zeros(3), 0.0, 0.0)
