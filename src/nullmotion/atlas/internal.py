"""The nearest internal singularity that null motion cannot leave.

At an elliptic singular point the form Q of the null motions (`nullmotion.singular_kind`) is
definite: no null motion at all, and momentum can change to one side of the singular surface
only. Turn u so that Q is positive; then near the gimbal angles

    u . (h' - h) = -1/2 x^T Q x + ... <= 0        for every h' that is reached from there

so that a command along u cannot be obeyed, by any steering law. The pseudo-inverse, which
adds no null motion, comes to rest there: along +x on the pyramid of 54.73 deg it runs into
delta = [-90, 0, 90, 0] deg and stays at h = 2 cos(54.73 deg) h0 = 1.1549 h0. (The nearest point of
this pyramid, with u about (1, 1, sqrt 2) / 2, is at 1.1546 h0.) Hyperbolic points can be left by
null motion; that the pseudo-inverse gets caught there too is the law's fault and not the
array's. Degenerate ones, where null motion exists but stays singular (pairs that cancel in box-90
and roof arrays), are neither and do not count here.

`nearest_impassable` is the least |h| of all elliptic points whose rotors are not all on one side
of u, over all sign patterns and directions. Within the radius no such point exists: there every
singular state is hyperbolic, degenerate, or saturated.
"""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np

from nullmotion.array.model import CmgArray
from nullmotion.atlas.impassable import Impassable, described
from nullmotion.atlas.internal_bound import nothing_within
from nullmotion.atlas.internal_points import Point
from nullmotion.atlas.internal_search import least, least_near
from nullmotion.atlas.signs import mixed
from nullmotion.singular_kind import working
from nullmotion.singular_lines import lies_in_a_plane

__all__ = ["Impassable", "nearest_impassable"]

TOLERANCE = 1e-4
_POINTS = 300_000  # of all sheets together
_FEWEST, _MOST = 3000, 20_000  # directions of each
_SEARCH = 0.3  # share of the work
_PASSES = ((0.2, 100_000), (0.5, 300_000))  # share of the work, patches of u


def nearest_impassable(
    array: CmgArray,
    progress: Callable[[float], None] | None = None,
    tolerance: float = TOLERANCE,
) -> Impassable | None:
    """Return the nearest impassable internal singularity; None where there is none.

    Searched on a mesh of all sheets that can be elliptic, then locally. For m = 3 a cover of
    all directions and sign patterns (`internal_bound`) proves that none is nearer; where it
    does not, the search goes on in the patches that are left.

    Args:
        array: The array; its bias shifts all momenta and is left out, end stops are not looked at.
        progress: Called with the finished share. Ctrl-C ends the work.
        tolerance: Share of the radius by which the proof may stay below it.
    """
    start = time.perf_counter()
    report = progress or (lambda share: None)
    kept, _ = working(array, np.zeros(array.n))
    signs = mixed(kept)
    if len(signs) == 0:
        return None
    resolution = int(np.clip(_POINTS // len(signs), _FEWEST, _MOST))
    found = least(kept, signs, resolution)
    report(_SEARCH)
    first = found[0] if found else None
    point, lower, basis = _closed(kept, signs, first, tolerance, report)
    report(1.0)
    if point is None:
        return None
    seconds = time.perf_counter() - start
    return described(array, point, lower, basis, resolution * len(signs), seconds)


def _closed(
    array: CmgArray,
    signs: np.ndarray,
    point: Point | None,
    tolerance: float,
    report: Callable[[float], None],
) -> tuple[Point | None, float, str]:
    """Return the point or a nearer one, a lower bound of |h|, and what it rests on."""
    if lies_in_a_plane(array):
        sums = np.abs(signs @ np.asarray(array.h0, float))
        return point, float(sums.min()), "proven: the sheets are circles"
    if array.m < 3:
        return point, 0.0, "none: found by search"
    lower, looked, done = 0.0, 0, _SEARCH
    for share, budget in _PASSES:

        def within(part: float, begin: float = done, share: float = share) -> None:
            report(begin + share * part)

        wanted = float(np.sum(array.h0)) if point is None else point.size * (1 - tolerance)
        proof = nothing_within(array, signs, wanted, budget, within)
        lower, looked, done = max(lower, proof.radius), looked + proof.patches, done + share
        found = least_near(array, proof.u, proof.signs)
        found += [] if point is None else [point]
        if len(proof.u) == 0 or not found:
            break
        point = min(found, key=lambda p: p.size)
    return point, lower, f"proven, up to rounding, on {looked} patches of u"
