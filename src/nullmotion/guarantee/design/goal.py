"""What a bias is designed for."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from nullmotion.errors import InputError
from nullmotion.guarantee import create
from nullmotion.guarantee.design.family import Family
from nullmotion.guarantee.radius import least_capabilities

OBJECTIVES = ("balanced", "envelope", "radius", "volume")
_MARGIN = 2e-3  # that the least TC stays above the published one, before the last polish


class Reward(NamedTuple):
    """What a unit of radius, or of volume, with a torque capability is worth."""

    torque_capability: float
    weight: float


@dataclass(frozen=True)
class Goal:
    """Maximise rewards, subject to TC(h) >= floor(|h|) and no singularity in a ball.

    Attributes:
        name: What it is called.
        envelope: Radius of the ball without singularity, in units of one CMG's momentum; None
            for as large as a bias of the degree allows.
        radii: Rewards for radii.
        volumes: Rewards for volumes.
        floor: Least TC wanted at sizes of momentum (k,), beside being regular in the ball.
        shells: Sizes at which the floor jumps.
    """

    name: str
    envelope: float | None
    radii: tuple[Reward, ...] = ()
    volumes: tuple[Reward, ...] = ()
    floor: Callable[[np.ndarray], np.ndarray] | None = None
    shells: tuple[float, ...] = ()


def goal_of(
    family: Family,
    objective: str = "balanced",
    levels: tuple[float, ...] = (),
    weights: tuple[float, ...] = (),
    envelope: float | None = None,
) -> Goal:
    """Return a goal by name.

    Args:
        family: What is designed.
        objective: ``balanced``: what is shipped. ``radius`` and ``volume``: that with each of
            the levels. ``envelope``: the radius without singularity, then that of TC >= 0.5.
        levels: Torque capabilities, for ``radius`` and ``volume``; 0.5 by default.
        weights: Weight of each level; 1 by default.
        envelope: Radius without singularity; by default what is shipped (``balanced``), the
            greatest (``envelope``) or 0.9 of the extent.

    Raises:
        InputError: For an objective, levels, weights or a radius that are none.
    """
    if objective not in OBJECTIVES:
        raise InputError("objective", objective, ", ".join(OBJECTIVES))
    if envelope is not None and not 0 < envelope < family.extent:
        raise InputError("envelope", envelope, f"a radius above 0 and below {family.extent:g}")
    if objective in ("balanced", "envelope") and (levels or weights):
        raise InputError("torque capability", levels, "none with this objective")
    if not all(0 < t < np.inf for t in levels) or not all(0 < w < np.inf for w in weights):
        raise InputError("torque capability", (levels, weights), "numbers above 0, weights too")
    if weights and len(weights) != len(levels):
        raise InputError("weight", weights, f"one for each of {len(levels)} torque capabilities")
    if objective == "balanced":
        shipped = family.envelope if envelope is None else envelope
        return _above(family, shipped) if family.published else _radii(family, shipped)
    radius = 0.9 * family.extent if envelope is None else envelope
    if objective == "envelope":
        return Goal(objective, envelope, radii=(Reward(0.5, 1.0),))
    rewards = tuple(map(Reward, levels or (0.5,), weights or (1.0,) * max(len(levels), 1)))
    if objective == "volume":
        return Goal(objective, radius, volumes=rewards)
    return Goal(objective, radius, radii=rewards)


def _above(family: Family, envelope: float) -> Goal:
    """Radius of TC >= 1, and volumes of TC >= 0.5 and 1.

    Required: TC >= 0.5 up to 1.4765, and the least TC above that of all published biases at
    every |h| up to 1.82, near where they end.
    """
    half, last = 1.4765, 1.82
    others = [create(name) for name in family.published]

    def floor(sizes: np.ndarray) -> np.ndarray:
        known = np.max([least_capabilities(other, sizes) for other in others], axis=0)
        best = np.where(sizes < last, known + _MARGIN, 0.0)
        return np.maximum(best, np.where(sizes <= half, 0.5, 0.0))

    volumes = Reward(0.5, 0.0025), Reward(1.0, 0.01)
    return Goal("balanced", envelope, (Reward(1.0, 1.0),), volumes, floor, (half, last - 0.01))


def _radii(family: Family, envelope: float) -> Goal:
    """Radii of the torque capabilities that count; a little for volumes."""
    radii = tuple(Reward(t, weight) for t, weight in family.levels.items())
    return Goal("balanced", envelope, radii, (Reward(0.5, 0.001), Reward(1.0, 0.002)))
