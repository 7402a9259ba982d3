"""Self-motion: gimbal angles that hold one momentum, found and walked along in batches.

The angles with h(delta) = h form closed curves (n = m + 1) or surfaces, in several pieces.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from nullmotion.array.model import CmgArray

CLOSE = 1e-12  # momentum error over the mean momentum that counts as none
STRIDE = 0.05  # rad
_WALKERS = 64
_LONGEST = 0.5  # rad, of a Gauss-Newton step
_ROUNDS = 12  # of three steps each; four are usual
_DAMPING = 1e-12


def drawn(array: CmgArray, momentum: np.ndarray, count: int, rng: Any) -> np.ndarray:
    """Return angles of a momentum from ``count`` random ones, those that got there."""
    left, found = rng.uniform(-np.pi, np.pi, (count, array.n)), []
    for _ in range(_ROUNDS):
        left = projected(array, left, momentum, rounds=3)
        there = holds(array, left, momentum)
        found.append(left[there])
        left = left[~there]
    return np.concatenate(found)


def walked(
    array: CmgArray, start: np.ndarray, momentum: np.ndarray, strides: int, rng: Any
) -> np.ndarray:
    """Return angles along the self-motion from a start, both ways or in random directions."""
    walkers = 2 if array.n == array.m + 1 else _WALKERS
    delta = np.tile(start, (walkers, 1))
    heading = rng.normal(size=delta.shape)
    heading[1::2] = -heading[::2]
    found = []
    for _ in range(strides):
        heading = along(array, delta, heading)
        delta = projected(array, delta + STRIDE * heading, momentum, rounds=3)
        found.append(delta)
    every = np.concatenate(found)
    return every[holds(array, every, momentum)]


def along(array: CmgArray, delta: np.ndarray, heading: np.ndarray) -> np.ndarray:
    """Return unit vectors of null motion nearest to some headings, (k, n)."""
    A = array.unit_jacobian(delta)
    turn = heading - _least(A, np.einsum("kmn,kn->km", A, heading))
    return turn / np.maximum(np.linalg.norm(turn, axis=1, keepdims=True), 1e-12)


def projected(array: CmgArray, delta: np.ndarray, momentum: np.ndarray, rounds: int) -> np.ndarray:
    """Return angles moved towards a momentum by Gauss-Newton, (k, n)."""
    for _ in range(rounds):
        step = _least(array.unit_jacobian(delta), _missing(array, delta, momentum))
        size = np.linalg.norm(step, axis=1, keepdims=True)
        delta = delta + step * np.minimum(1.0, _LONGEST / np.maximum(size, 1e-12))
    return delta


def holds(array: CmgArray, delta: np.ndarray, momentum: np.ndarray) -> np.ndarray:
    """Return which angles hold the momentum and are allowed by the end stops, (k,)."""
    low, high = np.asarray(array.angle_limits, float).T
    inside = ((delta >= low) & (delta <= high)).all(axis=1)
    close: np.ndarray = np.abs(_missing(array, delta, momentum)).max(axis=1) <= CLOSE
    return inside & close


def _missing(array: CmgArray, delta: np.ndarray, momentum: np.ndarray) -> np.ndarray:
    missing: np.ndarray = (momentum - array.momentum(delta)) / array.mean_momentum
    return missing


def _least(A: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return A^+ b with a trace of damping, for many A (k, m, n) and b (k, m)."""
    AAT = A @ A.transpose(0, 2, 1) + _DAMPING * np.eye(A.shape[1])
    found: np.ndarray = np.einsum("kmn,km->kn", A, np.linalg.solve(AAT, b[..., None])[..., 0])
    return found
