"""The set R of reachable momenta: how far it reaches, its largest ball, its volume.

R is the image of all gimbal angles, neither its convex hull nor one sheet of the singular
surfaces: around each gimbal axis the outer surface has a hole, and below the hole a funnel. All
momenta here are without the array's bias, and gimbal end stops are left out.

Whether a momentum is in R is decided by proof, up to rounding: `envelope_inside` and
`envelope_three` show whole cells of momentum space reachable, `envelope_outside` shows
momenta unreachable. What is searched for is only where to look.
"""

from __future__ import annotations

import time
from typing import Any

import numpy as np

from nullmotion.array.model import CmgArray
from nullmotion.atlas import envelope_cells, envelope_support
from nullmotion.atlas.bounds import Bounds
from nullmotion.atlas.envelope_radius import BUDGET as CELLS
from nullmotion.atlas.envelope_radius import Progress, Radius, least_unreachable
from nullmotion.atlas.envelope_rings import Rings, rings
from nullmotion.atlas.envelope_volume import BUDGET, convex, measured
from nullmotion.atlas.signs import checked_directions
from nullmotion.errors import InputError

__all__ = ["Bounds", "max_momentum", "omnidirectional", "reach", "volume"]

TOLERANCE = 2e-4
_PROVEN = "proven"
_OPEN = "proven, not closed within {} cells"
_SPOTS = "; but for {} spots around reachable momenta, no longer than {:.2g} N m s"
_FLAT = "proven: the reachable momenta have no volume"


def max_momentum(array: CmgArray) -> Bounds:
    """Return the largest |h| of any direction [N m s].

        max |h| over R = max_u sum_i h0_i |p_i(u)|

    Both bounds are proven: of patches that cover all directions, see `envelope_support`.
    """
    start = time.perf_counter()
    found = rings(array)
    lower, upper, h = envelope_support.greatest(found)
    return _bounds(found, lower, upper, h, _PROVEN, start)


def omnidirectional(
    array: CmgArray,
    tolerance: float = TOLERANCE,
    progress: Progress | None = None,
    budget: int = CELLS,
) -> Bounds:
    """Return the radius of the largest ball around no momentum within R [N m s].

    Every |h| up to the lower bound is reachable in every direction, and not every one up to the
    upper: both are proven. 0 when no gimbal angles give no momentum. Ctrl-C ends it.

    Args:
        array: The array; its bias and end stops are left out.
        tolerance: Share of the radius up to which the bounds are closed.
        progress: Called with the share of the radius that is proven, 0 to 1.
        budget: Cells of momentum space after which the bounds stay as far apart as they are.

    Raises:
        InputError: For a tolerance that is not between 1e-6 and 0.5.
    """
    start = time.perf_counter()
    found = rings(array)
    if found.flat:
        return _bounds(found, 0.0, 0.0, np.zeros(found.m), _FLAT, start)
    lower, upper, u = envelope_support.least(found)
    if found.convex:
        return _bounds(found, lower, upper, upper * u, _PROVEN, start)
    cells = envelope_cells.ball(found.m, upper, len(found.ring_of))
    radius = least_unreachable(found, cells, upper * u, _checked(tolerance), progress, budget)
    return _from_radius(found, radius, budget, start)


def reach(
    array: CmgArray,
    direction: Any,
    tolerance: float = TOLERANCE,
    progress: Progress | None = None,
) -> Bounds:
    """Return the largest r such that all momenta up to r in a direction are reachable [N m s].

    Both bounds are proven; see `omnidirectional`.

    Args:
        array: The array; its bias and end stops are left out.
        direction: Vector along the torque axes, of any length, (m,).
        tolerance: Share of r up to which the bounds are closed.
        progress: Called with the share of r that is proven, 0 to 1.

    Raises:
        InputError: For a direction without length or of another shape, or a tolerance that is
            not between 1e-6 and 0.5.
    """
    start = time.perf_counter()
    along = checked_directions(array, direction, "direction")
    if along.ndim != 1:
        raise InputError("direction", along.tolist(), f"one vector of {array.m} components")
    found = rings(array)
    if found.flat:
        return _bounds(found, 0.0, 0.0, np.zeros(found.m), _FLAT, start)
    last = float(found.support(along)) * along
    cells = envelope_cells.ray(along, float(np.linalg.norm(last)), len(found.ring_of))
    radius = least_unreachable(found, cells, last, _checked(tolerance), progress)
    return _from_radius(found, radius, CELLS, start)


def volume(
    array: CmgArray,
    tolerance: float = 0.05,
    progress: Progress | None = None,
    budget: int = BUDGET,
) -> Bounds:
    """Return the volume of R [(N m s)^m]: of the plane's area for m = 2, the length for m = 1.

    Both bounds are proven: the cells shown reachable, and those not shown unreachable. `value`
    is the estimate from the cells' centres.

    Args:
        array: The array.
        tolerance: Share of the volume up to which the bounds are closed.
        progress: Called with the share that is decided, 0 to 1.
        budget: Cells after which the bounds stay as far apart as they are.
    """
    start = time.perf_counter()
    found = rings(array)
    if found.flat:
        return _bounds(found, 0.0, 0.0, None, _FLAT, start)
    closed = _checked(tolerance)
    measure = convex(found) if found.convex else measured(found, closed, progress, budget)
    scale = found.unit**found.m
    return Bounds(
        measure.lower * scale,
        measure.upper * scale,
        estimate=measure.estimate * scale,
        basis=_PROVEN if measure.complete else _OPEN.format(budget),
        seconds=time.perf_counter() - start,
    )


def _checked(tolerance: float) -> float:
    if not 1e-6 <= tolerance <= 0.5:
        raise InputError("tolerance", tolerance, "a number from 1e-6 to 0.5")
    return float(tolerance)


def _from_radius(found: Rings, radius: Radius, budget: int, start: float) -> Bounds:
    basis = _PROVEN if radius.complete else _OPEN.format(budget)
    if radius.spots:
        basis += _SPOTS.format(radius.spots, radius.size * found.unit)
    return _bounds(found, radius.lower, radius.upper, radius.at, basis, start)


def _bounds(
    found: Rings, lower: float, upper: float, at: np.ndarray | None, basis: str, start: float
) -> Bounds:
    unit = found.unit
    where = None if at is None else at * unit
    seconds = time.perf_counter() - start
    return Bounds(lower * unit, upper * unit, at=where, basis=basis, seconds=seconds)
