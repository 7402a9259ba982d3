"""The best few gimbal angles of every momentum of a grid, unlike each other."""

from __future__ import annotations

import numpy as np

_PLACES = 4
_ALIKE = 0.1  # rad; angles closer than this are the same maximum
_WORTH = 0.1  # share of the torque capability below the best up to which angles are kept
_NEWS = 0.02  # share by which the same maximum must grow to be new


class Pool:
    """Gimbal angles kept for each of N momenta, the best first.

    Where one branch of maxima is the best it was often found elsewhere, as the second or third.

    Attributes:
        delta: Gimbal angles [rad], (places, N, n).
        value: Logarithm of their torque capability, -inf for an empty place, (places, N).
        fresh: What neighbours have not been told of, (places, N).
    """

    def __init__(self, size: int, n: int, mirrored: bool) -> None:
        """Make empty places.

        Args:
            size: Number of momenta.
            n: Number of CMGs.
            mirrored: Whether momentum k is the opposite of momentum N - 1 - k, so that
                delta + pi holds the one where delta holds the other.
        """
        self.size, self.mirrored = size, mirrored
        self.delta = np.zeros((_PLACES, size, n))
        self.value = np.full((_PLACES, size), -np.inf)
        self.fresh = np.zeros((_PLACES, size), bool)

    @property
    def reached(self) -> np.ndarray:
        """Momenta for which angles are known, (N,)."""
        found: np.ndarray = np.isfinite(self.value[0])
        return found

    def distance(self, which: np.ndarray, delta: np.ndarray) -> np.ndarray:
        """Return how far angles (B, n) are from those kept for momenta (B,) [rad], (places, B)."""
        away = 2 * np.abs(np.sin(0.5 * (self.delta[:, which] - delta))).max(axis=2)
        far: np.ndarray = np.where(self.value[:, which] > -np.inf, away, np.inf)
        return far

    def keep(self, which: np.ndarray, delta: np.ndarray, value: np.ndarray) -> None:
        """Keep what is worth it of angles (B, n) with values (B,), one for each momentum (B,)."""
        good = value > np.maximum(self.value[-1, which], self.value[0, which] - _WORTH)
        which, delta, value = which[good], delta[good], value[good]
        if len(which) == 0:
            return
        alike = self.distance(which, delta) < _ALIKE
        known = np.any(alike, axis=0)
        place = np.where(known, alike.argmax(axis=0), _PLACES - 1)
        better = value > self.value[place, which]
        which, delta, value = which[better], delta[better], value[better]
        place, known = place[better], known[better]
        news = ~known | (value > self.value[place, which] + _NEWS)
        self.delta[place, which], self.value[place, which] = delta, value
        self.fresh[place, which] |= news
        self._sort(which)

    def _sort(self, which: np.ndarray) -> None:
        """Put the best first, and mirror it."""
        order = np.argsort(-self.value[:, which], axis=0, kind="stable")
        for rows in (self.value, self.fresh):
            rows[:, which] = np.take_along_axis(rows[:, which], order, axis=0)
        self.delta[:, which] = np.take_along_axis(self.delta[:, which], order[..., None], axis=0)
        if self.mirrored:
            which = which[which != self.size - 1 - which]
            there = self.size - 1 - which
            self.delta[:, there] = self.delta[:, which] + np.pi
            self.value[:, there] = self.value[:, which]
            self.fresh[:, there] = self.fresh[:, which]
