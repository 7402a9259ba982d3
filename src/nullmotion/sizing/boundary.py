"""The least of a quantity at which something holds from there on up, for many lanes at once."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

Holds = Callable[[np.ndarray, np.ndarray], np.ndarray]
_UPWARDS = 6


def least(
    holds: Holds,
    start: np.ndarray,
    factor: float,
    tolerance: float,
    floor: float = 0.0,
) -> np.ndarray:
    """Return the least values at which ``holds`` is true, to a relative tolerance, (lanes,).

    From the start it goes down by steps while they hold, and halves the step that does not:
    what holds far below, beyond values that do not, is not found. A start that does not
    hold is raised by up to six steps.

    Args:
        holds: Takes values and the numbers of the lanes they are for; returns a truth for each.
        start: Values to start from, better too large than too small, (lanes,).
        factor: Ratio of one step to the next, above 1.
        tolerance: The value returned holds; one smaller by this share does not.
        floor: No value is tried below it: it is returned where it holds.

    Returns:
        Values; infinite where none is found.
    """
    high = np.maximum(start, floor)
    low = np.zeros(len(high))
    found = _upwards(holds, low, high, factor)
    _downwards(holds, low, high, found & (low == 0.0), factor, floor)
    while True:
        lanes = np.flatnonzero(found & (low > 0.0) & (high > low * (1.0 + tolerance)))
        if not len(lanes):
            return np.where(found, high, np.inf)
        middle = np.sqrt(low[lanes] * high[lanes])
        good = holds(middle, lanes)
        high[lanes[good]], low[lanes[~good]] = middle[good], middle[~good]


def _upwards(holds: Holds, low: np.ndarray, high: np.ndarray, factor: float) -> np.ndarray:
    """Raise values that do not hold; return which do in the end."""
    found = holds(high, np.arange(len(high)))
    for _ in range(_UPWARDS):
        lanes = np.flatnonzero(~found)
        if not len(lanes):
            break
        low[lanes], high[lanes] = high[lanes], high[lanes] * factor
        found[lanes] = holds(high[lanes], lanes)
    return found


def _downwards(
    holds: Holds, low: np.ndarray, high: np.ndarray, going: np.ndarray, factor: float, floor: float
) -> None:
    """Lower values by steps until one does not hold, which is then the lower end."""
    lanes = np.flatnonzero(going & (high > floor))
    while len(lanes):
        tried = np.maximum(high[lanes] / factor, floor)
        good = holds(tried, lanes)
        low[lanes[~good]], high[lanes[good]] = tried[~good], tried[good]
        lanes = lanes[good & (tried > floor)]
