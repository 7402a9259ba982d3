"""Torque capability and its slope over the bias, for two planes with any bias."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from nullmotion.compile import CompiledFunction, compile_function
from nullmotion.compile.tangent import jvp
from nullmotion.guarantee._two_planes import TwoPlanes
from nullmotion.guarantee.evaluate import capability


@dataclass(frozen=True)
class _Biased(TwoPlanes):
    """Two planes with a bias and its gradient that are numbers: w = (Psi, grad Psi)."""

    w: Any = None
    cmgs: tuple[int, int] = (2, 2)
    edge: float = 2.0

    @property
    def counts(self) -> tuple[int, int]:
        return self.cmgs

    @property
    def extent(self) -> float:
        return self.edge

    def bias(self, h: Any) -> tuple[Any, Any]:
        return self.w[0], self.w[1:4]


class Rows:
    """TC^2 = min q, q_i = 1/|row i|^2, at momenta h (N, 3) with w = (Psi, grad Psi) (N, 4).

    q is the function to be linearised: it falls in proportion to the distance where a plane
    saturates, and to the squared distance where one has no momentum to hold.
    """

    def __init__(self, counts: tuple[int, int], extent: float) -> None:
        """Compile the rows of planes with these numbers of CMGs."""

        def made(w: Any) -> _Biased:
            return _Biased(w, counts, extent)

        def rows(h: Any, w: Any) -> Any:
            return 1.0 / made(w).squares(h)

        def slopes(h: Any, w: Any) -> tuple[Any, Any]:
            found = [jvp(rows, (h, w), (None, axis)) for axis in np.eye(4)]
            return found[0][0], np.stack([slope for _, slope in found], axis=1)

        shapes = np.zeros(3), np.zeros(4)
        self._slopes: CompiledFunction = compile_function(slopes, *shapes)
        self._capability: CompiledFunction = compile_function(
            lambda h, w: capability(made(w), h), *shapes
        )

    def squares(self, h: np.ndarray, w: np.ndarray) -> np.ndarray:
        """Return TC^2, (N,); 0 outside."""
        found: np.ndarray = self._capability(h, w)
        return found * found

    def slopes(self, h: np.ndarray, w: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return q (N, k) and its slope over w (N, k, 4); not numbers outside."""
        q, slope = self._slopes(h, w)
        return q, slope


@lru_cache(maxsize=4)
def rows_of(counts: tuple[int, int], extent: float) -> Rows:
    """Return the rows of planes, compiled once."""
    return Rows(counts, extent)
