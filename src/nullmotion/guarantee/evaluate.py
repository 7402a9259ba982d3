"""A constraint's source as kernels over batches of momenta."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from nullmotion import ops
from nullmotion.compile import CompiledFunction, compile_function

if TYPE_CHECKING:
    from nullmotion.guarantee.constraint import Constraint


def capability(constraint: Constraint, h: Any) -> Any:
    """Return the torque capability at a momentum (m,), 0 outside; source."""
    greatest = ops.amax(np.asarray(constraint.squares(h)))
    good = ops.logical_and(constraint.inside(h), ops.less(0.0, greatest))
    good = ops.logical_and(good, ops.less(greatest, np.inf))
    return ops.where(good, 1.0 / ops.sqrt(ops.where(good, greatest, 1.0)), 0.0)


class Compiled:
    """Kernels of one constraint, made when first asked for."""

    def __init__(self, constraint: Constraint) -> None:
        """Remember the constraint; nothing is compiled yet."""
        self._constraint = constraint
        self._made: dict[str, CompiledFunction] = {}

    def _kernel(self, name: str, source: Any) -> CompiledFunction:
        if name not in self._made:
            self._made[name] = compile_function(source, np.zeros(self._constraint.m))
        return self._made[name]

    def angles(self, h: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return gimbal angles and whether each momentum is inside."""
        c = self._constraint

        def source(h: Any) -> tuple[Any, Any]:
            return c.angles(h), ops.where(c.inside(h), 1.0, 0.0)

        angles, inside = self._kernel("angles", source)(h)
        return angles, inside > 0.5

    def capability(self, h: np.ndarray) -> np.ndarray:
        """Return torque capabilities."""
        c = self._constraint
        found: np.ndarray = self._kernel("capability", lambda h: capability(c, h))(h)
        return found


@lru_cache(maxsize=64)
def compiled(constraint: Constraint) -> Compiled:
    """Return the kernels of a constraint."""
    return Compiled(constraint)
