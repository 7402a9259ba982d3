"""Which slews are flown: in the search, in checks, and near those that failed."""

from __future__ import annotations

import numpy as np

from nullmotion.sizing.axes import inside, near, spread, weak
from nullmotion.sizing.cases import Cases, cases, multiplicity
from nullmotion.sizing.curve import Design
from nullmotion.sizing.geometry import Geometry
from nullmotion.sizing.requirement import Requirement
from nullmotion.sizing.trial import Trial

_LEAST = 24  # axes that a search has at the least
_AROUND = np.radians(4.0)  # how far from an axis others are tried


def searched(requirement: Requirement, geometry: Geometry, share: int = 1) -> Cases:
    """Return slews about evenly spread axes, and those where the array is weak.

    About each of the latter one failure or momentum is flown, in turn, where there are several.

    Args:
        requirement: What has to be flown.
        geometry: The array.
        share: Divides the number of axes.
    """
    r, n = requirement, geometry.whole.n
    ways = multiplicity(r, n)
    even = cases(r, n, spread(max(_LEAST, r.sampling.axes // (share * ways)), r.axis, r.cone))
    special = inside(weak(geometry.whole, r.inertia), r.axis, r.cone)
    if not len(special):
        return even
    rows = np.arange(len(special))
    return even.joined(cases(r, n, special).picked(rows * ways + rows % ways))


def lattice(requirement: Requirement, n: int, turn: float, share: int = 1) -> Cases:
    """Return slews about axes of a lattice of its own, of `sampling.check_axes` and the like."""
    r = requirement
    count = max(_LEAST, r.sampling.check_axes // (share * multiplicity(r, n)))
    return cases(r, n, spread(count, r.axis, r.cone, turn))


def nearby(
    requirement: Requirement, slews: Cases, count: int, generator: np.random.Generator
) -> Cases:
    """Return slews like given ones about axes near theirs, within the cone."""
    axes = near(slews.axis, count, _AROUND, generator)
    many = Cases(axes, np.repeat(slews.failed, count), np.repeat(slews.bias, count, axis=0))
    return many.picked(axes @ requirement.axis >= np.cos(requirement.cone) - 1e-12)


def failing(trial: Trial, design: Design, slews: Cases, fine: int = 1) -> Cases:
    """Return those of the slews that a design does not fly."""
    late = trial.settled(slews, np.array([design.h0]), np.array([design.rate]), fine)[0]
    return slews.picked(late >= trial.requirement.time)
