"""Ground as heights on a rectangular grid, bilinear between its points.

    z(x, y) = (1 - u)(1 - v) z_00 + u (1 - v) z_10 + (1 - u) v z_01 + u v z_11

with u, v from 0 to 1 across the grid's square that holds (x, y). z is up, gravity is along -z.
A height that is not a number marks ground that must not be touched: so does everything beyond
the grid.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from nullmotion.errors import InputError


@dataclass(frozen=True, eq=False)
class HeightField:
    """Heights on a grid.

    Args:
        heights: Heights [m], (rows, columns): rows along +y, columns along +x. NaN where
            the ground must not be touched.
        spacing: Distance between neighbours on the grid [m].
        origin: Where the first row and column are, (x, y) [m].
        source: What made it, for messages and reports.

    Raises:
        InputError: For fewer than 2 x 2 heights, infinite ones, or a spacing that is not above 0.
    """

    heights: np.ndarray
    spacing: float
    origin: tuple[float, float] = (0.0, 0.0)
    source: str = ""

    def __post_init__(self) -> None:
        """Check what can be checked."""
        z = np.asarray(self.heights, float)
        if z.ndim != 2 or min(z.shape) < 2:
            raise InputError("terrain.heights", list(z.shape), "at least 2 rows of 2 heights")
        if np.isinf(z).any() or np.isnan(z).all():
            raise InputError("terrain.heights", "inf or all nan", "finite heights; nan: keep off")
        if not (np.isfinite(self.spacing) and self.spacing > 0):
            raise InputError("terrain.spacing_m", self.spacing, "a length above 0")
        if len(self.origin) != 2 or not np.isfinite(self.origin).all():
            raise InputError("terrain.origin_m", self.origin, "2 finite numbers (x, y)")
        object.__setattr__(self, "heights", z)

    @property
    def size(self) -> tuple[float, float]:
        """Extent along x and y [m]."""
        rows, columns = self.heights.shape
        return (columns - 1) * self.spacing, (rows - 1) * self.spacing

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """Least and greatest x, then least and greatest y [m]."""
        (x, y), (wide, deep) = self.origin, self.size
        return x, x + wide, y, y + deep

    def contains(self, x: Any, y: Any) -> np.ndarray:
        """Return whether points lie on the grid, (...)."""
        x, y = np.asarray(x, float), np.asarray(y, float)
        left, right, low, high = self.bounds
        return (left <= x) & (x <= right) & (low <= y) & (y <= high)

    def height(self, x: Any, y: Any) -> np.ndarray:
        """Return heights at points [m], (...); NaN off the grid and where it must not be."""
        x, y = np.broadcast_arrays(np.asarray(x, float), np.asarray(y, float))
        i, u = self._place(x - self.origin[0], self.heights.shape[1])
        j, v = self._place(y - self.origin[1], self.heights.shape[0])
        z = self.heights
        low = (1 - u) * z[j, i] + u * z[j, i + 1]
        high = (1 - u) * z[j + 1, i] + u * z[j + 1, i + 1]
        return np.where(self.contains(x, y), (1 - v) * low + v * high, np.nan)

    def points(self, xy: Any) -> np.ndarray:
        """Return points on the ground above places (..., 2) [m], (..., 3)."""
        xy = np.asarray(xy, float)
        return np.concatenate([xy, self.height(xy[..., 0], xy[..., 1])[..., None]], axis=-1)

    def slopes(self) -> np.ndarray:
        """Return the steepest slope in each square of the grid [rad], (rows - 1, columns - 1)."""
        z, s = self.heights, 2 * self.spacing
        dx = (z[1:, 1:] + z[:-1, 1:] - z[1:, :-1] - z[:-1, :-1]) / s
        dy = (z[1:, 1:] + z[1:, :-1] - z[:-1, 1:] - z[:-1, :-1]) / s
        return np.arctan(np.hypot(dx, dy))

    def mean_normal(self) -> np.ndarray:
        """Return the unit normal of the plane that fits the ground best, up, (3,)."""
        left, right, low, high = self.bounds
        rows, columns = self.heights.shape
        x, y = np.meshgrid(np.linspace(left, right, columns), np.linspace(low, high, rows))
        known = np.isfinite(self.heights)
        table = np.column_stack([x[known], y[known], np.ones(known.sum())])
        slope = np.linalg.lstsq(table, self.heights[known], rcond=None)[0]
        normal = np.array([-slope[0], -slope[1], 1.0])
        return normal / np.linalg.norm(normal)

    def _place(self, distance: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
        """Return the index of the grid's line before a point, and how far it is beyond."""
        along = np.nan_to_num(distance / self.spacing)
        index = np.clip(np.floor(along), 0, count - 2).astype(int)
        return index, along - index
