"""Where the constants of ``elementary.h`` come from: near-minimax fits in 60-digit arithmetic.

sin r = r + r z S(z), cos r = 1 - z/2 + z^2 C(z), exp r = 1 + r + r^2 E(r), with z = r^2,
|r| <= pi/4 for sin and cos and |r| <= ln(2)/2 for exp. Run it to print the C arrays.
"""

from __future__ import annotations

import mpmath as mp

mp.mp.dps = 60
Z_MAX = (mp.pi / 4) ** 2 * 1.0001
R_MAX = mp.log(2) / 2 * 1.0001


def sin_tail(z: mp.mpf) -> mp.mpf:
    """S(z) = (sin r / r - 1) / z, by its series near zero."""
    return mp.nsum(lambda k: (-1) ** (k + 1) * z**k / mp.factorial(2 * k + 3), [0, 20])


def cos_tail(z: mp.mpf) -> mp.mpf:
    """C(z) = (cos r - 1 + z/2) / z^2, by its series near zero."""
    return mp.nsum(lambda k: (-1) ** k * z**k / mp.factorial(2 * k + 4), [0, 20])


def exp_tail(r: mp.mpf) -> mp.mpf:
    """E(r) = (exp r - 1 - r) / r^2, by its series near zero."""
    return mp.nsum(lambda k: r**k / mp.factorial(k + 2), [0, 30])


def split(value: mp.mpf, parts: int) -> list[float]:
    """``value`` as a sum of doubles, largest first (Cody and Waite)."""
    out: list[float] = []
    for _ in range(parts):
        out.append(float(value - sum(mp.mpf(x) for x in out)))
    return out


def main() -> None:
    """Print every constant as a hexadecimal float."""
    fits = {
        "SIN": (sin_tail, [0, Z_MAX], 6),
        "COS": (cos_tail, [0, Z_MAX], 6),
        "EXP": (exp_tail, [-R_MAX, R_MAX], 10),
    }
    for name, (function, interval, count) in fits.items():
        coefficients, error = mp.chebyfit(function, interval, count, error=True)
        print(name, "error of the tail", mp.nstr(error, 3))
        print("  ", ", ".join(float(c).hex() for c in reversed(coefficients)))
    print("PI_2", [x.hex() for x in split(mp.pi / 2, 3)])
    print("LN2", [x.hex() for x in split(mp.log(2), 2)])


if __name__ == "__main__":
    main()
