"""The greatest and the least value of R's support function over all directions.

S(u) = max h . u over R is convex. On a patch whose corners w_k have at least the cosine c with its
centre, u = sum l_k w_k with l_k >= 0 and 1 <= sum l_k <= 1 / c for every unit vector u, hence

    S(u) <= max_k S(w_k) / c                        (convex and homogeneous)
    S(u) >= h . u >= min_k h . w_k                  for any h in R, where that is not negative

Both are exact to second order in the size of the patch, with h the momentum that is farthest
along its centre or a corner. Patches that cannot hold the extreme are dropped, others are cut.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from nullmotion.atlas.envelope_cells import Cells, sphere
from nullmotion.atlas.envelope_rings import Rings

_ROUNDS = 80
_ENOUGH = 200_000  # patches
_CLIMBS = 500
_ROUNDING = 1e-13

Found = tuple[float, float, np.ndarray]


def greatest(rings: Rings, tolerance: float = 1e-8) -> Found:
    """Return bounds of max |h| over R, and a momentum of R of the lower bound's size, (m,)."""
    best = np.zeros(rings.m)

    def bound(cells: Cells) -> tuple[np.ndarray, float]:
        nonlocal best
        hulls = cells.hulls()
        corners, stretch = _corners(hulls)
        upper = rings.support(corners).max(axis=1) * stretch
        found = _climbed(rings, cells.centres()[[rings.support(cells.centres()).argmax()]])
        if np.linalg.norm(found) > np.linalg.norm(best):
            best = found
        return -upper, -float(np.linalg.norm(best))

    lower, upper = _closed(sphere(rings.m), bound, tolerance)
    return -upper, -lower, best


def least(rings: Rings, tolerance: float = 1e-8) -> Found:
    """Return bounds of min S(u), and the direction of the upper one, (m,).

    It is the radius of the largest ball around the origin in the convex hull of R.
    """
    best, value = np.zeros(rings.m), np.inf

    def bound(cells: Cells) -> tuple[np.ndarray, float]:
        nonlocal best, value
        hulls, centres = cells.hulls(), cells.centres()
        corners, _ = _corners(hulls)
        u = np.concatenate([centres[:, None], corners], axis=1)
        lower = (rings.top(u) @ corners.mT).min(axis=2).max(axis=1)
        size = rings.support(u)
        if size.min() < value:
            value = float(size.min())
            best = u.reshape(-1, rings.m)[size.argmin()]
        return np.maximum(lower, 0.0), value

    lower, upper = _closed(sphere(rings.m), bound, tolerance)
    return lower, upper, best


def _closed(
    cells: Cells, bound: Callable[[Cells], tuple[np.ndarray, float]], tolerance: float
) -> tuple[float, float]:
    """Return bounds of a minimum over cells, given each cell's lower bound and a value."""
    dropped, value = np.inf, np.inf
    for _ in range(_ROUNDS):
        lower, value = bound(cells)
        lower = lower - _ROUNDING * np.abs(lower)
        kept = lower < value - tolerance * abs(value)
        dropped = min(dropped, float(lower[~kept].min(initial=np.inf)))
        cells = cells.take(kept)
        if len(cells) == 0 or cells.box.shape[1] == 1 or len(cells) > _ENOUGH:
            dropped = min(dropped, float(lower[kept].min(initial=np.inf)))
            break
        axis = (cells.box[:, :-1, 1] - cells.box[:, :-1, 0]).argmax(axis=1)
        cells = cells.halves(axis)
    else:
        dropped = min(dropped, float(lower[kept].min(initial=np.inf)))
    return min(dropped, value), value


def _corners(hulls: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the corners of patches of the unit sphere, and 1 / c, from their hulls."""
    half = hulls.shape[1] // 2
    return hulls[:, :half], np.linalg.norm(hulls[:, half], axis=1)


def _climbed(rings: Rings, u: np.ndarray) -> np.ndarray:
    """Return the momentum reached from a direction by turning it towards top(u): |h| grows."""
    h = rings.top(u)
    for _ in range(_CLIMBS):
        following = rings.top(h)
        if np.linalg.norm(following) <= np.linalg.norm(h) * (1 + 1e-15):
            break
        h = following
    found: np.ndarray = h.reshape(-1)
    return found
