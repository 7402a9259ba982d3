"""The volume of R: of cells proven reachable, and of those not proven unreachable."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from nullmotion.atlas import envelope_outside
from nullmotion.atlas.envelope_cells import Cells, ball
from nullmotion.atlas.envelope_cover import Explorer
from nullmotion.atlas.envelope_rings import Rings

_BATCH = 4000
_SETS = 60  # of sectors for a cell that is tried to be proven unreachable


class Measure(NamedTuple):
    """Volume in units of the mean momentum to the power of m.

    Attributes:
        lower: Volume of cells proven reachable.
        upper: Volume of cells not proven unreachable.
        estimate: Between them, by whether an undecided cell's centre is reachable.
        cells: Number of cells looked at.
    """

    lower: float
    upper: float
    estimate: float
    cells: int


def measured(
    rings: Rings,
    radius: float,
    tolerance: float,
    progress: Callable[[float], None] | None = None,
    budget: int = 60_000,
) -> Measure:
    """Return bounds of the volume of R, which lies in a ball around no momentum.

    The largest undecided cells are looked at first. Half the ball stands for the whole: R is
    the same seen from both sides.
    """
    explorer, cells = Explorer(rings), ball(rings.m, radius, len(rings.ring_of))
    inside, count, half = 0.0, 0, np.zeros(0, bool)
    whole = float(cells.share.sum())
    half = np.zeros(len(cells), bool)  # whether the cell's centre was reached before the cut
    while len(cells) and count < budget:
        share = cells.share
        if share.sum() <= tolerance * (inside + share.sum()):
            break
        order = np.argsort(-share, kind="stable")
        first, rest = cells.take(order[:_BATCH]), cells.take(order[_BATCH:])
        count += len(first)
        found = explorer.explore(first)
        inside += float(share[order[:_BATCH]][found.inside].sum())
        left = ~found.inside & ~_unreachable(rings, found.cells, found.inside | found.reached)
        half = np.concatenate([half[order[_BATCH:]], np.tile(found.reached[left], 2)])
        cells = rest.joined(found.cells.take(left).halves(found.axis[left]))
        if progress is not None:
            progress(1.0 - float(cells.share.sum()) / whole)
    share = cells.share
    estimate = inside + float(share[half].sum())
    return Measure(2 * inside, 2 * (inside + float(share.sum())), 2 * estimate, count)


def _unreachable(rings: Rings, cells: Cells, known: np.ndarray) -> np.ndarray:
    """Return which cells are proven unreachable, where no momentum is known to be, (B,)."""
    left = np.flatnonzero(~known)
    found = np.zeros(len(cells), bool)
    if len(left):
        found[left] = envelope_outside.proven(rings, cells.hulls()[left], _SETS)
    return found
