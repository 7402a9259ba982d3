"""A quadratic program as data, and how well a point solves it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from nullmotion.errors import InputError

Array = Any  # what NumPy makes an array of; np.ndarray once it is in a Problem


class Residuals(NamedTuple):
    """By how much the KKT conditions are missed, each relative to the size of its terms.

    Attributes:
        stationarity: |H x + g + [I; A]^T y|, over the largest of the three terms.
        primal: Greatest violation of a bound, over the greatest |x| or |A x|.
        dual: Greatest multiplier of a bound that does not exist, over the greatest multiplier.
        complementarity: Greatest |multiplier x distance to its bound|, over the greatest
            |multiplier| x |x| or |A x|.

    No divisor is below 1.
    """

    stationarity: float
    primal: float
    dual: float
    complementarity: float

    @property
    def worst(self) -> float:
        """The greatest of the four."""
        return max(self)


@dataclass(frozen=True, eq=False)
class Problem:
    """minimise 1/2 x^T H x + g^T x  with  lower <= A x <= upper,  x_lower <= x <= x_upper.

    The arrays are copied and cannot be written to.

    Args:
        H: Symmetric positive semidefinite matrix, (n, n).
        g: Linear term, (n,).
        A: Rows of the constraints, (k, n); None for none.
        lower: Their lower bounds, (k,); -inf for none.
        upper: Their upper bounds, (k,); inf for none.
        x_lower: Lower bounds on x, (n,).
        x_upper: Upper bounds on x, (n,).

    Raises:
        InputError: For shapes that do not fit.
    """

    H: Array
    g: Array
    A: Array = None
    lower: Array = None
    upper: Array = None
    x_lower: Array = None
    x_upper: Array = None

    def __post_init__(self) -> None:
        """Copy and check."""
        n = np.shape(self.g)[0] if np.ndim(self.g) == 1 else -1
        k = 0 if self.A is None else len(np.atleast_1d(np.asarray(self.A)))
        self._keep("g", self.g, (n,))
        self._keep("H", self.H, (n, n))
        self._keep("A", np.zeros((0, n)) if self.A is None else self.A, (k, n))
        for key, size, none in (
            ("lower", k, -np.inf),
            ("upper", k, np.inf),
            ("x_lower", n, -np.inf),
            ("x_upper", n, np.inf),
        ):
            given = getattr(self, key)
            self._keep(key, np.full(size, none) if given is None else given, (size,))

    def _keep(self, key: str, value: Array, shape: tuple[int, ...]) -> None:
        array = np.array(value, float, order="C")
        if array.shape != shape or -1 in shape:
            raise InputError(f"problem.{key}", array.shape, f"an array of shape {shape}")
        array.setflags(write=False)
        object.__setattr__(self, key, array)

    @property
    def variables(self) -> int:
        """Number of variables n."""
        return len(self.g)

    @property
    def rows(self) -> int:
        """Number of rows of A."""
        return len(self.A)

    def cost(self, x: np.ndarray) -> float:
        """Return 1/2 x^T H x + g^T x."""
        return float(0.5 * x @ (self.H @ x) + self.g @ x)

    def residuals(self, x: np.ndarray, multipliers: np.ndarray) -> Residuals:
        """Return by how much x (n,) and multipliers (n + k,) miss the KKT conditions.

        Anything that is not finite gives infinite residuals.
        """
        n, k = self.variables, self.rows
        Hx, Ax = self.H @ x, self.A @ x
        pull = multipliers[:n] + multipliers[n:] @ self.A
        value, (low, high, no_low, no_high) = np.concatenate([x, Ax]), self._limits
        above, below = value - high, low - value
        up = np.maximum(multipliers, 0.0)
        down = up - multipliers
        idle = up * np.where(no_high, 0.0, above), down * np.where(no_low, 0.0, below)
        parts = Hx + self.g + pull, Hx, self.g, pull, value, multipliers, *idle
        pushed = up * no_high, down * no_low
        every = np.abs(np.concatenate([*parts, *pushed]))
        starts = [0, n, 2 * n, 3 * n, *range(4 * n, 4 * n + 6 * (n + k), n + k)]
        off, *terms, size, price, slack, slack_low, free, free_low = np.maximum.reduceat(
            every, starts
        ).tolist()
        violated = max(0.0, float(np.maximum(above, below).max()))
        size, price = max(1.0, size), max(1.0, price)
        found = (
            off / max(1.0, *terms),
            violated / size,
            max(free, free_low) / price,
            max(slack, slack_low) / (price * size),
        )
        finite = np.isfinite(found[0]) and np.isfinite(violated)
        return Residuals(*found) if finite else Residuals(*(np.inf,) * 4)

    @cached_property
    def _limits(self) -> tuple[np.ndarray, ...]:
        """Lower and upper bounds of x and then of the rows of A, and where there is none."""
        low = np.concatenate([self.x_lower, self.lower])
        high = np.concatenate([self.x_upper, self.upper])
        return low, high, np.isinf(low), np.isinf(high)
