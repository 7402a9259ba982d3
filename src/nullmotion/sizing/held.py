"""Arrays that keep to a constraint function: its law among turned arrays, its start angles."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from nullmotion.array.model import CmgArray
from nullmotion.guarantee.constraint import Constraint
from nullmotion.guarantee.default import chosen
from nullmotion.guarantee.fit import Fit
from nullmotion.law import Law, Observation


@dataclass(frozen=True, eq=False)
class InLayout(Law):
    """A law that must know the axes, flown with arrays whose axes differ between runs.

    The runs' arrays are one array in many body frames; along its torque axes, which turn with
    it, it is the same in all of them.

    Args:
        base: The law.
        array: The array in its own frame, whose torque axes are those of B.
    """

    name: ClassVar[str] = "in-layout"

    base: Law
    array: CmgArray

    def init(self, array: CmgArray, delta: Any) -> Any:
        """Return the law's state."""
        return self.base.init(self._own(array), delta)

    def step(self, array: CmgArray, obs: Observation, state: Any) -> tuple[Any, Any]:
        """Return the law's rates."""
        return self.base.step(self._own(array), obs, state)

    def _own(self, array: CmgArray) -> CmgArray:
        return self.array.altered(h0=array.h0, rate_limit=array.rate_limit)


@dataclass(frozen=True)
class Held:
    """A constraint function on an array.

    Attributes:
        constraint: The function.
        fit: How the array is the one that it holds.
    """

    constraint: Constraint
    fit: Fit

    def starts(self, momentum: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return angles (k, n) that hold momenta (k, 3) over h0, and where they do, (k,)."""
        fit, n = self.fit, len(self.fit.cmgs)
        turned = momentum @ fit.turn.T
        good = np.asarray(self.constraint.torque_capability(turned)) > 0
        angles = self.constraint.gimbal_angles(np.where(good[:, None], turned, 0.0))
        delta = np.empty((len(momentum), n))
        delta[:, list(fit.cmgs)] = (angles - fit.zeros) * fit.signs
        return delta, good


def held(array: CmgArray) -> Held | str:
    """Return the constraint function of an array, or why it has none."""
    found = chosen(None, {}, array)
    return found if isinstance(found, str) else Held(*found)
