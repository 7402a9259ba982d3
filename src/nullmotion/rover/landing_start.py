"""How a rover stands before a step: at rest on its face, sunk in as far as its weight takes it.

The loads on the spikes balance weight and its moment about the ground; springs share them as
F_i = a + b x_i + c y_i, where no spike may pull. On a slope the centre of the load is below the
mass centre, along gravity.
"""

from __future__ import annotations

import numpy as np

from nullmotion.rover.edge_frame import EdgeFrame
from nullmotion.rover.ground import Ground
from nullmotion.rover.rover import Rover, Site


def standing(
    rover: Rover,
    site: Site,
    frame: EdgeFrame,
    ground: Ground,
    delta: float = 0.0,
    delta_dot: float = 0.0,
) -> tuple[np.ndarray, np.ndarray]:
    """Return the state of a standing rover, and which of its spikes carry.

    Args:
        rover: The rover.
        site: Gravity and slope.
        frame: Frame of the step; ground axes are f, r, p, from the edge's middle.
        ground: The ground.
        delta: Gimbal angle [rad].
        delta_dot: Gimbal rate [rad/s].

    Returns:
        State (15,) and carrying (V,), 1 or 0.
    """
    from scipy.spatial.transform import Rotation

    spikes = frame.spike_positions(rover.chassis.vertices, 0.0)
    base = np.flatnonzero(spikes[:, 2] < 1e-6 * frame.length)
    load, (a, b, c) = shares(spikes[base], frame.com, rover.mass * site.vector)
    sunk = np.array([a, b, c]) / ground.stiffness
    # the plane z = -(a + b x + c y) / K_c: turned about the ground's axes by its slopes
    leaning = Rotation.from_rotvec([-sunk[2], sunk[1], 0.0])
    attitude = leaning * Rotation.from_matrix(frame.rotation(0.0))
    position = leaning.apply(frame.com) - [0.0, 0.0, sunk[0]]
    x = np.concatenate(
        [position, attitude.as_quat(scalar_first=True), np.zeros(6), [delta, delta_dot]]
    )
    carrying = np.zeros(len(spikes))
    carrying[base[load > 0]] = 1.0
    return x, carrying


def attitude(frame: EdgeFrame) -> np.ndarray:
    """Return q_BN of a rover flat on its face, N being f, r, p, (4,)."""
    from scipy.spatial.transform import Rotation

    q_BN: np.ndarray = Rotation.from_matrix(frame.rotation(0.0)).as_quat(scalar_first=True)
    return q_BN


def shares(
    points: np.ndarray, com: np.ndarray, weight: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return the loads on spikes [N], (n,), and a, b, c of F = a + b x + c y.

    Spikes that would pull are left out until none does.
    """
    foot = com - weight * (com[2] / weight[2])
    needed = -weight[2] * np.array([1.0, foot[0], foot[1]])
    carry = np.ones(len(points), bool)
    while True:
        rows = np.column_stack([np.ones(len(points)), points[:, :2]])
        plane = np.linalg.lstsq(rows[carry].T @ rows[carry], needed, rcond=None)[0]
        load = np.where(carry, rows @ plane, 0.0)
        if carry.sum() <= 2 or load.min() >= -1e-9 * needed[0]:
            return np.maximum(load, 0.0), plane
        carry &= load > 0
