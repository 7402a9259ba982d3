"""Random numbers inside traced source: L'Ecuyer's generator MRG32k3a on doubles.

    x_n = (1403580 x_{n-2} - 810728 x_{n-3})  mod m1,    m1 = 2^32 - 209
    y_n = ( 527612 y_{n-1} - 1370589 y_{n-3}) mod m2,    m2 = 2^32 - 22853
    u_n = ((x_n - y_n) mod m1) / (m1 + 1),    m1 where x_n = y_n; period 2^191

Every product and difference is a whole number below 2^53, so doubles hold it exactly and
floats, kernels and C, fused or not, draw the same numbers. Normal deviates differ in the
last places, as the logarithms and sines of the targets do.

Source: L'Ecuyer, Operations Research 47 (1999), 159-164.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from nullmotion import ops
from nullmotion.compile.tape import product, unguarded
from nullmotion.errors import InputError

M1, M2 = 4294967087.0, 4294944443.0


def seeded(seed: int, stream: int = 0) -> np.ndarray:
    """Return a state to start from, (6,); every seed and stream has its own.

    Raises:
        InputError: Unless both are whole numbers from 0.
    """
    for key, value in (("seed", seed), ("stream", stream)):
        whole = isinstance(value, (int, np.integer)) and not isinstance(value, bool)
        if not whole or value < 0:
            raise InputError(key, value, "a whole number from 0")
    words = np.random.SeedSequence(int(seed), spawn_key=(int(stream),)).generate_state(6, np.uint64)
    greatest = np.array([M1, M1, M1, M2, M2, M2]).astype(np.uint64) - np.uint64(1)
    return (words % greatest + np.uint64(1)).astype(float)  # never zero: all zeros stay zeros


def uniform(state: Any) -> tuple[Any, Any]:
    """Return a number of the open interval (0, 1) and the next state, (6,)."""
    x = _modulo(1403580.0 * state[1] - 810728.0 * state[0], M1)
    y = _modulo(527612.0 * state[5] - 1370589.0 * state[3], M2)
    less = x - y
    less = ops.where(ops.less(0.0, less), less, less + M1)
    after = np.array([state[1], state[2], x, state[4], state[5], y])
    return product(less, 1.0 / (M1 + 1.0)), after  # rounded by itself, whatever uses it


def normals(state: Any, count: int) -> tuple[Any, Any]:
    """Return independent standard normal deviates, (count,), and the next state.

    Box and Muller: sqrt(-2 ln u) (cos 2 pi v, sin 2 pi v). None exceeds 6.7.
    """
    values: list[Any] = []
    for _ in range(0, count, 2):
        u, state = uniform(state)
        v, state = uniform(state)
        radius, angle = ops.sqrt(-2.0 * ops.log(u)), 2.0 * np.pi * v
        with unguarded():  # the angle is one of a turn
            values += [radius * ops.cos(angle), radius * ops.sin(angle)]
    return np.array(values[:count]), state


def _modulo(p: Any, m: float) -> Any:
    """Return p mod m in [0, m) of a whole number |p| < 2^53.

    The quotient is rounded to the nearest, give or take one unit at a half: what is left is
    exact and not beyond m/2 + 2.
    """
    rest = p - ops.rint(p * (1.0 / m)) * m
    return ops.where(ops.less(rest, 0.0), rest + m, rest)
