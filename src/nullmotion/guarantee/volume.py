"""How much momentum has a torque capability."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.stats import qmc

from nullmotion.errors import InputError
from nullmotion.guarantee.constraint import Constraint
from nullmotion.guarantee.evaluate import compiled

_SCRAMBLES = 8
_ROUGH = 2**17  # points that tell the box


class Volume(NamedTuple):
    """Volume of momenta with a torque capability, and its standard error."""

    value: float
    standard_error: float


def volume(
    constraint: Constraint, torque_capability: float, *, points: int = 2**20, seed: int = 0
) -> Volume:
    """Return the volume (area, with two components) of all momenta with TC at least as given.

    By scrambled Sobol points in the box around the envelope; the standard error is that of
    the mean over eight scrambles. With 0: the volume of the envelope.

    Raises:
        InputError: For a torque capability that is not a finite number from 0 on.
    """
    if not 0 <= torque_capability < np.inf:
        raise InputError("torque_capability", torque_capability, "a finite number from 0 on")
    function, m = compiled(constraint).capability, constraint.m
    level = max(torque_capability, np.nextafter(0.0, 1.0))

    def held(box: np.ndarray, count: int, seed: int) -> np.ndarray:
        unit = qmc.Sobol(m, seed=seed).random(count)
        h = box * (2 * unit - 1)
        return h[function(h) >= level]

    whole = np.full(m, constraint.reach)
    rough = held(whole, _ROUGH, seed)
    box = np.minimum(whole, 1.1 * np.abs(rough).max(axis=0, initial=1e-9))
    each = points // _SCRAMBLES
    counts = [len(held(box, each, seed + 1 + i)) for i in range(_SCRAMBLES)]
    found = np.prod(2 * box) * np.array(counts) / each
    return Volume(float(found.mean()), float(found.std(ddof=1) / np.sqrt(_SCRAMBLES)))
