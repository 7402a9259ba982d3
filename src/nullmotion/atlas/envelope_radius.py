"""The least size of an unreachable momentum: cells of the smallest |h| first.

A cell is proven reachable, or cut; where no angles are found for its centre, that momentum is
tried to be proven unreachable, which bounds the radius from above. The bound from below is the
least |h| of the cells that are left.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from nullmotion.atlas import envelope_outside
from nullmotion.atlas.envelope_cells import Cells
from nullmotion.atlas.envelope_cover import Explorer, Findings
from nullmotion.atlas.envelope_descent import distances, smallest_near
from nullmotion.atlas.envelope_rings import Rings

Progress = Callable[[float], None]

_BATCH = 4000  # cells looked at together
_TRIED = 12  # centres at once that are tried to be unreachable
_MARGIN = 0.1  # distance from R of momenta shown unreachable, over tolerance and radius
_FINEST = 0.25  # least edge of a cell around a reachable momentum, over radius and tolerance
_FINER = 0.05  # of the others
_BUDGET = 400_000  # cells


class Radius(NamedTuple):
    """Bounds of the least |h| that is unreachable, in units of the mean momentum.

    Attributes:
        lower: All momenta up to it are reachable, but for what may hide in ``points``.
        upper: A momentum of this size is not reachable, or R has no room beyond it.
        at: That momentum, (m,).
        proven: All momenta up to it are reachable.
        points: Number of cells below ``lower`` that are left out: their centres are reachable,
            all around them is.
        size: Their edges are shorter than this.
        cells: Number of cells looked at.
        complete: Whether the bounds are as close as they were asked to be.
    """

    lower: float
    upper: float
    at: np.ndarray
    proven: float
    points: int
    size: float
    cells: int
    complete: bool


def least_unreachable(
    rings: Rings,
    cells: Cells,
    start: np.ndarray,
    tolerance: float,
    progress: Progress | None = None,
    budget: int = _BUDGET,
) -> Radius:
    """Return bounds of the least size of an unreachable momentum in cells.

    Args:
        rings: The array's rings.
        cells: Cells that cover what is asked about.
        start: A momentum beyond which there is none in its direction, (m,).
        tolerance: Share of the radius up to which the bounds are closed.
        progress: Called with the share of the radius that is proven.
        budget: Number of cells after which the bounds are what they are.
    """
    origin = np.zeros(rings.m)
    if envelope_outside.proven(rings, origin[None, None])[0]:
        return Radius(0.0, 0.0, origin, 0.0, 0, 0.0, 0, True)
    search = _Search(Explorer(rings), start, tolerance)
    while len(cells) and search.looked_at < budget:
        cells = cells.take(cells.nearest < search.upper * (1 - tolerance))
        order = np.argsort(cells.nearest, kind="stable")
        first, rest = order[:_BATCH], order[_BATCH:]
        if len(first):
            cells = cells.take(rest).joined(search.step(cells.take(first)))
        if progress is not None and len(cells):
            progress(min(1.0, float(cells.nearest.min()) / search.upper))
    return search.result(cells)


class _Search:
    """The bounds so far."""

    def __init__(self, explorer: Explorer, start: np.ndarray, tolerance: float) -> None:
        self.explorer, self.tolerance = explorer, tolerance
        self.at, self.upper = start, float(np.linalg.norm(start))
        self.points: list[float] = []
        self.stuck: list[float] = []
        self.looked_at = 0

    def step(self, cells: Cells) -> Cells:
        """Return what is left of cells, cut."""
        self.looked_at += len(cells)
        found = self.explorer.explore(cells)
        self._lower_the_upper(found)
        open_cells, axis = found.cells.take(~found.inside), found.axis[~found.inside]
        reached = found.reached[~found.inside]
        finest = self.tolerance * self.upper * np.where(reached, _FINEST, _FINER)
        fine = open_cells.longest < finest
        for which, left in ((fine & reached, self.points), (fine & ~reached, self.stuck)):
            left.extend(open_cells.nearest[which].tolist())
        return open_cells.take(~fine).halves(axis[~fine])

    def _lower_the_upper(self, found: Findings) -> None:
        rings, starts = self.explorer.rings, self.explorer.starts
        centres = found.cells.centres()[~found.inside & ~found.reached]
        size = np.linalg.norm(centres, axis=1)
        order = np.argsort(size)
        centres = centres[order[size[order] < self.upper * (1 - self.tolerance)][:_TRIED]]
        margin = _MARGIN * self.tolerance * self.upper
        if len(centres):
            centres = centres[distances(rings, starts, centres) > margin]
        if len(centres) == 0:
            return
        best = smallest_near(rings, starts, centres[0], margin)
        for h in (best, centres[0]):
            if envelope_outside.proven(rings, h[None, None])[0]:
                self.at, self.upper = h, float(np.linalg.norm(h))
                break

    def result(self, cells: Cells) -> Radius:
        """Return the bounds, given the cells that are left."""
        wanted = self.upper * (1 - self.tolerance)
        left = min([*cells.nearest.tolist(), *self.stuck], default=np.inf)
        lower = min(wanted, left)
        points = [r for r in self.points if r < lower]
        size = _FINEST * self.tolerance * self.upper
        proven = min([lower, *points])
        return Radius(
            lower, self.upper, self.at, proven, len(points), size, self.looked_at, left >= wanted
        )
