"""The best measure on a piece of the self-motion set."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from nullmotion.atlas.manifold_rotors import Rotors
from nullmotion.atlas.manifold_seeds import held

_WALKERS, _TRIES, _ROUNDS = 6, 8, 60
_FIRST, _LAST = 0.05, 1e-6  # rad; length of a try
_CLOSE = 1e-14  # momentum error over the mean momentum


class Best(NamedTuple):
    """The largest value of a measure, and gimbal angles that have it.

    Attributes:
        value: The measure, of A over the mean momentum.
        delta: Gimbal angles in [-pi, pi) [rad], (n,).
    """

    value: float
    delta: np.ndarray


def best(
    rotors: Rotors,
    points: np.ndarray,
    momentum: np.ndarray,
    measure: Callable[[np.ndarray], np.ndarray],
) -> Best:
    """Return the largest value of a measure near the best of angles (k, n) of one momentum.

    Random steps in the null space of A that shrink, each kept where the measure grows: it
    may have kinks, as sigma_min has where two singular values meet.
    """
    values = measure(points)
    order = np.argsort(-values)[:_WALKERS]
    here, value = points[order], values[order]
    rng = np.random.default_rng(0)
    for size in np.geomspace(_FIRST, _LAST, _ROUNDS):
        tries = np.repeat(here, _TRIES, axis=0)
        tries = held(rotors, tries + size * rng.normal(size=tries.shape), momentum, 4)
        good = np.abs(rotors.missing(tries, momentum)).max(axis=1) < _CLOSE
        found = np.where(good, measure(tries), -np.inf).reshape(len(here), _TRIES)
        winner = np.argmax(found, axis=1)
        rows = np.arange(len(here))
        better = found[rows, winner] > value
        tries = tries.reshape(len(here), _TRIES, -1)
        here = np.where(better[:, None], tries[rows, winner], here)
        value = np.where(better, found[rows, winner], value)
    top = int(np.argmax(value))
    return Best(float(value[top]), (here[top] + np.pi) % (2 * np.pi) - np.pi)
