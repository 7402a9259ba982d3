"""Trajectories of Section 4.4 of Elliott 2019: from no momentum to two random ones and back."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nullmotion.papers.elliott2019_spheres import Function

DT = 0.001  # s
GREATEST = 1.0  # |torque| [h/s]
_LINE = 500  # points of a straight line that are looked at
_SPARE = 1.25  # steps a trajectory may take over those of its path: singular arrays lag behind


@dataclass(frozen=True)
class Course:
    """One trajectory to follow.

    Attributes:
        waypoints: Momenta to go to one after another, the last one zero, (3, 3) [h].
        lengths: Length of the torque at every step [h/s], (steps,).
    """

    waypoints: np.ndarray
    lengths: np.ndarray


def courses(capability: Function, reach: float, count: int, seed: int) -> list[Course]:
    """Return random trajectories of momenta at which a torque capability is above 0.

    The envelope is not quite convex: waypoints that a straight line joins outside of it are
    drawn again.

    Args:
        capability: The torque capability of momenta (k, 3).
        reach: Half the side of a cube around the envelope [h].
        count: Number of trajectories.
        seed: Of all random numbers.
    """
    rng, made = np.random.default_rng(seed), list[Course]()
    while len(made) < count:
        drawn = rng.uniform(-reach, reach, (64, 3))
        drawn = drawn[capability(drawn) > 0]
        if len(drawn) < 2:
            continue
        waypoints = np.concatenate([drawn[:2], np.zeros((1, 3))])
        if (capability(along(waypoints)) > 0).all():
            length = np.linalg.norm(np.diff(waypoints, axis=0, prepend=0.0), axis=1).sum()
            steps = int(_SPARE * length / (0.5 * GREATEST * DT))
            made.append(Course(waypoints, rng.uniform(0.0, GREATEST, steps)))
    return made


def along(waypoints: np.ndarray) -> np.ndarray:
    """Return momenta on the straight lines from no momentum to the waypoints, (k, 3)."""
    ends = np.concatenate([np.zeros((1, 3)), waypoints])
    share = np.linspace(0.0, 1.0, _LINE)[:, None, None]
    return np.asarray((ends[:-1] + share * (ends[1:] - ends[:-1])).reshape(-1, 3))
