"""The momentum up to which a constraint law gives a torque in every direction, proven."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from nullmotion.array.model import CmgArray
from nullmotion.errors import InputError
from nullmotion.guarantee import default, table, tracking

LEVELS = (0.5,)


@dataclass(frozen=True)
class Guaranteed:
    """A radius that a constraint law guarantees at a torque.

    Attributes:
        constraint: Name of the constraint function.
        torque_capability: Torque in every direction over h0 times the rate limit.
        torque_Nm: That torque [N m]; infinite without a rate limit.
        radius: Largest |h| without bias at which it is there, by search [N m s].
        proven_radius: Radius up to which it is proven [N m s]; None if it is not.
        boxes: Boxes of the proof.
    """

    constraint: str
    torque_capability: float
    torque_Nm: float
    radius: float
    proven_radius: float | None
    boxes: int

    def as_dict(self) -> dict[str, Any]:
        """Return the radius for a JSON file."""
        endless = not np.isfinite(self.torque_Nm)
        return {
            "constraint": self.constraint,
            "torque_capability": self.torque_capability,
            "torque_Nm": None if endless else self.torque_Nm,
            "radius": self.radius,
            "proven_radius": self.proven_radius,
            "boxes": self.boxes,
        }


def guaranteed(
    array: CmgArray,
    levels: Sequence[float] = LEVELS,
    progress: Callable[[float], None] | None = None,
) -> tuple[Guaranteed, ...] | str:
    """Return the guaranteed radius at torque capabilities, or why no constraint law gives any.

    Args:
        array: The array.
        levels: Torque capabilities over h0 times the rate limit; what the array does not give
            even without momentum has radius 0.
        progress: Called with the finished share.

    Raises:
        InputError: For a level that is not a finite number above 0.
    """
    for level in levels:
        if not 0 < level < np.inf:
            raise InputError("torque_capability", level, "a finite number above 0")
    dead = np.flatnonzero(np.asarray(array.h0) == 0)
    array = array.without(dead) if len(dead) else array
    reason = tracking.refused(None, {}, array)
    found = default.chosen(None, {}, array)
    if reason or isinstance(found, str):
        return reason or str(found)
    rows = []
    for i, level in enumerate(levels):
        rows.append(_row(array, found[0], level))
        if progress is not None:
            progress((i + 1) / len(levels))
    return tuple(rows)


def _row(array: CmgArray, constraint: Any, level: float) -> Guaranteed:
    unit = float(array.mean_momentum)
    torque = level * unit * float(np.min(array.rate_limit))
    home = float(constraint.torque_capability(np.zeros(constraint.m)))
    if level >= home:
        return Guaranteed(constraint.name, level, torque, 0.0, None, 0)
    radius = table.largest_radius(constraint, level).value
    proof = table.prove_radius(constraint, level, radius)
    if proof.reason == "interrupted":
        raise KeyboardInterrupt
    proven = proof.radius * unit if proof.proven else None
    return Guaranteed(constraint.name, level, torque, radius * unit, proven, proof.boxes)
