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
_MARGINS = (0.1, 1.0)  # distance from R to look for, over that room
_HELD = 1e-9  # distance at which a momentum is reachable
_FINEST = 0.25  # least edge of a cell around a reachable momentum, over the room between the bounds
_FINER = 0.05  # of the others
_SPOTS = 200  # cells that may be left out
_FLOOR = 0.01  # radius below which the bounds are closed as for this one, over the largest
BUDGET = 100_000  # cells


class Radius(NamedTuple):
    """Bounds of the least |h| that is unreachable, in units of the mean momentum.

    Attributes:
        lower: All momenta up to it are reachable, but for what may hide in ``spots``.
        upper: A momentum of this size is not reachable, or R has no room beyond it.
        at: That momentum, (m,).
        spots: Cells below ``lower`` that are not proven, no longer than ``size``: angles are
            known for their centres and corners, and all around them is reachable. Momenta all of
            whose angles are singular may be reachable without any room for a proof.
        size: Bound of their longest edges.
        complete: Whether the bounds are as close as they were asked to be.
    """

    lower: float
    upper: float
    at: np.ndarray
    spots: int
    size: float
    complete: bool


def least_unreachable(
    rings: Rings,
    cells: Cells,
    start: np.ndarray,
    tolerance: float,
    progress: Progress | None = None,
    budget: int = BUDGET,
) -> Radius:
    """Return bounds of the least size of an unreachable momentum in cells.

    Args:
        rings: The array's rings.
        cells: Cells that cover what is asked about: a ball, or a line.
        start: A momentum in them beyond which there is none in its direction, (m,).
        tolerance: Share of the radius up to which the bounds are closed.
        progress: Called with the share of the work that is done.
        budget: Number of cells after which the bounds are what they are.
    """
    origin = np.zeros(rings.m)
    if envelope_outside.proven(rings, origin[None, None])[0]:
        return Radius(0.0, 0.0, origin, 0, 0.0, True)
    search = _Search(Explorer(rings), start, tolerance, cells.straight)
    while len(cells) and search.looked_at < budget:
        order = np.argsort(cells.nearest, kind="stable")
        first, rest = cells.take(order[:_BATCH]), cells.take(order[_BATCH:])
        cells = rest.joined(search.step(first))
        cells = cells.take(cells.nearest < min(search.wanted, search.stuck))
        if progress is not None:
            progress(search.share(cells, budget))
    return search.result(cells)


class _Search:
    """The bounds so far."""

    def __init__(
        self, explorer: Explorer, start: np.ndarray, tolerance: float, straight: bool
    ) -> None:
        self.explorer, self.straight = explorer, straight
        self.at, self.upper = start, float(np.linalg.norm(start))
        self.tolerance, self.floor = tolerance, _FLOOR * self.upper
        self.spots: list[float] = []
        self.stuck = np.inf  # least |h| of cells that are too small to be cut
        self.looked_at, self.done = 0, 0.0

    @property
    def room(self) -> float:
        """How far apart the bounds may be."""
        return self.tolerance * max(self.upper, self.floor)

    @property
    def wanted(self) -> float:
        """The lower bound that would do."""
        return self.upper - self.room

    def step(self, cells: Cells) -> Cells:
        """Return what is left of cells, cut."""
        self.looked_at += len(cells)
        found = self.explorer.explore(cells)
        self._lower_the_upper(found)
        left = ~found.inside
        open_cells, axis = found.cells.seeded(found.seeds).take(left), found.axis[left]
        reached = found.reached[left]
        fine = open_cells.longest < self.room * np.where(reached, _FINEST, _FINER)
        if fine.any():
            small = open_cells.take(fine)
            good = reached[fine] & self.explorer.held(small.hulls(), small.seeds)
            self.spots.extend(small.nearest[good].tolist())
            if len(self.spots) > _SPOTS:  # something thin may well be among them
                self.stuck = min(self.stuck, *self.spots)
            self.stuck = min(self.stuck, float(small.nearest[~good].min(initial=np.inf)))
        return open_cells.take(~fine).halves(axis[~fine])

    def _lower_the_upper(self, found: Findings[Cells]) -> None:
        """Look for unreachable momenta that are smaller: around those that are not reached."""
        centres = found.cells.centres()
        size = np.linalg.norm(centres, axis=1)
        order = np.argsort(size)
        for i in order[found.outside[order]][:1]:
            if size[i] < self.upper:
                self.at, self.upper = centres[i], float(size[i])
        tried = order[~(found.inside | found.reached)[order]]
        centres = centres[tried[size[tried] < self.wanted][:_TRIED]]
        if len(centres):
            self._descend(centres)

    def _descend(self, centres: np.ndarray) -> None:
        rings, starts = self.explorer.rings, self.explorer.starts
        away = distances(rings, starts, centres)
        if away.max() <= _HELD:
            return
        farthest, nearest = centres[away.argmax()], centres[np.flatnonzero(away > _HELD)[0]]
        for margin in _MARGINS:
            h = smallest_near(rings, starts, farthest, margin * self.room, self.straight)
            if self._shown(h):
                return
        if not self._shown(nearest):
            self._shown(farthest)

    def _shown(self, h: np.ndarray) -> bool:
        """Lower the upper bound to |h| if it is less and h is unreachable for certain."""
        size = float(np.linalg.norm(h))
        good = size < self.upper - 0.5 * self.room
        good = good and bool(envelope_outside.proven(self.explorer.rings, h[None, None])[0])
        if good:
            self.at, self.upper = h, size
        return good

    def share(self, cells: Cells, budget: int) -> float:
        """Return the share of the work that is done: each factor of the gap is as much work."""
        gap = 1 - float(cells.nearest.min(initial=self.upper)) / self.upper
        closed = np.log(max(gap, self.tolerance)) / np.log(self.tolerance)
        self.done = min(1.0, max(self.done, closed, self.looked_at / budget))
        return self.done

    def result(self, cells: Cells) -> Radius:
        """Return the bounds, given the cells that are left."""
        left = min(self.stuck, float(cells.nearest.min(initial=np.inf)))
        lower = max(0.0, min(self.wanted, left))
        spots = sum(r < lower for r in self.spots)
        shown = lower, self.upper, self.at
        return Radius(*shown, spots, _FINEST * self.room, left >= self.wanted)
