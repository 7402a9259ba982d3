"""One step of the solver: its nodes, and where on it a spike begins or ends to carry.

A spike that carries ends to when K_c s - C_c z' falls to 0, or rather to -F_g / 100: a spike that
slides along under no load, as damping along the ground may have it, would else begin and end to
carry with every rounding. Another begins to when both that and its sinkage s are above 0.

The nodes and weights are Radau's, after the step's start that counts nothing: sums over them are
integrals over the step to order 5.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from nullmotion.rover.contact_field import Field
from nullmotion.rover.contact_signals import Signals

_PULL = 0.01
_ROOT = 6**0.5
NODES = np.array([0.0, (4 - _ROOT) / 10, (4 + _ROOT) / 10, 1.0])
WEIGHTS = np.array([0.0, (16 - _ROOT) / 36, (16 + _ROOT) / 36, 1 / 9])


class Step:
    """A step of the solver, or the part of it until a spike begins or ends to carry.

    Attributes:
        path: The solver's polynomial.
        length: How long it is [s].
        t: Its nodes [s], (4,).
        x: States there, (4, 15).
        rows: Signals there, (4, ...).
        carrying: Which spikes carry, (V,).
    """

    def __init__(self, equations: Field, path: Any, start: float, end: float) -> None:
        """Evaluate the nodes."""
        self.path, self.length = path, end - start
        self._equations = equations
        self.carrying = equations.carrying
        self.t = start + self.length * NODES
        self.x = path(self.t).T
        pairs = zip(self.t, self.x, strict=True)
        self.rows = np.array([equations.row(t, x) for t, x in pairs])

    def first_change(self) -> tuple[float, int] | None:
        """Return when and which spike first begins or ends to carry, if one does.

        What is below 0 at the start is so by rounding, after the change that the step begins with.
        """
        left = self._left(self.rows)
        over = (left < 0) & (left < left[0])
        if not over.any():
            return None
        node = int(np.argmax(over.any(axis=1)))
        spikes = np.flatnonzero(over[node])
        instants = [self._instant(int(spike), *self.t[node - 1 : node + 1]) for spike in spikes]
        first = int(np.argmin(instants))
        return instants[first], int(spikes[first])

    def _instant(self, spike: int, begin: float, end: float) -> float:
        from scipy.optimize import brentq

        def left(t: float) -> float:
            return float(self._left(self._equations.row(t, self.path(t)))[spike])

        return float(brentq(left, begin, end, xtol=1e-13)) if left(begin) > 0 else begin

    def _left(self, rows: np.ndarray) -> np.ndarray:
        """Return what is left until each spike ends to carry [N], or begins to [N or m]."""
        signals = Signals.split(rows)
        begins = -np.minimum(signals.sinkage, signals.normal)
        ends = signals.normal + _PULL * self._equations.setting.ground.grip
        return np.where(self.carrying, ends, begins)
