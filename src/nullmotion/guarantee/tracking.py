"""A constraint function on an array, as steering laws follow it.

With h the momentum of the working CMGs in units of one CMG's, and F the constraint, the
array's target at a measured state is F(h), relabelled: CMGs of a group take the nearest
matching of the group's angles. A planar array that has lost CMGs follows the closed form of
those that still work.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from nullmotion import ops
from nullmotion.array.model import CmgArray
from nullmotion.errors import InputError
from nullmotion.guarantee.constraint import Constraint
from nullmotion.guarantee.default import chosen
from nullmotion.guarantee.fit import Fit
from nullmotion.guarantee.target import Target, target

_EQUAL = 1e-6  # momenta that agree to this share are equal
_STILL = 1e-12  # momentum below which rounding alone would choose a direction


@dataclass(frozen=True, eq=False)
class Tracking:
    """A constraint function on an array.

    Attributes:
        constraints: One for all CMGs; for one less, two less, ... where there are such.
        fit: How the array is the constraint's.
    """

    constraints: tuple[Constraint, ...]
    fit: Fit

    def target(
        self, array: CmgArray, delta: Any, hdot: Any | None = None, labels: str = "nearest"
    ) -> Target:
        """Return the target of the working CMGs; source.

        Args:
            array: The array; a CMG that has failed has h0 = 0.
            delta: Gimbal angles [rad], (n,).
            hdot: Wanted rate of momentum [N m], (m,); None where no rates are asked for.
            labels: ``nearest``, or ``fixed``: the i-th working CMG keeps the i-th angle.
        """
        scale = array.mean_momentum
        momenta = array.rotor_momenta(delta)  # without the bias
        h = self.fit.turn @ (sum(momenta[i] for i in range(array.n)) / scale)
        h = ops.where(ops.less(h @ h, _STILL * _STILL), _STILL * np.eye(len(h))[0], h)
        change = None if hdot is None else self.fit.turn @ (hdot / scale)
        works = ops.less(0.0, array.h0)[list(self.fit.cmgs)]
        count = sum(ops.where(flag, 1.0, 0.0) for flag in works)
        zero, none = np.zeros(array.n), ops.less(count, 0.0)
        found = Target(zero, zero, np.sqrt(h @ h), 0.0, none, none)
        with np.errstate(all="ignore"):  # floats go beyond the envelope, too
            for constraint, size in self._possible(works):
                now = ops.equal(count, size)
                one = target(constraint, self.fit.angles(delta), h, change, works, labels)
                one = one._replace(held=now)
                found = Target(*(ops.where(now, *pair) for pair in zip(one, found, strict=True)))
        way, rates = self.fit.changes(found.way), self.fit.changes(found.rates)
        return found._replace(way=way, rates=rates)

    def _possible(self, works: Any) -> list[tuple[Constraint, float]]:
        """Return the constraints that may be asked for, and how many CMGs each is for."""
        n = len(self.fit.cmgs)
        known = [bool(flag) for flag in works if not ops.is_symbolic(flag)]
        sizes = [(c, n - lost) for lost, c in enumerate(self.constraints)]
        return [(c, float(k)) for c, k in sizes if sum(known) <= k <= n - known.count(False)]

    def common_turn(self, array: CmgArray, wanted: Target) -> Any:
        """Return the turn that is common to all ways, for each CMG [rad], (n,); source.

        Where all CMGs have one gimbal axis it is null motion at h = 0, and leads from one set
        of angles to another of the same torque capability; elsewhere 0.
        """
        n = array.n
        if self.constraints[0].groups != (tuple(range(n)),):
            return np.zeros(n)
        works = ops.where(ops.less(0.0, array.h0), 1.0, 0.0) * self.fit.changes(np.ones(n))
        return (works @ wanted.way) / (works @ works) * works


def tracking(name: str | None, parameters: Mapping[str, Any], array: CmgArray) -> Tracking | str:
    """Return a constraint function on an array, or why it cannot be.

    Args:
        name: The constraint; None for the array's own.
        parameters: Its parameters.
        array: The array; its h0 may be symbols.

    Raises:
        TraceError: When the gimbal axes are symbols.
    """
    found = chosen(name, parameters, array)
    if isinstance(found, str):
        return found
    constraint, how = found
    constraints = [constraint]
    while constraint.groups == (tuple(range(array.n - len(constraints) + 1)),):
        try:
            constraint = constraint.without(0)
        except InputError:
            break
        constraints.append(constraint)
    return Tracking(tuple(constraints), how)


def refused(name: str | None, parameters: Mapping[str, Any], array: CmgArray) -> str:
    """Return why a law cannot steer an array by a constraint; an empty string if it can."""
    found = tracking(name, parameters, array)
    if isinstance(found, str):
        return found
    working = array.h0[array.h0 > 0]
    if np.ptp(working) > _EQUAL * working.max():
        return f"a constraint holds CMGs of equal momentum, not h0 = {array.h0.tolist()}"
    if array.n - len(working) >= len(found.constraints):
        return f"{found.constraints[0].name} has no constraint for {len(working)} working CMGs"
    return ""
