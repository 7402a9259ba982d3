"""Gradient ascent of many courses at once on values that grow sharper."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from nullmotion.plan.smooth import SmoothValue

STEPS = 150
_WIDTHS = 0.3, 0.01  # first and last
_MOVES = 0.1, 0.003  # of a knot in one step, first and last
_FADE = 0.9, 0.95  # of the gradient's mean and mean square


def ascend(
    smooth: SmoothValue, knots: np.ndarray, visit: Callable[[int, np.ndarray], bool]
) -> None:
    """Follow the gradient uphill from every course, within the knots' bounds of 1.

        m <- 0.9 m + 0.1 g,    v <- 0.95 v + 0.05 g^2,    k <- clip(k + a m / sqrt(v))

    (Adam, both means corrected for their start from 0), while the width of the smoothed
    value shrinks by a constant factor from 0.3 to 0.01 and the step a from 0.1 to 0.003.

    Args:
        smooth: Gives the gradients.
        knots: Where to begin, (runs, depth).
        visit: Called with the number of steps done and the courses reached; tells whether
            to go on.
    """
    mean, square = np.zeros_like(knots), np.zeros_like(knots)
    for step in range(STEPS):
        share = step / STEPS
        width = _WIDTHS[0] * (_WIDTHS[1] / _WIDTHS[0]) ** share
        size = _MOVES[0] * (1.0 - share) + _MOVES[1]
        _, gradient = smooth.gradient(knots, width)
        mean = _FADE[0] * mean + (1.0 - _FADE[0]) * gradient
        square = _FADE[1] * square + (1.0 - _FADE[1]) * gradient**2
        now = mean / (1.0 - _FADE[0] ** (step + 1))
        usual = np.sqrt(square / (1.0 - _FADE[1] ** (step + 1)))
        move = np.divide(now, usual, out=np.zeros_like(now), where=usual > 0.0)
        knots = np.clip(knots + size * move, -1.0, 1.0)
        if not visit(step + 1, knots):
            break
