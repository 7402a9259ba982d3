"""An evolution strategy for knots between bounds: CMA-ES, many populations at a time."""

from __future__ import annotations

import numpy as np

_SMALL = 1e-5  # a population this narrow has arrived
_PATIENCE = 60  # generations without a gain of one part in a million


class Evolution:
    """One population of CMA-ES (Hansen 2016, arXiv:1604.00772), asked and told.

    Courses are drawn from N(m, sigma^2 C) and moved into the bounds before they are judged;
    m, C and sigma follow the better half of what was judged.

    Args:
        mean: Where it begins, (depth,).
        sigma: Standard deviation at the start.
        rng: What it draws from.
        size: Number of courses in a generation.
        bound: Greatest size of a knot.
    """

    def __init__(
        self,
        mean: np.ndarray,
        sigma: float,
        rng: np.random.Generator,
        size: int = 64,
        bound: float = 1.0,
    ) -> None:
        """Start with a round population."""
        n = len(mean)
        self.mean, self.sigma, self.rng, self.size, self.bound = mean, sigma, rng, size, bound
        raw = np.log(size / 2 + 0.5) - np.log(np.arange(1, size // 2 + 1))
        self._weights = raw / raw.sum()
        self._mass = 1.0 / float(self._weights @ self._weights)
        self._covariance, self._axes, self._lengths = np.eye(n), np.eye(n), np.ones(n)
        self._path, self._sigma_path = np.zeros(n), np.zeros(n)
        self._generation, self._since = 0, 0
        self.value, self.knots = -np.inf, mean

    @property
    def settled(self) -> bool:
        """Whether nothing more is to be expected."""
        narrow = self.sigma * float(self._lengths.max()) < _SMALL
        return narrow or self._since >= _PATIENCE

    def ask(self) -> np.ndarray:
        """Return the next generation, (size, depth)."""
        drawn = self.rng.standard_normal((self.size, len(self.mean))) * self._lengths
        self._asked = np.clip(
            self.mean + self.sigma * (drawn @ self._axes.T), -self.bound, self.bound
        )
        return self._asked

    def tell(self, values: np.ndarray) -> None:
        """Move towards the better half of the generation asked for."""
        order = np.argsort(-values, kind="stable")
        top = float(values[order[0]])
        self._since = 0 if top > self.value + 1e-6 * abs(self.value) else self._since + 1
        if top > self.value:
            self.value, self.knots = top, self._asked[order[0]]
        steps = (self._asked[order[: len(self._weights)]] - self.mean) / self.sigma
        move = self._weights @ steps
        self.mean = self.mean + self.sigma * move
        self._generation += 1
        self._adapt(steps, move)

    def _adapt(self, steps: np.ndarray, move: np.ndarray) -> None:
        """Adapt sigma and C to the steps that were good."""
        n, mass = len(move), self._mass
        c_sigma = (mass + 2.0) / (n + mass + 5.0)
        damping = 1.0 + 2.0 * max(0.0, np.sqrt((mass - 1.0) / (n + 1.0)) - 1.0) + c_sigma
        c_path = (4.0 + mass / n) / (n + 4.0 + 2.0 * mass / n)
        c_one = 2.0 / ((n + 1.3) ** 2 + mass)
        c_many = min(1.0 - c_one, 2.0 * (mass - 2.0 + 1.0 / mass) / ((n + 2.0) ** 2 + mass))
        usual = np.sqrt(n) * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n))

        white = self._axes @ ((self._axes.T @ move) / self._lengths)
        self._sigma_path *= 1.0 - c_sigma
        self._sigma_path += np.sqrt(c_sigma * (2.0 - c_sigma) * mass) * white
        length = float(np.linalg.norm(self._sigma_path))
        faded = np.sqrt(1.0 - (1.0 - c_sigma) ** (2 * self._generation))
        calm = length / faded < (1.4 + 2.0 / (n + 1.0)) * usual
        spread = c_path * (2.0 - c_path)
        self._path = (1.0 - c_path) * self._path + calm * np.sqrt(spread * mass) * move
        self._covariance *= 1.0 - c_one - c_many + (0.0 if calm else c_one * spread)
        self._covariance += c_one * np.outer(self._path, self._path)
        self._covariance += c_many * (steps.T * self._weights) @ steps
        self.sigma *= float(np.exp(min(1.0, (c_sigma / damping) * (length / usual - 1.0))))
        if self._generation % 5 == 0:
            squares, self._axes = np.linalg.eigh(0.5 * (self._covariance + self._covariance.T))
            self._lengths = np.sqrt(np.maximum(squares, 1e-20))
