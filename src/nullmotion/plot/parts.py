"""Curves and lines that charts have in common."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from nullmotion.plot import palette
from nullmotion.plot.view import Curve, Level, Panel

NEAR_LIMIT = 0.2  # share of a limit from which its line leaves room for the curves


def limited(panel: Panel, limits: Sequence[float], unit: str) -> Panel:
    """Return a chart with the lines of limits on both sides; a limit far off is said, not drawn."""
    values = np.concatenate([[0.0], *(curve.y for curve in panel.curves)])
    low, high = np.nanmin(values), np.nanmax(values)
    levels, far = list(panel.levels), []
    for limit in limits:
        words = f"limit {limit:.4g} {unit}"
        if max(high, -low) < NEAR_LIMIT * limit:
            far.append(words)
            continue
        levels.append(Level(limit, words))
        if low < -NEAR_LIMIT * limit:
            levels.append(Level(-limit, ""))
    note = f"Far below the {', '.join(far)}." if far else panel.note
    return replace(panel, levels=tuple(levels), note=note)


def bundle(x: np.ndarray, columns: np.ndarray, labels: Sequence[str]) -> tuple[Curve, ...]:
    """Return one curve a column, each with its own colour and dash."""
    return tuple(
        Curve(label, x, columns[:, i], palette.colour(i), palette.dash(i))
        for i, label in enumerate(labels)
    )


def with_norm(x: np.ndarray, columns: np.ndarray, labels: Sequence[str]) -> tuple[Curve, ...]:
    """Return one curve a component of a vector, and one for its length."""
    norm = np.linalg.norm(columns, axis=1)
    whole = Curve("norm", x, norm, palette.INK, width=2.4)
    return (*bundle(x, columns, labels), whole)
