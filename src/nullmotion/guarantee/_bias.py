"""Even polynomials that bias planes of CMGs against each other, and their coefficients."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from nullmotion import ops
from nullmotion.errors import InputError

Term = tuple[int, int, int, float]  # powers of X, Y, Z and the coefficient


def even_polynomial(coefficients: Sequence[float], x: Any) -> tuple[Any, Any]:
    """Return sum_k p_k x^(2k), k = 1, 2, ..., and its derivative; source."""
    square = x * x
    value, slope = 0.0, 0.0
    for k in range(len(coefficients), 0, -1):
        p = coefficients[k - 1]
        value = (value + p) * square
        slope = slope * square + 2.0 * k * p
    return value, slope * x


def even_terms(terms: Sequence[Term], extent: float, h: Any) -> tuple[Any, Any]:
    """Return sum c X^i Y^j Z^k with X = (h_x/extent)^2 and so on, and its gradient; source."""
    return _terms(terms, *_squares(extent, h))


def tilted_terms(terms: Sequence[Term], extent: float, h: Any) -> tuple[Any, Any]:
    """Return sum c x^i Y^j Z^k with x = h_x/extent, Y = (h_y/extent)^2, ...; source."""
    bases, steps = _squares(extent, h)
    bases[0], steps[0] = h[0] * (1.0 / extent), 1.0 / extent
    return _terms(terms, bases, steps)


def _squares(extent: float, h: Any) -> tuple[list[Any], list[Any]]:
    """Return (h_i/extent)^2 and their derivatives."""
    return [(c * c) * (1.0 / extent**2) for c in h], [2.0 / extent**2 * c for c in h]


def _terms(terms: Sequence[Term], bases: list[Any], steps: list[Any]) -> tuple[Any, Any]:
    """Return a polynomial in three variables and its gradient, their derivatives being steps."""
    value: Any = 0.0
    slopes: list[Any] = [0.0, 0.0, 0.0]
    for *powers, c in terms:
        factors = [ops.power(s, p) if p else 1.0 for s, p in zip(bases, powers, strict=True)]
        value = value + c * (factors[0] * (factors[1] * factors[2]))
        for axis in range(3):
            p = powers[axis]
            if p:
                lowered = ops.power(bases[axis], p - 1) if p > 1 else 1.0
                others = factors[(axis + 1) % 3] * factors[(axis + 2) % 3]
                slopes[axis] = slopes[axis] + c * p * (lowered * others)
    return value, np.array([step * slope for step, slope in zip(steps, slopes, strict=True)])


def checked_coefficients(record: Any, key: str) -> None:
    """Make a field a tuple of finite floats."""
    given = getattr(record, key)
    try:
        values = tuple(float(v) for v in given)
    except (TypeError, ValueError):
        values = (np.nan,)
    if not np.isfinite(values).all():
        raise InputError(f"constraint.{key}", given, "finite numbers")
    object.__setattr__(record, key, values)


def checked_terms(record: Any, key: str) -> None:
    """Make a field a tuple of (i, j, k, coefficient)."""
    given = getattr(record, key)
    try:
        terms = tuple((int(i), int(j), int(k), float(c)) for i, j, k, c in given)
        good = all(min(t[:3]) >= 0 and np.isfinite(t[3]) for t in terms) and len(terms) > 0
    except (TypeError, ValueError):
        good, terms = False, ()
    if not good:
        raise InputError(f"constraint.{key}", given, "rows of three powers from 0 and a number")
    object.__setattr__(record, key, terms)
