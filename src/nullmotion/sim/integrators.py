"""One step of an ordinary differential equation, on floats or symbols.

A state is a tuple (positions, rest): the semi-implicit rule moves the rest with
the positions already moved.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

Rates = Callable[[Any, Any], tuple[Any, Any]]  # f(x, y) -> (x_dot, y_dot)


def euler(f: Rates, x: Any, y: Any, dt: Any) -> tuple[Any, Any]:
    """Explicit Euler, order 1: z + dt f(z)."""
    dx, dy = f(x, y)
    return x + dt * dx, y + dt * dy


def semi_implicit_euler(f: Rates, x: Any, y: Any, dt: Any) -> tuple[Any, Any]:
    """Semi-implicit Euler, order 1: x first, then y at the new x."""
    x = x + dt * f(x, y)[0]
    return x, y + dt * f(x, y)[1]


def rk4(f: Rates, x: Any, y: Any, dt: Any) -> tuple[Any, Any]:
    """Classical Runge-Kutta, order 4."""
    half, sixth = 0.5 * dt, dt / 6.0
    a, b = f(x, y)
    c, d = f(x + half * a, y + half * b)
    e, g = f(x + half * c, y + half * d)
    p, q = f(x + dt * e, y + dt * g)
    return x + sixth * (a + 2.0 * (c + e) + p), y + sixth * (b + 2.0 * (d + g) + q)


INTEGRATORS = {"euler": euler, "rk4": rk4, "semi-implicit-euler": semi_implicit_euler}
ORDER = {"euler": 1, "rk4": 4, "semi-implicit-euler": 1}
