"""How far a torque capability holds: found by search, to be proven by a certificate.

A search finds a momentum where a torque capability is lost, so that its radius is an upper
bound of what can be proven; it is a good one if the search misses nothing.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from nullmotion.errors import InputError
from nullmotion.guarantee.constraint import Constraint
from nullmotion.guarantee.descent import descend, spiral, valleys
from nullmotion.guarantee.evaluate import compiled
from nullmotion.guarantee.singular import nearest_singular
from nullmotion.guarantee.volume import Volume, volume

__all__ = [
    "Radius",
    "Volume",
    "guaranteed_radius",
    "least_capabilities",
    "least_capability",
    "volume",
]

_SHELLS = 160
_CANDIDATES = 24
_INWARD = 0.9  # share of a known radius from which a crossing is looked for
_HALVINGS = 40
_TOLERANCE = 1e-9  # size of the last rosette [rad]


class Radius(NamedTuple):
    """Size of the largest ball around no momentum in which a torque capability holds.

    Attributes:
        value: Its radius, in units of one CMG's momentum.
        momentum: Where on it the torque capability is lost, (m,).
    """

    value: float
    momentum: np.ndarray


def guaranteed_radius(constraint: Constraint, torque_capability: float) -> Radius:
    """Return the least |h| at which TC(h) is less than what is given.

    With 0: the least |h| at which TC vanishes, outside the envelope or at a singularity.
    The first crossing along each of 8192 rays, the lowest of them polished over directions;
    curves of singularities, which rays miss, are looked for by themselves.

    Raises:
        InputError: For a torque capability that is not a finite number from 0 on.
    """
    t = torque_capability
    if not 0 <= t < np.inf:
        raise InputError("torque_capability", t, "a finite number from 0 on")
    function = compiled(constraint).capability
    if function(np.zeros((1, constraint.m)))[0] < t:
        return Radius(0.0, np.zeros(constraint.m))

    def lost(h: np.ndarray) -> np.ndarray:
        found = function(h.reshape(-1, h.shape[-1])).reshape(h.shape[:-1])
        return (found < t) | (found <= 0)

    directions, sizes = _first_losses(constraint, lost)

    def crossing(points: np.ndarray, least: np.ndarray) -> np.ndarray:
        """Return radii of first losses (k, s) where they are below the least known (k,)."""
        high = np.repeat(least[:, None], points.shape[1], axis=1)
        below = lost(high[..., None] * points)
        found = _bisect(lost, points[below], _INWARD * high[below], high[below])
        high[~below], high[below] = np.inf, found
        return high

    best, radii = descend(crossing, directions, sizes, spiral(constraint.m)[2], _TOLERANCE)
    i = int(radii.argmin())
    return Radius(float(radii[i]), radii[i] * best[i])


def least_capability(constraint: Constraint, radius: float) -> float:
    """Return the least TC at momenta of a size, over all their directions.

    Raises:
        InputError: For a size that is not a finite number from 0 on.
    """
    return float(least_capabilities(constraint, [radius])[0])


def least_capabilities(constraint: Constraint, radii: Any) -> np.ndarray:
    """Return the least TC at momenta of each size (k,), over all their directions."""
    sizes = np.asarray(radii, float)
    if sizes.ndim != 1 or not ((sizes >= 0) & (sizes < np.inf)).all():
        raise InputError("radius", radii, "finite numbers from 0 on")
    function = compiled(constraint).capability
    directions, near, spacing = spiral(constraint.m)
    coarse = np.stack([function(r * directions) for r in sizes])
    chosen = valleys(coarse, near, _CANDIDATES)
    known = np.take_along_axis(coarse, chosen, axis=1)
    scale = np.repeat(sizes, _CANDIDATES)[:, None, None]

    def values(points: np.ndarray, _: np.ndarray) -> np.ndarray:
        return function((scale * points).reshape(-1, constraint.m)).reshape(points.shape[:-1])

    start = directions[chosen.ravel()]
    _, least = descend(values, start, known.ravel(), spacing, _TOLERANCE)
    return least.reshape(known.shape).min(axis=1)


def _first_losses(constraint: Constraint, lost: Any) -> tuple[np.ndarray, np.ndarray]:
    """Return the directions (k, m) along which TC is lost first, and where (k,)."""
    directions, near, _ = spiral(constraint.m)
    shells = constraint.reach * np.arange(1, _SHELLS + 1) / _SHELLS
    first = np.full(len(directions), _SHELLS - 1)
    for i in reversed(range(_SHELLS - 1)):
        first[lost(shells[i] * directions)] = i
    high = shells[first]
    radii = _bisect(lost, directions, high - shells[0], high)
    chosen = valleys(radii, near, _CANDIDATES)
    point = nearest_singular(constraint)
    if point is None:
        return directions[chosen], radii[chosen]
    size = np.linalg.norm(point)
    return np.vstack([directions[chosen], point / size]), np.append(radii[chosen], size)


def _bisect(lost: Any, points: np.ndarray, low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """Return where along directions (k, m) TC is lost, between two radii (k,)."""
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        gone = lost(middle[:, None] * points)
        low, high = np.where(gone, low, middle), np.where(gone, middle, high)
    return high
