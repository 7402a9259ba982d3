"""Angles that hold a momentum: Newton's steps, and angles to start them from."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from nullmotion import linalg, ops
from nullmotion.atlas.envelope_lanes import Lanes
from nullmotion.atlas.envelope_rings import Rings

_SAMPLES = 50_000
_NEAR = 24  # samples around a momentum
_APART = 0.15  # sine of half the angle between two starts that are not the same
_LEAST = 1e-9  # added to the eigenvalues of A A^T, in units of the mean momentum squared
_STEP = 0.7  # largest step of a gimbal [rad]
_CLIMB = 0.3  # length of a step of null motion towards regular angles [rad]
_SEED = 20240531


def solved(
    rings: Rings, delta: np.ndarray, h: np.ndarray, steps: int = 6, climbing: int = 0
) -> np.ndarray:
    """Return angles (B, c) moved towards momenta (B, m) by Newton's steps of least norm.

    The first ``climbing`` steps have null motion up the gradient of log det(A A^T) beside them.
    """
    lanes = Lanes(_step, (rings.circles,), ((delta.shape[1],), (rings.m,), ()))
    climbing = min(climbing, steps)
    for rounds, climb in ((climbing, 1.0), (steps - climbing, 0.0)):
        if rounds:
            delta = lanes(delta, h, np.full(len(h), climb), rounds=rounds, back=1)
    return delta


def _step(circles: Any, delta: Any, h: Any, climb: Any) -> Any:
    """Return angles after a step; source."""
    cosine, sine = ops.cos(delta)[:, None], ops.sin(delta)[:, None]
    part = cosine * circles[:, 0] + sine * circles[:, 1]
    column = cosine * circles[:, 1] - sine * circles[:, 0]
    gram = column.T @ column + _LEAST * np.eye(len(h))
    adjugate = linalg.adjugate(gram)
    back = column @ (adjugate * (1.0 / (gram[0] @ adjugate[:, 0])))  # (c, m): A^+
    step = back @ (h - part.sum(axis=0))
    if len(delta) > len(h):
        gradient = -2 * (back * part).sum(axis=1)
        null = gradient - back @ (column.T @ gradient)
        size = ops.maximum(linalg.norm(null), 1e-12)
        step = step + climb * ops.minimum(_CLIMB, _CLIMB / size) * null
    greatest = ops.maximum(ops.amax(ops.absolute(step)), 1e-12)
    return delta + step * ops.minimum(1.0, _STEP / greatest)


@dataclass(frozen=True, eq=False)
class Samples:
    """Random gimbal angles and their momenta.

    Attributes:
        delta: Angles of the circles, (S, c).
        measure: det(A A^T) of each, (S,).
        tree: Their momenta.
    """

    delta: np.ndarray
    measure: np.ndarray
    tree: cKDTree

    def near(self, h: np.ndarray, count: int, among: int = _NEAR) -> np.ndarray:
        """Return ``count`` of the nearest angles of each momentum, (B, count, c).

        The most regular one first, then those most unlike the ones before: each way to hold a
        momentum is to be met, the nearly singular ones too.
        """
        found = self.tree.query(h, among)[1]
        angles, rows = self.delta[found], np.arange(len(h))
        best, chosen = self.measure[found].argmax(axis=1), []
        unlike = np.full(found.shape, np.inf)
        for _ in range(count):
            chosen.append(angles[rows, best])
            apart = np.abs(np.sin(0.5 * (angles - chosen[-1][:, None]))).max(axis=2)
            unlike = np.minimum(unlike, apart)
            best = unlike.argmax(axis=1)
        return np.stack(chosen, axis=1)


def sampled(rings: Rings) -> Samples:
    """Return random angles with their mirror images."""
    rng = np.random.default_rng(_SEED)
    delta = rng.uniform(-np.pi, np.pi, (_SAMPLES, len(rings.ring_of)))
    part, column = rings.parts(delta)
    measure = np.linalg.det(column.mT @ column)
    h = part.sum(axis=1)
    tree = cKDTree(np.concatenate([h, -h]))
    return Samples(np.concatenate([delta, delta + np.pi]), np.tile(measure, 2), tree)


def unlike(angles: np.ndarray, score: np.ndarray, count: int) -> np.ndarray:
    """Return the best of angles (B, T, c) by score (B, T) that are not the same, (B, count, c)."""
    left, rows, chosen = score.copy(), np.arange(len(score)), []
    for _ in range(count):
        best = left.argmax(axis=1)
        chosen.append(angles[rows, best])
        apart = np.abs(np.sin(0.5 * (angles - chosen[-1][:, None]))).max(axis=2)
        left = np.where(apart < 0.1 * _APART, -2.0, left)
    return np.stack(chosen, axis=1)
