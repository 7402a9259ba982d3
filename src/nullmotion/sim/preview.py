"""The command over the coming samples, for laws that look ahead and run in Python.

A schedule is known; under a controller the coming commands are those that it would give if
array and wheel gave what they are asked for (Pereira 2022, Eq 41):

    q_dot = 1/2 q * [0, omega],  J omega_dot = -omega x (J omega + h) - hdot_c,  h_dot = hdot_c

with hdot_c held over each sample, from the measured state. Torques from outside are not
foreseen.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from nullmotion import linalg, rotation
from nullmotion.sim.setup import Setup
from nullmotion.spacecraft import Spacecraft


def wanted(setup: Setup) -> int:
    """Return how many samples of the command the law looks at; 0 if none."""
    ahead = "preview" in setup.law.information and not setup.law.traceable
    return setup.law.preview_samples if ahead else 0


def rows(setup: Setup, k: Any, count: int) -> np.ndarray:
    """Return the rows of the schedule from step k on, the last one held, (count, width)."""
    first = int(k) // setup.period_steps
    table = setup.table
    found: np.ndarray = table[np.minimum(first + np.arange(count), len(table) - 1)]
    if setup.reference is not None:  # at rest beyond its end, as a run has it
        found = found.copy()
        found[first + np.arange(count) >= len(table), 4:] = 0.0
    return found


def moved(
    craft: Spacecraft, q: Any, omega: Any, momentum: Any, hdot: Any, period: float
) -> tuple[Any, Any]:
    """Return attitude and body rate after a sample in which hdot is given, by one RK4 step."""
    inverse, half = craft.inverse_inertia, 0.5 * period

    def slope(q: Any, omega: Any, since: float) -> tuple[Any, Any]:
        total = craft.inertia @ omega
        if craft.momentum_coupling:
            total = total + momentum + since * hdot
        turning = inverse @ (-linalg.cross(omega, total) - hdot)
        return 0.5 * rotation.doubled_rate(q, omega), turning

    a = slope(q, omega, 0.0)
    b = slope(q + half * a[0], omega + half * a[1], half)
    c = slope(q + half * b[0], omega + half * b[1], half)
    d = slope(q + period * c[0], omega + period * c[1], period)
    mean = [(x + 2.0 * (y + z) + w) / 6.0 for x, y, z, w in zip(a, b, c, d, strict=True)]
    return rotation.normalised(q + period * mean[0]), omega + period * mean[1]
