"""The plane that gimbals are kept outside of (Pereira 2022, Eqs 28, 29, 39, 40).

gamma_s is the singular configuration nearest to gamma, d their distance, n = (gamma - gamma_s)/d.
The plane at gamma_p = gamma_s + kappa n keeps a later gamma+ outside when

    eta = (gamma+ - gamma_p) . (gamma_s - gamma_p) = kappa (kappa - n . (gamma+ - gamma_s)) <= 0.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from nullmotion import singular_lines, singularity
from nullmotion.array.model import CmgArray

_ON_IT = 1e-9  # rad; nearer than this, gamma - gamma_s has no direction


class Exclusion(NamedTuple):
    """Where the nearest singular configuration lies.

    Attributes:
        distance: d [rad].
        normal: n, (n,).
    """

    distance: float
    normal: np.ndarray


def exclusion(array: CmgArray, delta: Any, before: Any, line: Any = None) -> Exclusion:
    """Return the exclusion at gimbal angles (n,) [rad].

    Args:
        array: The array; that of parallel gimbal axes exactly, any other by a search.
        delta: Gimbal angles [rad], (n,).
        before: The normal of the sample before, which is kept at a singular configuration.
        line: Square of the distance and delta - delta_s, where they are known already.
    """
    if line is not None:
        distance, offset = float(np.sqrt(line[0])), line[1]
    else:
        planar = singular_lines.lies_in_a_plane(array)
        found = (singular_lines if planar else singularity).nearest(array, delta)
        distance, offset = float(found.distance), np.asarray(delta) - found.delta_s
    if distance < _ON_IT:
        return Exclusion(distance, np.array(before, float))
    return Exclusion(distance, offset / distance)
