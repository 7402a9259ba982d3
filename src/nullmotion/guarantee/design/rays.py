"""Directions of momentum that tell all of a family."""

from __future__ import annotations

import numpy as np

from nullmotion.guarantee.design.family import Family
from nullmotion.guarantee.maps import spread_directions

_DIRECTIONS = 960  # over the sphere
_ARC = 60  # along each edge of the octant


def part(family: Family) -> tuple[np.ndarray, np.ndarray]:
    """Return directions over the part that tells all, (d, 3), and the angle each stands for.

    Those along the edges of an octant stand for none.
    """
    spiral = spread_directions(3, _DIRECTIONS)
    spiral = spiral[(spiral[:, 0 if family.equal else 1 :] >= 0).all(axis=1)]
    angle = np.linspace(0, np.pi / 2, _ARC)
    arc = np.stack([np.cos(angle), np.sin(angle), np.zeros(_ARC)], axis=1)
    edges = np.concatenate([np.roll(arc, k, axis=1) for k in range(3)])
    if not family.equal:
        edges = np.concatenate([edges, edges * [-1.0, 1.0, 1.0]])
    angles = np.repeat([4 * np.pi / len(spiral), 0.0], [len(spiral), len(edges)])
    return np.concatenate([spiral, edges]), angles
