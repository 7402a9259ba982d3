"""Gimbal angles to start from: those of about a momentum."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from scipy.spatial import cKDTree

from nullmotion.atlas.torque_climb import Climber

_SAMPLES = 40_000
_KEPT = 0.7  # share of the samples that are kept, the most regular ones
_SEED = 20240607


@dataclass(frozen=True, eq=False)
class Starts:
    """Random gimbal angles and a search tree of their momenta.

    Half of the angles are even. The others lean, more or less, towards the most momentum in a
    random direction: angles of large momenta are rare.

    Attributes:
        delta: Gimbal angles [rad], (S, n).
        tree: Their momenta over the mean momentum.
    """

    delta: np.ndarray
    tree: cKDTree

    def near(self, h: np.ndarray, count: int) -> np.ndarray:
        """Return the angles of the momenta closest to given ones, (B, count, n)."""
        found: np.ndarray = self.delta[self.tree.query(h, np.arange(1, count + 1))[1]]
        return found


@lru_cache(maxsize=4)
def drawn(climber: Climber) -> Starts:
    """Return random angles of an array and, turned by half a turn, their mirror images."""
    rng = np.random.default_rng(_SEED)
    delta = rng.uniform(-np.pi, np.pi, (_SAMPLES, climber.n))
    u = rng.normal(size=(_SAMPLES // 2, climber.m))
    most = np.arctan2(u @ climber.torque.T, u @ climber.spin.T)
    delta[: len(u)] = most + rng.uniform(size=(len(u), 1)) * delta[: len(u)]
    c, s = np.cos(delta), np.sin(delta)
    A = c[:, None] * climber.torque.T - s[:, None] * climber.spin.T
    kept = np.arange(len(delta))
    if climber.n >= climber.m:
        kept = np.argsort(-np.linalg.det(A @ A.mT), kind="stable")[: int(_KEPT * len(delta))]
    h = c[kept] @ climber.spin + s[kept] @ climber.torque
    tree = cKDTree(np.concatenate([h, -h]))
    return Starts(np.concatenate([delta[kept], delta[kept] + np.pi]), tree)
