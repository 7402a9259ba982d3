"""The constants of a step over an edge, as plain numbers along the axes of the step.

Axes x, y, z are f, r, p of the step, turned with the body; at theta = 0 both are the same.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from nullmotion.rover.edge_frame import EdgeFrame
from nullmotion.rover.rover import Rover, Site


class StepModel(NamedTuple):
    """Numbers (or symbols) behind the equations of `step_dynamics`.

    Attributes:
        mass: M [kg].
        N: Inertia of chassis and mass about the edge, without the CMG [kg m^2].
        coupling: Products of inertia I_xy and I_zy of the chassis [kg m^2], (2,).
        com: cm/o before the step [m], (3,).
        half_edge: Half the edge's length, L/2 [m].
        gravity: Gravitational acceleration along f, r, p [m/s^2], (3,).
        s0: Spin axis at delta = 0, (3,).
        g: Gimbal axis, (3,).
        o0: Output axis at delta = 0, g x s0, (3,).
        h: The rotor's momentum [N m s].
        A: Inertia of rotor and gimbal along s, g, o [kg m^2], (3,).
        h_rotor: Rotor inertia times speed, for the energy [N m s].
    """

    mass: Any
    N: Any
    coupling: Any
    com: Any
    half_edge: Any
    gravity: Any
    s0: Any
    g: Any
    o0: Any
    h: Any
    A: Any
    h_rotor: Any

    @property
    def scale(self) -> Any:
        """M g L/2, the greatest dynamic threshold at rest on level ground [N m]."""
        x, y, z = self.gravity
        return self.mass * (x * x + y * y + z * z) ** 0.5 * self.half_edge

    @property
    def numbers(self) -> list[float]:
        """All constants in one row, as `from_numbers` takes them, (SIZE,)."""
        return [float(v) for part in self for v in np.atleast_1d(part)]


_LENGTHS = StepModel(1, 1, 2, 3, 1, 3, 3, 3, 3, 1, 3, 1)
SIZE = sum(_LENGTHS)


def from_numbers(values: Any) -> StepModel:
    """Return the model of a row of numbers or symbols, (SIZE,)."""
    parts, start = [], 0
    for length in _LENGTHS:
        part = tuple(values[start + i] for i in range(length))
        parts.append(part if length > 1 else part[0])
        start += length
    return StepModel(*parts)


def step_model(rover: Rover, frame: EdgeFrame, site: Site) -> StepModel:
    """Return the constants of a rover's step over an edge at a site."""
    cmg = rover.cmg
    s0, g, o0 = (_plain(frame.axes @ axis) for axis in cmg.axes(0.0))
    J = frame.axes @ rover.chassis.inertia @ frame.axes.T
    return StepModel(
        mass=rover.mass,
        N=float(J[1, 1] + rover.mass * frame.com_distance**2),
        coupling=_plain(J[[0, 2], 1]),
        com=_plain(frame.com),
        half_edge=frame.length / 2,
        gravity=_plain(site.vector),
        s0=s0,
        g=g,
        o0=o0,
        h=cmg.momentum,
        A=_plain(cmg.inertia),
        h_rotor=cmg.rotor_inertia * cmg.rotor_speed,
    )


def _plain(values: np.ndarray) -> tuple[float, ...]:
    """Return Python's floats: NumPy's do not multiply CasADi's symbols."""
    return tuple(float(v) for v in values)
