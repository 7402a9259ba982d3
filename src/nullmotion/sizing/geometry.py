"""Arrays with h0 = 1: whole, and after each failure; their angles before a slew."""

from __future__ import annotations

from typing import Literal

import numpy as np

from nullmotion.array import layouts
from nullmotion.array.model import CmgArray
from nullmotion.sizing import start as starts
from nullmotion.sizing.cases import NONE_FAILED, Cases
from nullmotion.sizing.held import Held, held

Start = Literal["home", "constraint"]


class Geometry:
    """A layout at an angle, with h0 = 1.

    Args:
        layout: Its name.
        skew: Its skew or roof angle [rad]; None for a layout without.
        failures: Whether one CMG may have failed.
        start: Where slews begin: at the layout's ``home`` and its surroundings, or at the angles
            of the array's ``constraint`` function.

    Attributes:
        held: Constraint functions, of the whole array and after each failure; empty unless
            all of them have one.
        arrays: What is left after the failure of each CMG; the whole array at -1.
        reason: Why it cannot fly after a failure; empty if it may.
    """

    def __init__(
        self, layout: str, skew: float | None, failures: bool, start: Start = "home"
    ) -> None:
        """Find the start angles, after each failure too."""
        own = {} if skew is None else {"skew": skew}
        self.layout, self.skew, self.start = layout, skew, start
        self.whole: CmgArray = layouts.create(layout, **own)
        self.arrays = {NONE_FAILED: self.whole}
        self.reason = ""
        self._homes = {NONE_FAILED: layouts.home(layout, **own)}
        for i in range(self.whole.n) if failures else ():
            self.arrays[i] = self.whole.without(i)
            home = starts.rest(self.arrays[i])
            if home is None and not self.reason:
                self.reason = f"without CMG {i + 1} it is singular wherever it has no momentum"
            self._homes[i] = np.zeros(self.arrays[i].n) if home is None else home
        known = {i: held(array) for i, array in self.arrays.items()}
        self.held = {i: h for i, h in known.items() if isinstance(h, Held)}
        if len(self.held) < len(known):
            self.held = {}

    def starts(self, cases: Cases, h0: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return start angles [rad], (k, n), and where the array can hold the bias, (k,).

        Args:
            cases: The slews, all with as many CMGs.
            h0: Momentum of the CMGs of each [N m s], (k,).
        """
        momentum = cases.bias / h0[:, None]
        n = self.arrays[int(cases.failed[0])].n
        delta, good = np.empty((len(cases), n)), np.empty(len(cases), bool)
        for i in np.unique(cases.failed).tolist():
            rows = cases.failed == i
            delta[rows], good[rows] = self._holding(i, momentum[rows])
        return delta, good

    def _holding(self, i: int, momentum: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        if self.start == "constraint" and self.held:
            return self.held[i].starts(momentum)
        return starts.holding(self.arrays[i], self._homes[i], momentum)

    def at(self, skew: float | None = None, start: Start | None = None) -> Geometry:
        """Return the layout at another angle or with another start."""
        failures = len(self.arrays) > 1
        return Geometry(self.layout, skew or self.skew, failures, start or self.start)

    def axes(self, cases: Cases) -> tuple[np.ndarray, np.ndarray]:
        """Return the gimbal and spin axes of the CMGs that work in each slew, (k, n, 3)."""
        kinds = np.unique(cases.failed)
        which = np.searchsorted(kinds, cases.failed)
        arrays = [self.arrays[i] for i in kinds.tolist()]
        gimbal = np.array([array.gimbal_axes for array in arrays])
        return gimbal[which], np.array([array.spin_axes for array in arrays])[which]
