"""Null motion close to singular gimbal angles, found by solving for it.

Where the second order does not settle what null motion does, the angles of the same momentum on
a small sphere around the singular ones do:

    h(delta') = h(delta),    |delta' - delta| = r

None: delta is isolated. Some that are regular: null motion leaves the singular set. Only
singular ones: it stays there. Solved from many starts by Gauss and Newton's method, for two
radii, so that what is met is not another piece of the self-motion set that passes by.
"""

from __future__ import annotations

from enum import Enum
from itertools import combinations

import numpy as np

from nullmotion.array.model import CmgArray

RADII = (0.1, 0.02)  # rad
LEFT = 1e-5  # sigma_min of unit A from which a solution counts as regular
SOLVED = 1e-12  # residual, momentum over the mean momentum, that counts as none
_STARTS = 96
_STEPS = 60
_STRIDE = 0.3  # of the radius: the longest step
_DAMPING = 1e-15
_SEED = 20
_APART = 1e-6  # rad; solutions closer than this are one
_DEPENDENT = 1e-6  # singular value of columns that depend on each other
_MOST = 100  # sets of such columns


class Vicinity(Enum):
    """What the angles of the same momentum close to given ones are."""

    ISOLATED = "isolated"
    SINGULAR = "singular"
    REGULAR = "regular"


def explore(array: CmgArray, delta: np.ndarray, null: np.ndarray) -> Vicinity:
    """Return what null motion from singular angles leads to.

    Args:
        array: The array.
        delta: Gimbal angles, singular to rounding [rad], (n,).
        null: Orthonormal basis of the null space of A there, (n, k).
    """
    if null.shape[1] == 0:
        return Vicinity.ISOLATED
    found = [_sigma_min(array, _on_sphere(array, delta, null, r)) for r in RADII]
    if not all(len(sigma) for sigma in found):
        return Vicinity.ISOLATED
    return Vicinity.REGULAR if min(s.max() for s in found) > LEFT else Vicinity.SINGULAR


def reachable(
    array: CmgArray, delta: np.ndarray, null: np.ndarray, momentum: np.ndarray, radius: float
) -> bool:
    """Return whether angles within ``radius`` of singular ones have a momentum close by.

    Args:
        array: The array.
        delta: Singular gimbal angles [rad], (n,).
        null: Basis of the null space of A there, (n, k).
        momentum: The momentum wanted [N m s], (m,).
        radius: Largest 2-norm of the gimbal rotation [rad].
    """
    rng = np.random.default_rng(_SEED)
    spread = rng.normal(size=(_STARTS, null.shape[1])) @ null.T
    size = np.linalg.norm(spread, axis=1, keepdims=True) + 1e-300
    starts = delta + spread / size * (radius * rng.random((_STARTS, 1)))
    angles, missing = _solved(array, starts, delta, momentum, None)
    inside = np.linalg.norm(angles - delta, axis=1) <= radius
    return bool((inside & (missing < SOLVED)).any())


def neighbours(array: CmgArray, delta: np.ndarray, radius: float, least: float) -> np.ndarray:
    """Return regular angles of the same momentum at a distance from singular ones, (k, n).

    Args:
        array: The array.
        delta: Singular gimbal angles [rad], (n,).
        radius: The distance [rad].
        least: sigma_min of unit A from which angles are regular.
    """
    _, sigma, right = np.linalg.svd(array.unit_jacobian(delta))
    null = right[int(np.sum(sigma > _DEPENDENT)) :].T
    angles = _on_sphere(array, delta, null, radius)
    angles = angles[_sigma_min(array, angles) > least]
    distinct: np.ndarray = np.unique(np.round(angles / _APART), axis=0, return_index=True)[1]
    return angles[distinct]


def _directions(array: CmgArray, delta: np.ndarray, null: np.ndarray) -> np.ndarray:
    """Return unit null motions to start from, (k, n): random ones, and those of the fewest CMGs.

    Branches that meet others at a high order draw few random starts to them. They are often
    motions of a few CMGs that keep their sum, such as a pair that opens, and sums of two such.
    """
    spread = np.random.default_rng(_SEED).normal(size=(_STARTS, null.shape[1])) @ null.T
    few = _circuits(array.unit_jacobian(delta))
    pairs = [a + b for i, a in enumerate(few) for b in few[:i]][:_STARTS]
    every = np.concatenate([spread, *[[x, -x] for x in [*few, *pairs]]])
    size = np.linalg.norm(every, axis=1, keepdims=True)
    kept: np.ndarray = (every / np.maximum(size, 1e-9))[size[:, 0] > 1e-9]
    return kept


def _circuits(A: np.ndarray) -> list[np.ndarray]:
    """Return unit null vectors of A (m, n) with as few entries as can be, one for each set."""
    n = A.shape[1]
    found: list[np.ndarray] = []
    for count in range(1, A.shape[0] + 2):
        for members in combinations(range(n), count):
            _, sigma, right = np.linalg.svd(A[:, members])
            depends = count > len(sigma) or sigma[-1] < _DEPENDENT
            if depends and np.abs(right[-1]).min() > _DEPENDENT and len(found) < _MOST:
                found.append(np.zeros(n))
                found[-1][list(members)] = right[-1]
    return found


def _on_sphere(array: CmgArray, delta: np.ndarray, null: np.ndarray, r: float) -> np.ndarray:
    """Return angles of the same momentum on a sphere, (k, n)."""
    momentum = np.asarray(array.momentum(delta))
    starts = delta + r * _directions(array, delta, null)
    angles, missing = _solved(array, starts, delta, momentum, r)
    return angles[missing < SOLVED]


def _sigma_min(array: CmgArray, angles: np.ndarray) -> np.ndarray:
    if array.n < array.m or not len(angles):
        return np.zeros(len(angles))
    sigma: np.ndarray = np.linalg.svd(array.unit_jacobian(angles), compute_uv=False)
    return sigma[:, -1]


def _solved(
    array: CmgArray, angles: np.ndarray, centre: np.ndarray, momentum: np.ndarray, r: float | None
) -> tuple[np.ndarray, np.ndarray]:
    """Return angles (k, n) moved to a momentum (and a sphere), and what is missing, (k,).

    Steps are the least ones, and no longer than a share of the radius. At singular solutions
    they halve the distance to them: nothing faster is needed.
    """
    longest = _STRIDE * (RADII[0] if r is None else r)
    missing, slope = _residual(array, angles, centre, momentum, r)
    damping = _DAMPING * np.eye(missing.shape[1])
    for _ in range(_STEPS):
        step = slope.mT @ np.linalg.solve(slope @ slope.mT + damping, missing[..., None])
        size = np.linalg.norm(step[..., 0], axis=1, keepdims=True)
        angles = angles - step[..., 0] * np.minimum(1.0, longest / np.maximum(size, 1e-300))
        missing, slope = _residual(array, angles, centre, momentum, r)
    return angles, np.linalg.norm(missing, axis=1)


def _residual(
    array: CmgArray, angles: np.ndarray, centre: np.ndarray, momentum: np.ndarray, r: float | None
) -> tuple[np.ndarray, np.ndarray]:
    missing = (array.momentum(angles) - momentum) / array.mean_momentum
    slope = array.unit_jacobian(angles)
    if r is None:
        return missing, slope
    away = angles - centre
    radial = (np.sum(away * away, axis=1) - r * r) / (2 * r)
    return (
        np.concatenate([missing, radial[:, None]], axis=1),
        np.concatenate([slope, (away / r)[:, None]], axis=1),
    )
