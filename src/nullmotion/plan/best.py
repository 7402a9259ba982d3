"""The best courses so far."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

TIE = 1e-9  # relative difference of values that counts as none
INTERRUPTED = "interrupted: the best so far, not proven"
Progress = Callable[[float], None]


class Best:
    """The greatest value and the courses that have it.

    Args:
        value: Value to beat: that of no null motion.
        most: Number of courses to keep.

    Attributes:
        value: The greatest value.
        knots: Courses of this value, (courses, depth); none if none was found.
        complete: Whether none was left out because there are too many.
    """

    def __init__(self, value: float, depth: int, most: int = 1000) -> None:
        """Start with nothing but a value to beat."""
        self.value, self.most, self.complete = float(value), most, True
        self._baseline = float(value)
        self.knots, self._values = np.empty((0, depth)), np.empty(0)

    @property
    def least(self) -> float:
        """The least value that is a tie."""
        return self.value - TIE * abs(self.value) if np.isfinite(self.value) else self.value

    @property
    def full(self) -> bool:
        """Whether no more ties are kept."""
        return len(self._values) >= self.most

    def hopeless(self, bounds: np.ndarray) -> np.ndarray:
        """Return whether nothing worth keeping can lie below a bound."""
        if self.full and bounds.size:
            above = self.value + TIE * abs(self.value)
            worse: np.ndarray = bounds <= above
            self.complete &= not (worse & (bounds >= self.least)).any()
            return worse
        return ~(bounds >= self.least)

    def offer(self, values: np.ndarray, knots: Callable[[np.ndarray], np.ndarray]) -> None:
        """Take what is at least as good; ``knots`` gives the courses of some indices."""
        top = float(values.max(initial=-np.inf))
        if not top >= self.least:
            return
        if top > self.value + TIE * abs(self.value):
            self.complete = True  # what was left out is no tie any more
        self.value = max(self.value, top)
        found = np.flatnonzero(values >= self.least)
        kept = self._values >= self.least
        self._values = np.concatenate([self._values[kept], values[found]])
        self.knots = np.concatenate([self.knots[kept], knots(found)])
        if len(self._values) > self.most:
            self.complete = False
            motion = np.abs(self.knots).sum(axis=1)
            order = np.argsort(motion, kind="stable")[: self.most]
            self._values, self.knots = self._values[order], self.knots[order]

    def ranked(self) -> list[tuple[float, ...]]:
        """Return the courses, the one with least null motion first, then the positive one.

        No null motion is one of them where nothing is better.
        """
        rows = {tuple(float(k) + 0.0 for k in row) for row in self.knots}
        if not self.value > self._baseline + TIE * abs(self._baseline):
            rows.add((0.0,) * self.knots.shape[1])
        return sorted(rows, key=lambda r: (sum(map(abs, r)), [-k for k in r]))
