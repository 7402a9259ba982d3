"""Gimbal angles to start from: those of about a momentum."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from scipy.spatial import cKDTree

from nullmotion.atlas.torque_climb import Climber

_SAMPLES = 40_000
_CHOICE = 2  # samples around a momentum for each that is taken
_SEED = 20240607


@dataclass(frozen=True, eq=False)
class Starts:
    """Random gimbal angles and a search tree of their momenta.

    Half of the angles are even. The others lean, more or less, towards the most momentum in a
    random direction: angles of large momenta are rare.

    Attributes:
        delta: Gimbal angles [rad], (S, n).
        value: Logarithm of their torque capability, (S,).
        tree: Their momenta over the mean momentum.
    """

    delta: np.ndarray
    value: np.ndarray
    tree: cKDTree

    def near(self, h: np.ndarray, count: int) -> np.ndarray:
        """Return angles of about given momenta (B, m), the most capable ones, (B, count, n)."""
        found = self.tree.query(h, np.arange(1, _CHOICE * count + 1))[1]
        order = np.argsort(-self.value[found], axis=1, kind="stable")[:, :count]
        chosen: np.ndarray = self.delta[np.take_along_axis(found, order, axis=1)]
        return chosen


@lru_cache(maxsize=4)
def drawn(climber: Climber) -> Starts:
    """Return random angles of an array and, turned by half a turn, their mirror images."""
    rng = np.random.default_rng(_SEED)
    delta = rng.uniform(-np.pi, np.pi, (_SAMPLES, climber.n))
    u = rng.normal(size=(_SAMPLES // 2, climber.m))
    most = np.arctan2(u @ climber.torque.T, u @ climber.spin.T)
    delta[: len(u)] = most + rng.uniform(size=(len(u), 1)) * delta[: len(u)]
    h = np.cos(delta) @ climber.spin + np.sin(delta) @ climber.torque
    value = climber.climbed(delta, h, 1.0, 0).least
    tree = cKDTree(np.concatenate([h, -h]))
    return Starts(np.concatenate([delta, delta + np.pi]), np.tile(value, 2), tree)
