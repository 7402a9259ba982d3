"""Closed forms of Elliott 2019 whose values can be had by another way."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import partial

import numpy as np

from nullmotion.array import layouts
from nullmotion.guarantee.constraints.box90_cubic import Box90Cubic
from nullmotion.guarantee.constraints.planar import Planar
from nullmotion.papers import elliott2019_printed as printed
from nullmotion.papers.base import Cell
from nullmotion.papers.elliott2019_planar import along

EXACT = 1e-9  # rounding of different linear algebra libraries
_row = partial(Cell, "equations")
_SIZES = (4, 5, 6, 7, 8, 9, 11)
_EQUATION = {5: 34, 7: 42, 9: 48, 11: 48}
_NAMES = {5: "Eqs 29-33", 7: "Eqs 35-41", 9: "Eqs 43-47", 11: "Eqs 43-47"}

_EQ_23 = "Eq 23 divides the root by 2; in Eqs 34, 42 and 48 the 2 stands under it"
_FLOOR = "rounded down as printed, k_4 gives a CMG of one group the angle of the other"
_JUMP = "greatest change of a gimbal angle [rad] from H_c (1 - 1e-12) to H_c"
_BOUND = "not printed: n/m, the bound of every linear right inverse, which the printed b reaches"
_EVEN = "P is even in H_x: Psi is +2 at both ends"
_EQ_59 = "torque given over commanded for h = 2: Eqs 10 and 12 divide T by h, Eqs 59 and 130 do not"


def cells() -> Iterator[Cell]:
    """Return the closed forms of Chapters 3 and 4."""
    yield from _critical()
    yield from _regions()
    yield from _held()
    yield from _bias()
    yield from _start()
    yield from _gradient()


def _critical() -> Iterator[Cell]:
    for n in _SIZES:
        value, found = printed.critical_momentum(n), region_end(n)
        row = f"Eq {_EQUATION.get(n, 28)}, n = {n}"
        yield _row(row, "critical_momentum", value, found, EXACT)
        if n % 2:
            row, value = f"Eq 23, n = {n}", printed.critical_momentum_in_summary(n)
            yield _row(row, "critical_momentum", value, found, EXACT, note=_EQ_23)


def region_end(n: int) -> float:
    """Return the momentum at which sum cos^2 = n/2 with all CMGs but an odd one at +-delta."""
    from scipy.optimize import brentq

    odd = n % 2
    return float(brentq(lambda H: odd + (H - odd) ** 2 / (n - odd) - n / 2, odd, n, xtol=1e-13))


def _regions() -> Iterator[Cell]:
    for n in _SIZES:
        end = printed.critical_momentum(n)
        rows, det = _measured(n, np.linspace(0.0, end, 200, endpoint=False))
        row = f"static region, n = {n}"
        yield _row(row, "row_norm_of_W", 2 / n, _farthest(2 / n, rows), EXACT)
        yield _row(row, "det_JJT", n * n / 4, _farthest(n * n / 4, det), EXACT)
        H = np.linspace(end, 0.99 * n, 200)
        rows, det = _measured(n, H)
        row, falls = f"declining region, n = {n}", "yes" if (np.diff(det) < 0).all() else "no"
        yield _row(row, "det_JJT_falls", "yes", falls)
        if n % 2 == 0:
            share = _farthest(1.0, rows * (H * np.sqrt(n * n - H * H) / n)[:, None])
            yield _row(row, "row_norm_of_W_over_Eq_155", 1.0, share, EXACT)
    edges = [(n, printed.critical_momentum(n)) for n in _SIZES]
    jumps = [printed.angles(n, H) - printed.angles(n, H * (1 - 1e-12), "ceil") for n, H in edges]
    jump = max(float(np.abs(j).max()) for j in jumps)
    yield _row("H_c, n = 4 to 11", "jump_rad", 0.0, jump, 1e-4, "printed", _JUMP)


def _measured(n: int, H: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the row norms of A^+, (k, n), and det(A A^T), (k,), by NumPy."""
    constraint = Planar(n)
    A = constraint.array().jacobian(constraint.gimbal_angles(along(H)))
    return np.linalg.norm(np.linalg.pinv(A), axis=2), np.linalg.det(A @ A.transpose(0, 2, 1))


def _farthest(wanted: float, values: np.ndarray) -> float:
    return float(values.ravel()[int(np.argmax(np.abs(values - wanted)))])


def _held() -> Iterator[Cell]:
    """Momentum that the printed angles miss, at the worst of many momenta."""
    for n in _SIZES:
        row = f"{_NAMES.get(n, 'Eqs 24-27')}, n = {n}"
        note = _FLOOR if n == 11 else ""
        yield _row(row, "momentum_error", 0.0, missed(n), EXACT, "printed", note)
    row, found = "Eqs 43-47, n = 11, k_4 rounded up", missed(11, "ceil")
    yield _row(row, "momentum_error", 0.0, found, EXACT, "inferred")


def missed(n: int, k4: printed.K4 = "floor") -> float:
    """Return the greatest momentum that the printed angles are off by."""
    found = []
    for H in np.linspace(0.0, 0.99 * n, 100).tolist():
        delta = printed.angles(n, H, k4)
        found.append(math.hypot(np.cos(delta).sum() - H, np.sin(delta).sum()))
    return max(found)


def _bias() -> Iterator[Cell]:
    """The box-90's bias: b, and what Eqs 52 to 54 ask of Psi."""
    from scipy.optimize import minimize_scalar

    def capability(b: float) -> float:
        return float(Box90Cubic(b).torque_capability(np.zeros(3)))

    cubic = Box90Cubic()
    best = float(minimize_scalar(lambda b: -capability(b), bounds=(2.0, 4.0), method="bounded").x)
    yield _row("Eq 51", "b", 4 * math.sqrt(6) / 3, best, 1e-4)
    yield _row("Eq 51", "TC_at_0", 4 / 3, capability(cubic.b), EXACT, "inferred", _BOUND)
    ends = {52: ((1, 2, 0), (1, -2, 0)), 53: ((2, 2, 0), (2, -2, 0)), 54: ((0, 2, 2), (0, -2, -2))}
    for equation, given in ends.items():
        for axis, at, value in given:
            psi = float(cubic.bias(at * np.eye(3)[axis])[0])
            note, where = (_EVEN if value < 0 else ""), f"H_{'xyz'[axis]} = {at:+d}"
            yield _row(f"Eq {equation}, {where}", "Psi", float(value), psi, EXACT, note=note)


def _start() -> Iterator[Cell]:
    b = 4 * math.sqrt(6) / 3
    first, third = math.acos(-b / 4), math.acos(b / 4)
    delta = np.array([first, -first, third, -third])
    array, cubic = layouts.create("box90"), Box90Cubic()
    momentum = float(np.abs(array.momentum(delta)).max())
    apart = float(np.abs(np.cos(delta) - np.cos(cubic.gimbal_angles(np.zeros(3)))).max())
    yield _row("Eqs 63-66", "momentum", 0.0, momentum, EXACT)
    yield _row("Eqs 63-66", "distance_from_Eq_50", 0.0, apart, EXACT)


def _gradient() -> Iterator[Cell]:
    """Torque given over torque commanded by the local gradient."""
    array = layouts.create("box90", h0=2.0)
    A = array.jacobian(np.array([0.9, -0.4, 2.3, 3.6]))
    J, T = A / 2.0, np.array([0.3, -0.1, 0.2])
    ratio = float(np.linalg.norm(A @ np.linalg.pinv(J) @ T) / np.linalg.norm(T))
    yield _row("Eq 59", "torque_ratio", 1.0, ratio, EXACT, "printed", _EQ_59)
    yield _row("Eq 59 with T/h", "torque_ratio", 1.0, ratio / 2.0, EXACT, "inferred")
