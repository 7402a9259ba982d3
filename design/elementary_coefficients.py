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

    def spread(n: int) -> list[mp.mpf]:
        # Chebyshev points, moved off the middle, where a weight may vanish
        angles = [mp.pi * (i + mp.mpf("0.53")) / n for i in range(n)]
        return [(low + high) / 2 - (high - low) / 2 * mp.cos(a) for a in angles]

    samples = {x: (target(x), weight(x)) for x in spread(40 * count)}
    points = spread(count + 1)
    for _ in range(12):
        levels = [(-1) ** i / weight(x) for i, x in enumerate(points)]
        rows = [[x**j for j in range(count)] + [e] for x, e in zip(points, levels, strict=True)]
        solution = list(mp.lu_solve(mp.matrix(rows), mp.matrix([target(x) for x in points])))
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


Fit = tuple[list[float], float]


def rounded(target: Real, weight: Real, count: int, low: float, high: float) -> Fit:
    """Return double coefficients of 1, x, ..., x**(count - 1) and their greatest weighted error."""
    best = [float(c) for c in remez(target, weight, count, mp.mpf(low), mp.mpf(high))]
    grid = [low + (high - low) * (i + mp.mpf("0.53")) / 2000 for i in range(2000)]
    return best, float(max(abs(weight(x) * (target(x) - mp.polyval(best[::-1], x))) for x in grid))


def fits() -> Iterator[tuple[str, Fit]]:
    """Fit every polynomial; the weight turns its error into the function's relative error."""
    quarter = math.pi**2 / 16 * (1 + 1e-9)

    def sine(z: mp.mpf) -> mp.mpf:  # sin r / r at z = -r*r
        return mp.sin(mp.sqrt(-z)) / mp.sqrt(-z)

    def cosine(z: mp.mpf) -> mp.mpf:
        return mp.cos(mp.sqrt(-z))

    yield "_SIN", rounded(lambda z: (sine(z) - 1) / z, lambda z: z / sine(z), 6, -quarter, 0)

    def cosine_rest(z: mp.mpf) -> mp.mpf:
        return (cosine(z) - 1 - z / 2) / z**2

    yield "_COS", rounded(cosine_rest, lambda z: z**2 / cosine(z), 6, -quarter, 0)

    half = math.log(2) / 2 * (1 + 1e-9)

    def exp_rest(r: mp.mpf) -> mp.mpf:
        return (mp.expm1(r) - r) / r**2

    yield "_EXP", rounded(exp_rest, lambda r: r**2 / mp.exp(r), 10, -half, half)

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
    """Return doubles of the given numbers of bits that add up to the value, the last rounded."""
    parts = []
    for count in bits[:-1]:
        scale = mp.mpf(2) ** (count - 1 - mp.floor(mp.log(abs(value), 2)))
        parts.append(float(mp.floor(value * scale) / scale))
        value -= parts[-1]
    return [*parts, float(value)]


def hard_points(name: str, count: int, draw: random.Random) -> list[tuple[float, ...]]:
    """Return arguments where errors are largest, and a spread over the whole range."""
    signs = (-1.0, 1.0)

    def log_uniform(low: float, high: float) -> float:
        return draw.choice(signs) * 2.0 ** draw.uniform(low, high)

    if name in ("sin", "cos"):
        near = [float(draw.randrange(1, 63662) * mp.pi / 2) for _ in range(count)]
        near += [draw.uniform(0.7, 0.8) + draw.randrange(8) * math.pi / 2 for _ in range(count)]
        return [(x,) for x in near] + [(draw.uniform(-1e5, 1e5),) for _ in near]
    if name == "exp":
        near = [draw.uniform(-0.4, 0.4) for _ in range(count)]
        return [(x,) for x in near] + [(draw.uniform(-746.0, 709.7),) for _ in near]
    if name == "log":
        near = [draw.uniform(0.6, 1.6) for _ in range(count)]
        near += [1.0 + log_uniform(-52, -2) for _ in range(count)]
        return [(x,) for x in near] + [(abs(log_uniform(-1074, 1023)),) for _ in near]
    if name == "acos":
        near = [draw.choice(signs) * (1.0 - abs(log_uniform(-53, -1))) for _ in range(count)]
        return [(x,) for x in near] + [(draw.uniform(-1.0, 1.0),) for _ in near]
    if name == "rsqrt":
        near = [draw.uniform(1.0, 4.0) for _ in range(count)]
        return [(x,) for x in near] + [(abs(log_uniform(-1022, 1023)),) for _ in near]
    near = [(log_uniform(-1, 0), log_uniform(0, 1)) for _ in range(count)]
    return near + [(log_uniform(-1074, 1023), log_uniform(-1074, 1023)) for _ in near]


def ulps(exact: mp.mpf, value: float) -> float:
    """Return the error of a value in units in the last place of the exact result."""
    place = max(mp.frexp(exact)[1] - 53, -1074)
    return float(abs(value - exact) / mp.mpf(2) ** place)


def measure(count: int) -> None:
    """Print operation counts and the worst error found of each compiled function."""
    from nullmotion.compile import compile_function, elementary
    from nullmotion.compile.tape import rsqrt_guess

    draw = random.Random(1)
    for name in ("sin", "cos", "exp", "log", "acos", "rsqrt", "atan2"):
        points = hard_points(name, count, draw)
        compiled = compile_function(getattr(elementary, name), *points[0])
        values = compiled(*np.array(points).T)
        exact = (getattr(mp, name)(*p) if name != "rsqrt" else 1 / mp.sqrt(*p) for p in points)
        errors = [ulps(e, v) for e, v in zip(exact, values.tolist(), strict=True)]
        worst, where = max(zip(errors, points, strict=True))
        print(f"{name:6s} {compiled.program.operations} operations, {worst:.3f} ulp at {where}")
    both = compile_function(lambda x: (elementary.sin(x), elementary.cos(x)), 1.0)
    print(f"sin and cos together {both.program.operations} operations")
    x = np.linspace(1.0, 4.0, 100_001)
    guess = rsqrt_guess(x) * np.sqrt(x) - 1.0
    rough = compile_function(lambda v: elementary.rsqrt(v, rough=True), 1.0)(x) * np.sqrt(x) - 1.0
    print(f"rsqrt: guess within {abs(guess).max():.4f}, rough within {abs(rough).max():.1e}")


def binomial(count: int) -> list[float]:
    """Return coefficients of e, e**2, ... in (1 - e)**(-1/2): the step from a guess of a root."""
    return [float(mp.binomial(2 * k, k) / 4**k) for k in range(1, count + 1)]


def main() -> None:
    """Print everything."""
    splits = {
        "_PI_2": split(mp.pi / 2, 53, 33, 53),
        "_PI_4": split(mp.pi / 4, 50, 53),
        "_LN2": split(mp.log(2), 42, 53),
    }
    for name, parts in splits.items():
        print(f"{name} = {tuple(parts)}")
    for name, (coefficients, error) in fits():
        print(f"{name} = (  # relative error of the function {error:.1e}")
        print("".join(f"    {c!r},\n" for c in coefficients) + ")")
    print(f"_RSQRT = {tuple(binomial(4))}")
    closest = min((abs(float(k * mp.pi / 2) - k * mp.pi / 2), k) for k in range(1, 63662))
    print(f"nearest double to a multiple of pi/2: {float(closest[0]):.2e} from {closest[1]} pi/2")
    measure(int(sys.argv[1]) if len(sys.argv) > 1 else 20000)


if __name__ == "__main__":
    main()
