"""Where the numbers in ``nullmotion/compile/elementary.py`` come from.

Prints the split constants and, for each function, the coefficients of the
polynomial of least maximal relative error (Remez exchange), rounded to doubles.
Then the compiled functions are measured against mpmath.

Run: python design/elementary_coefficients.py [points]
"""

from __future__ import annotations

import math
import random
import sys
from collections.abc import Callable, Iterator

import mpmath as mp
import numpy as np

mp.mp.dps = 60
Real = Callable[[mp.mpf], mp.mpf]


def remez(target: Real, weight: Real, count: int, low: mp.mpf, high: mp.mpf) -> list[mp.mpf]:
    """Return the ``count`` coefficients c that minimise max |weight (target - sum c_j x**j)|."""

    def spread(n: int) -> list[mp.mpf]:  # Chebyshev points, moved off the middle: a weight may vanish there
        angles = [mp.pi * (i + mp.mpf("0.53")) / n for i in range(n)]
        return [(low + high) / 2 - (high - low) / 2 * mp.cos(a) for a in angles]

    samples = {x: (target(x), weight(x)) for x in spread(40 * count)}
    points = spread(count + 1)
    for _ in range(12):
        values = [samples.get(x) or (target(x), weight(x)) for x in points]
        rows = [[x**j for j in range(count)] + [(-1) ** i / values[i][1]] for i, x in enumerate(points)]
        solution = list(mp.lu_solve(mp.matrix(rows), mp.matrix([t for t, _ in values])))
        extrema: list[tuple[mp.mpf, mp.mpf]] = []
        for x, (t, w) in samples.items():
            error = w * (t - mp.polyval(solution[-2::-1], x))
            if not extrema or error * extrema[-1][0] < 0:
                extrema.append((error, x))
            elif abs(error) > abs(extrema[-1][0]):
                extrema[-1] = (error, x)
        while len(extrema) > count + 1:
            extrema.pop(0 if abs(extrema[0][0]) < abs(extrema[-1][0]) else -1)
        worst = max(abs(error) for error, _ in extrema)
        if len(extrema) <= count or worst < abs(solution[-1]) * mp.mpf("1.001"):
            break
        points = [x for _, x in extrema]
    return solution[:-1]


def rounded(target: Real, weight: Real, count: int, low: float, high: float) -> tuple[list[float], float]:
    """Return double coefficients of 1, x, ..., x**(count - 1) and their greatest weighted error."""
    best = [float(c) for c in remez(target, weight, count, mp.mpf(low), mp.mpf(high))]
    grid = [low + (high - low) * (i + mp.mpf("0.53")) / 2000 for i in range(2000)]
    return best, float(max(abs(weight(x) * (target(x) - mp.polyval(best[::-1], x))) for x in grid))


def fits() -> Iterator[tuple[str, tuple[list[float], float]]]:
    """Fit every polynomial; the weight turns its error into the function's relative error."""
    quarter = math.pi**2 / 16 * (1 + 1e-9)

    def sine(z: mp.mpf) -> mp.mpf:  # sin r / r at z = -r*r
        return mp.sin(mp.sqrt(-z)) / mp.sqrt(-z)

    def cosine(z: mp.mpf) -> mp.mpf:
        return mp.cos(mp.sqrt(-z))

    yield "_SIN", rounded(lambda z: (sine(z) - 1) / z, lambda z: z / sine(z), 6, -quarter, 0)
    yield "_COS", rounded(lambda z: (cosine(z) - 1 - z / 2) / z**2, lambda z: z**2 / cosine(z), 6, -quarter, 0)

    half = math.log(2) / 2 * (1 + 1e-9)
    yield "_EXP", rounded(lambda r: (mp.expm1(r) - r) / r**2, lambda r: r**2 / mp.exp(r), 10, -half, half)

    def atanh(z: mp.mpf) -> mp.mpf:  # log((1 + s) / (1 - s)) / s at z = s*s
        return 2 * mp.atanh(mp.sqrt(z)) / mp.sqrt(z)

    edge = ((math.sqrt(2) - 1) / (math.sqrt(2) + 1)) ** 2 * (1 + 1e-9)
    yield "_LOG", rounded(lambda z: (atanh(z) - 2) / z, lambda z: z / atanh(z), 7, 0, edge)

    def atan(z: mp.mpf) -> mp.mpf:
        return mp.atan(mp.sqrt(z)) / mp.sqrt(z)

    def asin(z: mp.mpf) -> mp.mpf:
        return mp.asin(mp.sqrt(z)) / mp.sqrt(z)

    yield "_ATAN", rounded(lambda z: (atan(z) - 1) / z, lambda z: z / atan(z), 13, 0, 0.25)
    yield "_ASIN", rounded(lambda z: (asin(z) - 1) / z, lambda z: z / asin(z), 12, 0, 0.25)


def split(value: mp.mpf, *bits: int) -> list[float]:
    """Return doubles of the given numbers of bits that add up to the value, the last one rounded."""
    parts = []
    for count in bits[:-1]:
        scale = mp.mpf(2) ** (count - 1 - mp.floor(mp.log(abs(value), 2)))
        parts.append(float(mp.floor(value * scale) / scale))
        value -= parts[-1]
    return [*parts, float(value)]
