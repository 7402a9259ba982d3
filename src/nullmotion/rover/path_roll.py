"""Rolling a rigid tetrahedron over ground: where the spikes really come to stand.

The lattice is even, the ground is not. In a step over the edge from a to b the spike that was up
moves on a circle about it, L sqrt(3)/2 from its middle m:

    p(phi) = m + (sqrt(3)/2) L (-cos(phi) f + sin(phi) n),   phi from 70.53 deg

with n the normal of the footprint and f = e x n outwards, until it meets the ground.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from nullmotion.errors import InputError
from nullmotion.rover.terrain import HeightField

DIHEDRAL = math.acos(1 / 3)  # angle between the faces of a regular tetrahedron [rad]
_LAST = 1.6 * math.pi  # ground falls away beyond [rad]
_TRIES = 400
_HALVINGS = 50


class Landing(NamedTuple):
    """The footprint after a step and the angle turned: corners [m], (3, 3); angle [rad]."""

    corners: np.ndarray
    turn: float


def first_footprint(field: HeightField, corners: np.ndarray, edge_length: float) -> np.ndarray:
    """Return where a tetrahedron stands that is put down near a cell, (3, 3) [m].

    Args:
        field: The ground.
        corners: Corners of the cell on the map, counter-clockwise [m], (3, 2). The first one is
            kept, and the direction to the second.
        edge_length: L [m].

    Raises:
        InputError: For ground on which it cannot be put down.
    """
    a = field.points(corners[0])
    along = (corners[1] - corners[0]) / np.linalg.norm(corners[1] - corners[0])

    def above(angle: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        reach, up = edge_length * np.sin(angle), edge_length * np.cos(angle)
        place = np.column_stack([np.outer(reach, along), up]) + a
        return place, place[:, 2] - field.height(place[:, 0], place[:, 1])

    b = _first_touch(above, 0.02, math.pi)
    if b is None:
        raise _unstable(corners)
    e = (b[0] - a) / edge_length
    side = np.cross([0.0, 0.0, 1.0], e)
    side /= np.linalg.norm(side)
    n = np.cross(e, side)
    c = _first_touch(_circle(field, a, b[0], -side, n, edge_length), math.pi / 2, _LAST)
    if c is None:
        raise _unstable(corners)
    return np.array([a, b[0], c[0]])


def rolled(field: HeightField, corners: np.ndarray, left: int) -> Landing | None:
    """Return the footprint after a step that leaves a corner behind.

    Args:
        field: The ground.
        corners: Footprint, counter-clockwise [m], (3, 3).
        left: Which corner is left.

    Returns:
        The next footprint in the order of `path_lattice`: the new corner takes the place of the
        one that is left, the others change places. None where the ground is unknown or falls
        away.
    """
    a, b = corners[(left + 1) % 3], corners[(left + 2) % 3]
    length = float(np.linalg.norm(b - a))
    e = (b - a) / length
    n = np.cross(corners[1] - corners[0], corners[2] - corners[0])
    n /= np.linalg.norm(n)
    found = _first_touch(_circle(field, a, b, -np.cross(e, n), n, length), DIHEDRAL, _LAST)
    if found is None:
        return None
    after = np.empty((3, 3))
    after[left], after[(left + 1) % 3], after[(left + 2) % 3] = found[0], b, a
    return Landing(after, found[1] - DIHEDRAL)


def _circle(
    field: HeightField, a: np.ndarray, b: np.ndarray, back: np.ndarray, n: np.ndarray, L: float
) -> Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]:
    """Return places (k, 3) at angles from `back` about an edge, and their heights above ground."""
    middle, radius = (a + b) / 2, math.sqrt(3) / 2 * L

    def above(angle: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        place = middle + radius * (np.outer(np.cos(angle), back) + np.outer(np.sin(angle), n))
        return place, place[:, 2] - field.height(place[:, 0], place[:, 1])

    return above


def _first_touch(
    above: Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]], first: float, last: float
) -> tuple[np.ndarray, float] | None:
    """Return the first place on the ground and its angle; None if there is none."""
    angles = np.linspace(first, last, _TRIES)
    gap = above(angles)[1]
    unclear = ~(gap > 0)
    if not unclear.any():
        return None
    i = int(np.argmax(unclear))
    if i == 0 or np.isnan(gap[i]):
        return None
    low, high = angles[i - 1], angles[i]
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        if above(np.array([middle]))[1][0] > 0:
            low = middle
        else:
            high = middle
    return above(np.array([high]))[0][0], float(high)


def _unstable(corners: np.ndarray) -> InputError:
    at = [round(float(v), 3) for v in corners.mean(axis=0)]
    return InputError("mission.start_m", at, "a start on known ground that is less steep")
