"""Slew axes: spread over a cone, where an array is weak, near others."""

from __future__ import annotations

import numpy as np

from nullmotion.array.model import CmgArray

_GOLDEN = np.pi * (1.0 + np.sqrt(5.0))
_SAME = 1e-9  # less is one axis
_ROUNDING = 1e-12


def spread(count: int, axis: np.ndarray, cone: float, turn: float = 0.0) -> np.ndarray:
    """Return axes evenly spread over a cone, (count, 3); one if the cone has no width.

    Args:
        count: Number of axes: a Fibonacci lattice over the cap of directions.
        axis: Middle of the cone, a unit vector.
        cone: Half angle [rad].
        turn: Turns the lattice about the middle and shifts its rings, in [0, 1): lattices of
            different turns have no axis in common.
    """
    if cone == 0.0:
        return axis[None, :].copy()
    place = np.arange(count) + 0.5 * (1.0 + turn)
    z = 1.0 - (1.0 - np.cos(cone)) * np.minimum(place / count, 1.0)
    around, radius = _GOLDEN * (place + turn), np.sqrt(np.maximum(1.0 - z * z, 0.0))
    local = np.stack([radius * np.cos(around), radius * np.sin(around), z], axis=1)
    found: np.ndarray = local @ frames(axis[None, :])[0][[1, 2, 0]]
    return found


def weak(array: CmgArray, inertia: np.ndarray) -> np.ndarray:
    """Return axes whose momentum J e lies where an array is weak, or the body heavy, (k, 3).

    These are the gimbal axes g_i, along which CMG i gives nothing, the directions between
    and across two of them, the body's axes and its principal axes; each and its opposite.
    """
    g = array.gimbal_axes
    pairs = [(a, b) for i, a in enumerate(g) for b in g[i + 1 :]]
    momenta = [*g, *np.eye(3)]
    momenta += [v for a, b in pairs for v in (a + b, a - b, np.cross(a, b))]
    turned = np.linalg.solve(inertia, np.array(momenta).T).T
    principal = np.linalg.eigh(inertia)[1].T
    return _distinct(np.concatenate([turned, principal, np.eye(3)]))


def inside(axes: np.ndarray, axis: np.ndarray, cone: float) -> np.ndarray:
    """Return those of the axes that lie in a cone."""
    kept: np.ndarray = axes[axes @ axis >= np.cos(cone) - _ROUNDING]
    return kept


def near(axes: np.ndarray, count: int, angle: float, generator: np.random.Generator) -> np.ndarray:
    """Return axes at up to an angle [rad] from given ones, (len(axes) * count, 3)."""
    many = np.repeat(axes, count, axis=0)
    away = angle * np.sqrt(generator.uniform(size=len(many)))
    around = generator.uniform(0.0, 2.0 * np.pi, len(many))
    C = frames(many)
    aside = np.cos(around)[:, None] * C[:, 1] + np.sin(around)[:, None] * C[:, 2]
    found: np.ndarray = np.cos(away)[:, None] * many + np.sin(away)[:, None] * aside
    return found


def frames(axes: np.ndarray) -> np.ndarray:
    """Return for each axis e a rotation C with C e = x, (k, 3, 3): rows e and two across it."""
    other = np.where(np.abs(axes[:, :1]) < 0.7, [[1.0, 0.0, 0.0]], [[0.0, 1.0, 0.0]])
    across = np.cross(axes, other)
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    return np.stack([axes, across, np.cross(axes, across)], axis=1)


def _distinct(vectors: np.ndarray) -> np.ndarray:
    """Return unit vectors of both signs, none twice; what has no length is left out."""
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    unit = vectors[length[:, 0] > _SAME] / length[length[:, 0] > _SAME]
    both = np.concatenate([unit, -unit])
    _, first = np.unique(np.round(both, 9) + 0.0, axis=0, return_index=True)
    found: np.ndarray = both[np.sort(first)]
    return found
