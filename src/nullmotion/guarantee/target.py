"""What a constraint function wants of gimbals: where to go, and how fast the aim moves."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from nullmotion.guarantee.constraint import Constraint
from nullmotion.guarantee.evaluate import capability
from nullmotion.guarantee.relabel import in_order, nearest


class Target(NamedTuple):
    """What a constraint wants of an array at a state.

    Attributes:
        way: Wrapped differences target - measured angle [rad], (n,); 0 for a failed CMG.
        rates: Rates of the target under the command [rad/s], (n,); 0 for a failed CMG. They
            are without bounds where the constraint turns in no time.
        momentum: Size of the momentum, in one CMG's.
        capability: Torque capability there, in one CMG's momentum; 0 outside, and where no
            rates are asked for.
        inside: Whether the momentum is inside the constrained envelope.
        held: Whether there is a constraint for the CMGs that work.
    """

    way: Any
    rates: Any
    momentum: Any
    capability: Any
    inside: Any
    held: Any


def target(
    constraint: Constraint, angles: Any, h: Any, change: Any | None, works: Any, labels: str
) -> Target:
    """Return the target of one constraint on its layout; source.

    Args:
        constraint: The constraint, of k <= n CMGs.
        angles: Gimbal angles [rad], (n,).
        h: Momentum of those that work, in one CMG's, (m,).
        change: Wanted rate of that momentum [1/s], (m,); None where no rates are asked for.
        works: Whether each CMG works, (n,); read only for k < n.
        labels: ``nearest`` or ``fixed``.
    """
    goals, capable = constraint.angles(h), 0.0
    rates: Any = np.zeros(len(goals))
    if change is not None:
        rates, capable = constraint.gimbal_jacobian(h) @ change, capability(constraint, h)
    match = nearest if labels == "nearest" else in_order
    if len(goals) < len(angles):  # all are in one group, and as many work as there are goals
        way, rates = match(angles, goals, rates, works)
    else:
        way, rates = in_order(angles, goals, rates)
        for group in constraint.groups if labels == "nearest" else ():
            own = list(group)
            moved = match(angles[own], goals[own], rates[own])
            for k, i in enumerate(group):
                way[i], rates[i] = moved[0][k], moved[1][k]
    return Target(way, rates, np.sqrt(h @ h), capable, constraint.inside(h), True)
