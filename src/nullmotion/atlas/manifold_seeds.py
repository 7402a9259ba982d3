"""Gimbal angles of a given momentum to start from: random ones, and those near singular points."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from nullmotion.array.model import CmgArray
from nullmotion.atlas.manifold_rotors import Rotors
from nullmotion.atlas.surfaces import surfaces

CLOSE = 1e-12  # momentum error over the mean momentum that counts as none
_LONGEST = 0.4  # rad, of a step
_DAMPING = 1e-15
_STEPS = 40
_NEAR = 0.4  # over the mean momentum: singular momenta that are looked at
_RESOLUTION = 800
_NEAREST = 12  # points of each sheet
_SHAKE = 0.15  # rad


def wrapped(delta: np.ndarray) -> np.ndarray:
    """Return angles in [-pi, pi) [rad]."""
    turned: np.ndarray = (delta + np.pi) % (2 * np.pi) - np.pi
    return turned


def held(rotors: Rotors, delta: np.ndarray, momentum: np.ndarray, steps: int) -> np.ndarray:
    """Return angles (k, n) moved to a momentum by the least steps (Gauss and Newton)."""
    damping = _DAMPING * np.eye(rotors.m)
    for _ in range(steps):
        A = rotors.unit_jacobian(delta)
        move = A.mT @ np.linalg.solve(
            A @ A.mT + damping, rotors.missing(delta, momentum)[..., None]
        )
        size = np.linalg.norm(move[..., 0], axis=-1, keepdims=True)
        delta = delta + move[..., 0] * np.minimum(1.0, _LONGEST / np.maximum(size, 1e-300))
    return delta


def seeds(rotors: Rotors, momentum: np.ndarray, count: int, seed: int) -> np.ndarray:
    """Return angles of a momentum, (k, n): none where it is out of reach.

    Half of the starts are random. The others are singular points of about this momentum: small
    pieces of the self-motion set are there, because that is where pieces begin and end.
    """
    rng = np.random.default_rng(seed)
    starts = rng.uniform(-np.pi, np.pi, (count, rotors.n))
    near = singular_near(rotors.array, momentum)
    if len(near):
        near = near[rng.integers(len(near), size=count)]
        starts = np.concatenate([starts, near + rng.normal(scale=_SHAKE, size=near.shape)])
    found = held(rotors, starts, momentum, _STEPS)
    error = np.abs(rotors.missing(found, momentum)).max(axis=1)
    return wrapped(found[error < CLOSE])


def singular_near(array: CmgArray, momentum: np.ndarray) -> np.ndarray:
    """Return singular angles whose momentum is about a given one, nearest first, (k, n)."""
    angles, momenta = _sheets(array)
    away = np.linalg.norm(momenta - momentum, axis=-1) / array.mean_momentum  # (sheets, P)
    few = np.argsort(away, axis=1)[:, :_NEAREST]
    size = np.take_along_axis(away, few, axis=1)
    found = np.take_along_axis(angles, few[..., None], axis=1)[size < _NEAR]
    order: np.ndarray = found[np.argsort(size[size < _NEAR], kind="stable")]
    return order


@lru_cache(maxsize=4)
def _sheets(array: CmgArray) -> tuple[np.ndarray, np.ndarray]:
    sheets = surfaces(array, _RESOLUTION)
    return np.stack([s.delta for s in sheets]), np.stack([s.momentum for s in sheets])
