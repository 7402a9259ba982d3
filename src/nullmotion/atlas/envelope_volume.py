"""The volume of R: of cells proven reachable, and of those not proven unreachable."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import factorial

import numpy as np
from scipy.spatial import ConvexHull

from nullmotion.atlas import envelope_outside, envelope_three
from nullmotion.atlas.envelope_cells import ball
from nullmotion.atlas.envelope_cover import Explorer
from nullmotion.atlas.envelope_frusta import Frusta
from nullmotion.atlas.envelope_hull import Outside, cover
from nullmotion.atlas.envelope_rings import Rings

BUDGET = 150_000  # cells
_BATCH = 4000  # cells looked at together
_SETS = 60  # of sectors for a cell that is tried to be proven unreachable
_POINTS = 2000  # momenta of undecided cells that are looked for
_SEED = 20240601
_FACE = 64  # pieces of directions along a cube's edge for a convex R


@dataclass(frozen=True)
class Measure:
    """Volume in units of the mean momentum to the power of m.

    Attributes:
        lower: Volume of what is proven reachable.
        upper: Volume of what is not proven unreachable.
        estimate: Between them.
        complete: Whether the bounds are as close as they were asked to be.
    """

    lower: float
    upper: float
    estimate: float
    complete: bool


def measured(
    rings: Rings,
    tolerance: float,
    progress: Callable[[float], None] | None = None,
    budget: int = BUDGET,
) -> Measure:
    """Return bounds of the volume of R, which is not convex, for m = 2 and 3.

    The largest undecided cells are looked at first. Half of R stands for the whole: it is the
    same seen from both sides.

    Args:
        rings: The array's rings.
        tolerance: Share of the volume up to which the bounds are closed.
        progress: Called with the share of the work that is done.
        budget: Number of cells after which the bounds are what they are.
    """
    explorer, outside = Explorer(rings), Outside(rings)
    cells = outside.cut(cover(rings, outside))
    inside, count, gap = 0.0, 0, 1.0
    while len(cells) and count < budget and gap > tolerance:
        order = np.argsort(-cells.share, kind="stable")[: budget - count]
        first, rest = cells.take(order[:_BATCH]), np.delete(np.arange(len(cells)), order[:_BATCH])
        more, halves = _explored(explorer, first)
        cells = cells.take(rest).joined(outside.cut(halves))
        inside, count, undecided = inside + more, count + len(first), float(cells.share.sum())
        gap = undecided / (inside + undecided)
        if progress is not None:  # the work grows with 1 / gap
            progress(min(1.0, max(tolerance / max(gap, 1e-300), count / budget)))
    undecided = float(cells.share.sum())
    part = _reachable_part(explorer, cells)
    return Measure(
        2 * inside, 2 * (inside + undecided), 2 * (inside + part * undecided), gap <= tolerance
    )


def convex(rings: Rings) -> Measure:
    """Return bounds of the volume of a convex R: of a polytope in it and one around it.

    Each cone over a face with the normal u is cut off by h . u <= S(u).
    """
    if rings.m == 1:
        length = 2 * float(rings.support(np.ones(1)))
        return Measure(length, length, length, True)
    u = ball(rings.m, 1.0, 0, _FACE, 1).centres()
    top = rings.top(np.concatenate([u, -u]))
    hull = ConvexHull(top)
    normal, offset = hull.equations[:, :-1], -hull.equations[:, -1]
    cone = np.abs(np.linalg.det(top[hull.simplices])) / factorial(rings.m)
    around = float(cone @ (rings.support(normal) / offset) ** rings.m)
    return Measure(float(cone.sum()), around, 0.5 * (float(cone.sum()) + around), True)


def _explored(explorer: Explorer, cells: Frusta) -> tuple[float, Frusta]:
    """Return the volume of the cells that is reachable, and halves of the undecided ones."""
    found = explorer.explore(cells)
    left = ~found.inside & ~found.outside
    unknown = np.flatnonzero(left & ~found.reached)
    if len(unknown) and not envelope_three.applies(explorer.rings):
        hulls = cells.hulls()[unknown]
        left[unknown] = ~envelope_outside.proven(explorer.rings, hulls, _SETS)
    halves = cells.seeded(found.seeds).take(left).halves(found.axis[left])
    return float(cells.share[found.inside].sum()), halves


def _reachable_part(explorer: Explorer, cells: Frusta) -> float:
    """Return the part of the cells' volume that is reachable, from random momenta."""
    if len(cells) == 0:
        return 0.0
    rng = np.random.default_rng(_SEED)
    chosen = rng.choice(len(cells), _POINTS, p=cells.share / cells.share.sum())
    some = cells.take(chosen)
    return float(explorer.held(some.points(rng)[:, None], some.seeds).mean())
