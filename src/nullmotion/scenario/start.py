"""Gimbal angles at the start of a run: given, of a momentum, or the layout's home."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from nullmotion.array import CmgArray
from nullmotion.errors import InputError
from nullmotion.scenario import inverse, objects
from nullmotion.scenario.schema import ArraySection, InitialSection


def angles(section: ArraySection, initial: InitialSection, array: CmgArray) -> np.ndarray:
    """Return the start angles of the working CMGs [rad], (n,).

    Raises:
        InputError: For a momentum outside the envelope.
    """
    if initial.momentum_Nms is None:
        return objects.start(section, initial.gimbal_deg, array.n)
    found, most = _of_momentum(section, initial.momentum_Nms)
    if found is None:
        size = float(np.linalg.norm(initial.momentum_Nms))
        allowed = f"at most {most:.4g} N m s in this direction (this is {size:.4g} N m s)"
        raise InputError("initial.momentum_Nms", initial.momentum_Nms, allowed)
    return found.copy()


@lru_cache(maxsize=256)
def _of_momentum(
    section: ArraySection, momentum: tuple[float, ...]
) -> tuple[np.ndarray | None, float]:
    """Return the angles with a momentum, or None and the momentum that is reached."""
    array = objects.array(section)
    home = objects.start(section, None, array.n)
    wanted = np.array(momentum, float)
    found = inverse.angles_with_momentum(array, wanted, home)
    return found, 0.0 if found is not None else inverse.reach(array, wanted, home)
