"""How far the rover at rest is from tipping over an edge of the face it stands on.

    spare_k = T . r_k - M (c_k x g) . r_k          for each edge k of the face, >= 0 at rest

r_k runs counter-clockwise from above, so that a positive turn about it tips over edge k; T drives
the CMG, the body feels -T. The static threshold of Elliott 2019, Section 5.3, is where one is 0.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from nullmotion.rover.edge_frame import EdgeFrame
from nullmotion.rover.rover import Rover, Site
from nullmotion.rover.step_dynamics import State
from nullmotion.rover.step_plan import StepPlan


def base_edges(rover: Rover, face: int) -> list[int]:
    """Return the edges of a face, counter-clockwise from above."""
    loop = rover.chassis.faces[face]
    rows = [set(pair) for pair in rover.chassis.edges.tolist()]
    return [rows.index({loop[i], loop[(i + 1) % len(loop)]}) + 1 for i in range(len(loop))]


def weight_spares(rover: Rover, frame: EdgeFrame, site: Site) -> tuple[np.ndarray, np.ndarray]:
    """Return what gravity leaves to spare over each edge, and the edges' directions.

    Args:
        rover: The rover, at rest on the frame's first face.
        frame: Frame in which the site's slope is given.
        site: Gravity and slope.

    Returns:
        Spares [N m], (k,), below 0 where it falls over; r_k in body axes, (k, 3). The edges are
        those of `base_edges`.
    """
    gravity = site.vector @ frame.axes
    around = base_edges(rover, frame.start_face)
    frames = [rover.edge_frame(edge, frame.start_face) for edge in around]
    spares = [rover.mass * np.cross(f.point, gravity) @ f.r for f in frames]
    return np.array(spares), np.array([f.r for f in frames])


def rest_torque(rover: Rover, delta: Any, delta_dot: Any, delta_ddot: Any) -> np.ndarray:
    """Return T = h delta' o + A_g delta'' g of a rover at rest, in body axes [N m], (..., 3)."""
    _, g, o = rover.cmg.axes(np.asarray(delta, float)[..., None])
    swing = rover.cmg.momentum * np.asarray(delta_dot)[..., None] * o
    torque: np.ndarray = swing + rover.cmg.inertia[1] * np.asarray(delta_ddot)[..., None] * g
    return torque


def static_spare(rover: Rover, frame: EdgeFrame, site: Site, torque: Any) -> np.ndarray:
    """Return the least torque to spare over the edges of the face [N m], (...).

    Args:
        rover: The rover, at rest on the frame's first face.
        frame: Frame in which the site's slope is given.
        site: Gravity and slope.
        torque: T in body axes [N m], (..., 3).
    """
    weight, r = weight_spares(rover, frame, site)
    least: np.ndarray = (weight + torque @ r.T).min(axis=-1)
    return least


def resting_margin(plan: StepPlan, state: State) -> np.ndarray:
    """Return the torque to spare before a body at rest tips over another edge [N m], (k,)."""
    weight, r = weight_spares(plan.rover, plan.frame, plan.site)
    others = [e != plan.frame.edge for e in base_edges(plan.rover, plan.frame.start_face)]
    torque = rest_torque(plan.rover, state.delta, state.delta_dot, state.delta_ddot)
    least: np.ndarray = (weight[others] + torque @ r[others].T).min(axis=-1)
    return least
