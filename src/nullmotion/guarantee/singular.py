"""Where a constraint is singular though nothing is saturated: curves of momentum.

A plane of CMGs whose part p(h) of the momentum vanishes is singular (r = 0). Those momenta
are curves, p(h) = 0 with two components: too thin for a search over samples.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache

import numpy as np
from scipy.optimize import minimize

from nullmotion.compile import compile_function
from nullmotion.compile.tangent import jvp
from nullmotion.guarantee.constraint import Constraint
from nullmotion.guarantee.maps import spread_directions

_DIRECTIONS, _SHELLS = 512, 24
_NEWTON = 12  # steps to a curve
_STARTS = 6  # of the points on a curve that are slid along it
_SMALL = 1e-12  # keeps the square of a slope regular
_ON = 1e-9  # a part's momentum that counts as none


@lru_cache(maxsize=16)
def nearest_singular(constraint: Constraint) -> np.ndarray | None:
    """Return the momentum (m,) of least size where a part p(h) vanishes; None without one.

    The least of |h|^2 with p(h) = 0, by sequential quadratic programming from the points of
    the curve nearest to no momentum that a sample of momenta leads to.
    """
    m = constraint.m
    count = len(constraint.parts(np.ones(m)))
    found = [h for k in range(count) for h in _of_part(constraint, k)]
    return min(found, key=lambda h: float(h @ h), default=None)


def _of_part(constraint: Constraint, k: int) -> list[np.ndarray]:
    m, evaluate = constraint.m, _kernel(constraint, k)
    shells = constraint.reach * np.arange(1, _SHELLS + 1) / _SHELLS
    h = (shells[:, None, None] * spread_directions(m, _DIRECTIONS)).reshape(-1, m)
    for _ in range(_NEWTON):
        p, slope = evaluate(h)
        square = slope @ slope.swapaxes(1, 2) + _SMALL * np.eye(p.shape[1])
        h = h - np.einsum("nji,nj->ni", slope, np.linalg.solve(square, p[..., None])[..., 0])
        h = h[np.linalg.norm(h, axis=1) < constraint.reach]  # not a number goes, too
    size = np.linalg.norm(h, axis=1)
    on = np.abs(evaluate(h)[0]).max(axis=1, initial=0.0) < _ON
    starts = h[on][np.argsort(size[on], kind="stable")[:_STARTS]]
    slid = [_slide(evaluate, start) for start in starts]
    return [h for h in slid if np.abs(evaluate(h[None])[0]).max() < _ON]


def _slide(evaluate: Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]], start: np.ndarray
           ) -> np.ndarray:  # fmt: skip
    """Return the local minimum of |h| along the curve from a point on it."""
    constraint = {
        "type": "eq",
        "fun": lambda h: evaluate(h[None])[0][0],
        "jac": lambda h: evaluate(h[None])[1][0],
    }
    found = minimize(
        lambda h: h @ h, start, jac=lambda h: 2 * h, method="SLSQP", constraints=constraint,
        options={"ftol": 1e-15, "maxiter": 100},
    )  # fmt: skip
    h: np.ndarray = found.x
    return h


def _kernel(
    constraint: Constraint, k: int
) -> Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]:
    """Return p (N, d) and its slope (N, d, m) as a function of momenta (N, m)."""

    def part(h: np.ndarray) -> np.ndarray:
        return np.asarray(constraint.parts(h)[k])

    def both(h: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        slopes = [jvp(part, (h,), (axis,))[1] for axis in np.eye(len(h))]
        return part(h), np.stack(slopes, axis=1)

    compiled = compile_function(both, np.zeros(constraint.m))
    return lambda h: compiled(h)
