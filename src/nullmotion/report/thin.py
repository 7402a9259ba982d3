"""Fewer points for the same picture."""

from __future__ import annotations

import numpy as np


def thinned(x: np.ndarray, y: np.ndarray, most: int) -> tuple[np.ndarray, np.ndarray]:
    """Return at most about ``most`` points of a curve that keep its ends and extremes.

    The curve is cut into stretches of equal length; of each stay the first point, the
    least and the largest finite value, and one gap if there is one.

    Args:
        x: Abscissa, (k,).
        y: Ordinate, (k,).
        most: Points to keep, at least 8.
    """
    k = len(y)
    if k <= most:
        return x, y
    length = -(-k // (most // 4))
    rows = -(-k // length)
    padded = np.concatenate([y, np.full(rows * length - k, y[-1])]).reshape(rows, length)
    finite = np.isfinite(padded)
    starts = np.arange(rows) * length
    low = starts + np.where(finite, padded, np.inf).argmin(axis=1)
    high = starts + np.where(finite, padded, -np.inf).argmax(axis=1)
    gaps = starts + finite.argmin(axis=1)  # the first gap, or the first point again
    keep = np.zeros(rows * length, bool)
    for picked in (starts, low, high, gaps, k - 1):
        keep[picked] = True
    return x[keep[:k]], y[keep[:k]]
