"""The triangular lattice on which a rolling tetrahedron puts its spikes.

Lattice points are P(i, j) = P(0, 0) + i a + j b, with |a| = |b| = L and 60 deg between them in
the mean plane of the ground, of which a map shows the projection. A footprint is a cell

    (i, j, 0): P(i, j), P(i+1, j), P(i, j+1)        (i, j, 1): P(i+1, j+1), P(i, j+1), P(i+1, j)

counter-clockwise. Rolling puts the same spike on P(i, j) whichever way the rover came: it depends
on whether i and j are even or odd only. A cell hence fixes the attitude of the chassis.

Leaving corner m of a cell behind, the rover steps over the edge from corner m + 1 to m + 2 and
the spike that was up lands. Every step changes one of i, j and i + j + k by one, so the least
number of steps between two cells is |di| + |dj| + |d(i + j + k)|.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from nullmotion.errors import InputError
from nullmotion.rover.terrain import HeightField

# corners (i, j) of the cells k = 0 and 1, and the cell behind the edge opposite to each corner
_CORNERS = np.array([[[0, 0], [1, 0], [0, 1]], [[1, 1], [0, 1], [1, 0]]])
_BEHIND = np.array([[[0, 0, 1], [-1, 0, 1], [0, -1, 1]], [[0, 0, 0], [1, 0, 0], [0, 1, 0]]])
_APEX = np.array([[1, 1], [0, 0]])
_MOST = 2_000_000  # cells


@dataclass(frozen=True, eq=False)
class Lattice:
    """Where the spikes of a tetrahedron can come to stand.

    Attributes:
        corner: P(0, 0) on the map [m], (2,).
        axes: a and b on the map [m], (2, 2), one a row.
        spikes: The chassis's corners that stand on (even, even), (odd, even), (even, odd)
            and (odd, odd) points (i, j), (4,).
    """

    corner: np.ndarray
    axes: np.ndarray
    spikes: tuple[int, int, int, int] = (0, 1, 2, 3)

    @classmethod
    def laid(
        cls,
        edge_length: float,
        centre: tuple[float, float],
        heading: float = 0.0,
        normal: np.ndarray | None = None,
        spikes: tuple[int, int, int, int] = (0, 1, 2, 3),
    ) -> Lattice:
        """Return the lattice whose cell (0, 0, 0) has its middle at a point of the map.

        Args:
            edge_length: L [m].
            centre: The middle of the first footprint, (x, y) [m].
            heading: Of a, from +x towards +y on the map [rad].
            normal: Unit normal of the mean plane, up; flat ground by default.
            spikes: See the class.
        """
        n = np.array([0.0, 0.0, 1.0]) if normal is None else np.asarray(normal, float)
        across = np.cross(n, [math.cos(heading), math.sin(heading), 0.0])
        across /= np.linalg.norm(across)
        a = edge_length * np.cross(across, n)
        b = 0.5 * a + 0.5 * math.sqrt(3) * edge_length * across
        axes = np.array([a[:2], b[:2]])
        return cls(np.asarray(centre, float) - axes.sum(axis=0) / 3, axes, spikes)

    def corners(self, cells: np.ndarray) -> np.ndarray:
        """Return the corners of cells (..., 3) on the map [m], (..., 3, 2)."""
        return self.corner + self._points(cells) @ self.axes

    def middles(self, cells: np.ndarray) -> np.ndarray:
        """Return the middles of cells (..., 3) on the map [m], (..., 2)."""
        return self.corners(cells).mean(axis=-2)

    def feet(self, cells: np.ndarray) -> np.ndarray:
        """Return which spike stands on each corner of cells (..., 3), (..., 3)."""
        return self._labels(self._points(cells))

    def top(self, cells: np.ndarray) -> np.ndarray:
        """Return which spike is up on cells (..., 3), (...)."""
        cells = np.asarray(cells)
        return self._labels(cells[..., :2] + _APEX[cells[..., 2]])

    def behind(self, cells: np.ndarray) -> np.ndarray:
        """Return the cells reached when corner 0, 1, 2 is left, (..., 3, 3)."""
        cells = np.asarray(cells)
        beyond: np.ndarray = _BEHIND[cells[..., 2]].copy()
        beyond[..., :2] += cells[..., None, :2]
        return beyond

    def cell_at(self, xy: tuple[float, float]) -> np.ndarray:
        """Return the cell that holds a point of the map, (3,)."""
        s = (np.asarray(xy, float) - self.corner) @ np.linalg.inv(self.axes)
        i, j = np.floor(s).astype(int)
        return np.array([i, j, int(s.sum() - i - j > 1)])

    def cells_on(self, field: HeightField) -> np.ndarray:
        """Return the cells whose corners and middle lie on known ground, (n, 3).

        Raises:
            InputError: For ground with more cells than can be searched.
        """
        left, right, low, high = field.bounds
        box = np.array([[x, y] for x in (left, right) for y in (low, high)])
        s = (box - self.corner) @ np.linalg.inv(self.axes)
        first, last = np.floor(s.min(axis=0)).astype(int), np.ceil(s.max(axis=0)).astype(int)
        if 2 * int(np.prod(last - first + 1)) > _MOST:
            allowed = f"ground of at most {_MOST} footprints (larger rover or smaller ground)"
            raise InputError("terrain.size_m", list(field.size), allowed)
        ranges = [np.arange(a, b + 1) for a, b in zip(first, last, strict=True)]
        cells = np.stack(np.meshgrid(*ranges, [0, 1], indexing="ij"), axis=-1).reshape(-1, 3)
        at = self.corners(cells)
        places = np.concatenate([at, at.mean(axis=1, keepdims=True)], axis=1)
        known = np.isfinite(field.height(places[..., 0], places[..., 1])).all(axis=1)
        return cells[known]

    def _points(self, cells: np.ndarray) -> np.ndarray:
        cells = np.asarray(cells)
        found: np.ndarray = cells[..., None, :2] + _CORNERS[cells[..., 2]]
        return found

    def _labels(self, points: np.ndarray) -> np.ndarray:
        odd = np.asarray(points) % 2
        return np.array(self.spikes)[odd[..., 0] + 2 * odd[..., 1]]


def steps_between(cells: np.ndarray, goals: np.ndarray) -> np.ndarray:
    """Return the least number of steps from cells (n, 3) to the nearest of goals (m, 3), (n,)."""
    strips, ends = (np.column_stack([c[:, :2], c.sum(axis=1)]) for c in (cells, goals))
    least = np.full(len(strips), np.iinfo(int).max)
    for end in ends:
        np.minimum(least, np.abs(strips - end).sum(axis=1), out=least)
    return least
