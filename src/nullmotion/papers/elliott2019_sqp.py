"""Section 7.2.2 of Elliott 2019: are the closed forms the best? Asked of SciPy's SLSQP.

For a planar array with A = [-sin delta; cos delta], M = A A^T, b_i = M^-1 a_i, e_i = M^-1 h_i
and da_i/d delta_i = -h_i, row i of the pseudo-inverse has the square w_i = b_i . b_i, and

    min t   subject to   w_i <= t,   sum cos delta = H,   sum sin delta = 0

is Eq 17 as a smooth problem. With d_ik = 1 for i = k and 0 otherwise,

    dw_i/d delta_k = 2 (b_i . b_k)(b_i . h_k) + 2 (b_i . e_k)(b_i . a_k) - 2 d_ik b_i . e_i
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from nullmotion.guarantee.constraints.planar import Planar

SIZES = (5, 7, 9, 11)  # CMGs
STARTS = 4  # at each momentum, random; the paper's grids have up to 10^16
STEP = 0.025  # between momenta, as printed
TOLERANCE = 1e-6  # of the comparison, as printed
SEED = 2019
COUNT = 378  # momenta of all sizes
_FEASIBLE = 1e-8  # momentum error of an answer that counts
_SINGULAR = 1e-12  # det M is kept from falling to 0 while the search is far off
_OPTIONS = {"ftol": 1e-10, "maxiter": 300}


@dataclass(frozen=True)
class Comparison:
    """What SLSQP finds for n CMGs beside the closed form.

    Attributes:
        H: Momenta of Eq 160, (k,).
        difference: Least |W_MP|_inf of all starts minus that of the closed form, (k,); not a
            number where no start ends at the momentum.
        found: Share of the starts that end within `TOLERANCE` of the closed form.
    """

    H: np.ndarray
    difference: np.ndarray
    found: float


def compare(n: int, step: float = STEP, starts: int = STARTS) -> Iterator[Comparison | None]:
    """Compare over all momenta: None after each, then the result."""
    rng, constraint = np.random.default_rng((SEED, n)), Planar(n)
    H = momenta(constraint.critical_momentum, n, step)
    closed = 1.0 / constraint.torque_capability(np.stack([H, 0.0 * H], axis=1))
    best, hits = np.full(len(H), np.nan), 0
    for i, (momentum, known) in enumerate(zip(H.tolist(), closed.tolist(), strict=True)):
        values = [solve(momentum, rng.uniform(-np.pi, np.pi, n)) for _ in range(starts)]
        hits += sum(abs(v - known) < TOLERANCE for v in values)
        best[i] = np.nan if np.isnan(values).all() else np.nanmin(values)
        yield None
    yield Comparison(H, best - closed, hits / (starts * len(H)))


def momenta(critical: float, n: int, step: float = STEP) -> np.ndarray:
    """Return the momenta of Eq 160, from H_c to 0.99 n."""
    return np.append(np.arange(critical, 0.99 * n - 0.5 * step, step), 0.99 * n)


def solve(H: float, start: np.ndarray) -> float:
    """Return |W_MP|_inf where SLSQP ends; not a number if that is not at the momentum."""
    from scipy.optimize import minimize

    at = lru_cache(maxsize=1)(lambda data: squares(np.frombuffer(data)[:-1]))
    n, last = len(start), np.eye(len(start) + 1)[-1]
    below: Any = {"type": "ineq", "fun": lambda x: x[-1] - at(x.tobytes())[0]}
    below["jac"] = lambda x: np.hstack([-at(x.tobytes())[1], np.ones((n, 1))])
    held: Any = {"type": "eq", "fun": lambda x: excess(x[:-1], H)}
    held["jac"] = lambda x: np.array([[*-np.sin(x[:-1]), 0.0], [*np.cos(x[:-1]), 0.0]])
    found = minimize(
        lambda x: x[-1],
        np.append(start, squares(start)[0].max()),
        jac=lambda x: last,
        constraints=[below, held],
        method="SLSQP",
        options=_OPTIONS,
    ).x[:-1]
    good = np.isfinite(found).all() and np.hypot(*excess(found, H)) < _FEASIBLE
    return float(np.sqrt(squares(found)[0].max())) if good else np.nan


def excess(delta: np.ndarray, H: float) -> np.ndarray:
    """Return the momentum beyond (H, 0), (2,)."""
    return np.array([np.cos(delta).sum() - H, np.sin(delta).sum()])


def squares(delta: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the squared row norms of A^+, (n,), and their gradients, (n, n)."""
    h = np.array([np.cos(delta), np.sin(delta)])
    a = np.array([-h[1], h[0]])
    (xx, xy), (_, yy) = a @ a.T
    inverse = np.array([[yy, -xy], [-xy, xx]]) / max(xx * yy - xy * xy, _SINGULAR)
    b, e = inverse @ a, inverse @ h
    bb, be = b.T @ b, b.T @ e
    gradient = 2.0 * (bb * (b.T @ h) + be * (b.T @ a) - np.diag(np.diag(be)))
    return np.diag(bb).copy(), gradient
