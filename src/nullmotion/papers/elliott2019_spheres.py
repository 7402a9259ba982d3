"""What a box-90 constraint gives at all momenta of one size: Figures 20, 21, 26 and 41.

The published biases are even in h_y and h_z, and

    TC(h_x, h_y, h_z) = TC(-h_x, h_z, h_y)

(the planes change places), so that directions with no negative component stand for all.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from nullmotion import ops
from nullmotion.compile import compile_function
from nullmotion.guarantee._two_planes import TwoPlanes, square_of

Function = Callable[[np.ndarray], np.ndarray]  # momenta (k, 3) to values (k,)

_GRID = 96  # angles on a quarter circle
_CANDIDATES = 12  # places from which an extreme is refined
_SPHERES = 24  # at once
_FINE, _SHRINK, _ROUNDS = 9, 0.3, 9  # to about 1e-6 rad


@dataclass(frozen=True)
class Band:
    """Least and greatest value on spheres.

    Attributes:
        sizes: Radii, rising, (k,).
        low: Least values, (k,).
        high: Greatest values, (k,).
    """

    sizes: np.ndarray
    low: np.ndarray
    high: np.ndarray

    def outside(self, sizes: np.ndarray, values: np.ndarray, margin: float) -> np.ndarray:
        """Return which values leave the band, widened by a margin."""
        low = np.interp(sizes, self.sizes, self.low) - margin
        high = np.interp(sizes, self.sizes, self.high) + margin
        return (values < low) | (values > high)


def band(function: Function, sizes: np.ndarray) -> Band:
    """Return the extremes of a function on spheres of the given radii."""
    return Band(sizes, least(function, sizes), -least(lambda h: -function(h), sizes))


def least(function: Function, sizes: np.ndarray) -> np.ndarray:
    """Return the least value on each of some spheres, (k,)."""
    parts = [sizes[i : i + _SPHERES] for i in range(0, len(sizes), _SPHERES)]
    return np.concatenate([_least(function, part) for part in parts])


def _least(function: Function, sizes: np.ndarray) -> np.ndarray:
    edge = np.linspace(0.0, 0.5 * np.pi, _GRID)
    grid, step = _square(edge), edge[1]
    places = np.broadcast_to(grid, (len(sizes), *grid.shape))
    values = _on_spheres(function, sizes, places)
    for _ in range(_ROUNDS):
        best = np.argpartition(values, _CANDIDATES, axis=1)[:, :_CANDIDATES]
        centres = np.take_along_axis(places, best[..., None], axis=1)
        around = _square(step * np.linspace(-1.0, 1.0, _FINE))
        places = np.clip(centres[:, :, None] + around, 0.0, 0.5 * np.pi)
        places = places.reshape(len(sizes), -1, 2)
        values, step = _on_spheres(function, sizes, places), _SHRINK * step
    return np.asarray(values.min(axis=1))


def _square(edge: np.ndarray) -> np.ndarray:
    """Return all pairs, (k^2, 2)."""
    return np.stack(np.meshgrid(edge, edge), axis=-1).reshape(-1, 2)


def _on_spheres(function: Function, sizes: np.ndarray, places: np.ndarray) -> np.ndarray:
    h = sizes[:, None, None] * directions(places)
    return function(h.reshape(-1, 3)).reshape(h.shape[:2])


def directions(places: np.ndarray) -> np.ndarray:
    """Return unit vectors at an angle from x and one from y about x, (k, 3)."""
    polar, around = places[..., 0], places[..., 1]
    s = np.sin(polar)
    return np.stack([np.cos(polar), s * np.cos(around), s * np.sin(around)], axis=-1)


def radius(function: Function, level: float, reach: float = 2.0) -> float:
    """Return the radius of the largest sphere on and within which a function exceeds a level."""
    low, high = 0.0, reach
    for _ in range(5):
        sizes = np.linspace(low, high, 32)[1:]
        first = int(np.argmax(least(function, sizes) <= level))
        high = float(sizes[first])
        low = high - float(sizes[1] - sizes[0])
    return 0.5 * (low + high)


class Box90:
    """Functions of the momentum that one box-90 constraint gives; all take momenta (k, 3)."""

    def __init__(self, constraint: TwoPlanes) -> None:
        """Compile what is not the constraint's own."""
        self.constraint = constraint
        self.capability: Function = constraint.torque_capability
        self.determinant: Function = compile_function(self._determinant, np.zeros(3))
        self.room: Function = compile_function(self.room_source, np.zeros(3))

    def _determinant(self, h: Any) -> Any:
        """|det J_t| = |sin(delta_1 - delta_2) sin(delta_3 - delta_4)|, 0 outside.

        A plane's sine is r sqrt(4 - r^2)/2, r being its momentum.
        """
        first, second = (square_of(plane) for plane in self.constraint.planes(h))
        square = first * (4.0 - first) * (second * (4.0 - second))
        inside = self.constraint.inside(h)
        return 0.25 * ops.where(inside, ops.sqrt(ops.where(inside, square, 0.0)), 0.0)

    def room_source(self, h: Any) -> Any:
        """Least of 4 - r^2 of both planes and 2 - |h_x|: positive within the envelope; source."""
        rooms = [4.0 - square_of(plane) for plane in self.constraint.planes(h)]
        found = ops.minimum(ops.minimum(*rooms), 2.0 - ops.absolute(h[0]))
        psi = self.constraint.bias(h)[0]
        return ops.where(
            ops.less(ops.absolute(psi), np.inf), found, -1.0
        )  # the spherical bias ends at |h| = 2
