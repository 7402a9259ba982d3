"""The planar constraint functions of Elliott 2019 letter by letter, Eqs 22-48.

`nullmotion.guarantee` has them in one form for every n; here they stand as printed, with
the misprints, so that what is said of them can be checked.
"""

from __future__ import annotations

import math
from typing import Literal

import numpy as np

K4 = Literal["floor", "ceil"]


def critical_momentum(n: int) -> float:
    """Return H_c by Eqs 22, 34, 42 and 48."""
    if n % 2 == 0:
        return n / math.sqrt(2)
    return 1 + math.sqrt({5: 6.0, 7: 15.0}.get(n, (n - 1) * (n - 2) / 2))


def critical_momentum_in_summary(n: int) -> float:
    """Return H_c of odd n by Eq 23."""
    return 1 + math.sqrt((n - 1) * (n - 2)) / 2


def angles(n: int, H: float, k4: K4 = "floor") -> np.ndarray:
    """Return gimbal angles at a momentum (H, 0) [rad], (n,).

    Args:
        n: Number of CMGs.
        H: Momentum, from 0 to n.
        k4: How the index k_4 = k_3 + (n - 1)/4 of Eq 46 is rounded; ``floor`` is printed.
    """
    if critical_momentum(n) <= H:
        odd = n % 2
        equal = [math.acos((H - odd) / (n - odd))] * (n // 2)
        return np.array([*equal, *[0.0] * odd, *(-a for a in equal)])
    if n % 2 == 0:
        return _even(n, H)
    if n == 5:
        return _five(H)
    return _seven(H) if n == 7 else _odd(n, H, k4)


def _even(n: int, H: float) -> np.ndarray:
    """Eqs 24-27; k_2 takes n/4 of the angles between n/2 and n, rounded up."""
    k1, k2 = n // 4, n // 2 + math.ceil(n / 4)
    root = math.sqrt(k1 * (n - 2 * k1) * (-2 * H**2 + n**2))
    first = math.acos(H / n - root / (2 * n * k1))
    second = math.acos(H / n + root / (n * (n - 2 * k1)))
    sizes = (k1, n // 2 - k1, k2 - n // 2, n - k2)
    return np.repeat([first, second, -second, -first], sizes)


def _five(H: float) -> np.ndarray:
    """Eqs 29-33."""
    root = math.sqrt(-(H**2) + 2 * H + 5)
    first, second = math.acos((H - 1 - root) / 4), math.acos((H - 1 + root) / 4)
    return np.array([first, second, 0.0, -second, -first])


def _seven(H: float) -> np.ndarray:
    """Eqs 35-41."""
    root, x = math.sqrt(-(H**2) / 2 + 7 + H), (H - 1) / 6
    factors = (-5 / (6 * math.sqrt(7)), 1 / (6 * math.sqrt(7)), 2 / (3 * math.sqrt(7)))
    first, second, third = (math.acos(x + f * root) for f in factors)
    return np.array([first, second, third, 0.0, -third, -second, -first])


def _odd(n: int, H: float, k4: K4) -> np.ndarray:
    """Eqs 43-47."""
    k1, k2 = (n - 1) // 4, (n - 1) // 2
    fourth = k2 + 1 + (math.floor if k4 == "floor" else math.ceil)((n - 1) / 4)
    root = math.sqrt(k1 * (n - 2 * k1 - 1) * (-2 * H**2 + 4 * H + n * (n - 3)))
    first = math.acos((H - 1) / (n - 1) - root / (2 * k1 * (n - 1)))
    second = math.acos((H - 1) / (n - 1) + root / ((n - 1 - 2 * k1) * (n - 1)))
    sizes = (k1, k2 - k1, 1, fourth - k2 - 1, n - fourth)
    return np.repeat([first, second, 0.0, -second, -first], sizes)
