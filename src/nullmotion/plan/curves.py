"""Courses that a search for knots of any value begins with."""

from __future__ import annotations

import numpy as np


def resample(knots: np.ndarray, length: int, steps: int) -> np.ndarray:
    """Return courses of another length that come near to one, (2, length).

    One takes the curve's values at the new knots, the other is the nearest in the mean
    square over the samples.
    """
    place = np.arange(steps) / steps
    old, new = np.linspace(0.0, 1.0, len(knots)), np.linspace(0.0, 1.0, length)
    hats = np.array([np.interp(place, new, unit) for unit in np.eye(length)]).T
    curve = np.interp(place, old, knots)
    nearest = np.linalg.lstsq(hats, curve, rcond=None)[0]
    return np.array([np.interp(new, old, knots), np.clip(nearest, -1.0, 1.0)])


def shaken(knots: np.ndarray, sigma: float, rng: np.random.Generator) -> np.ndarray:
    """Return a course with every knot changed at random."""
    changed: np.ndarray = np.clip(knots + sigma * rng.standard_normal(len(knots)), -1.0, 1.0)
    return changed


def random_curve(length: int, rng: np.random.Generator) -> np.ndarray:
    """Return the line through a few random knots, from two up to ``length``."""
    few = rng.uniform(-1.0, 1.0, rng.integers(2, length + 1) if length > 1 else 1)
    return np.interp(np.linspace(0.0, 1.0, length), np.linspace(0.0, 1.0, len(few)), few)
