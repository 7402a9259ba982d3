"""Momenta at which a bias is looked at, along rays: what it reaches there."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from nullmotion.guarantee.design.family import Family
from nullmotion.guarantee.design.goal import Goal, Reward
from nullmotion.guarantee.design.rays import part
from nullmotion.guarantee.design.rows import rows_of

_SHELLS = 64
_ALIVE = 0.03  # TC that shows a momentum not singular
_INNER = 0.045  # of the extent: nothing is asked of TC so close to no momentum
_HALVINGS = 6
_BROAD = 1.6  # shells over the extent, where volumes count


class Crossings(NamedTuple):
    """Where rays cross a level: whether TC falls there, |h|, and which ray."""

    falls: np.ndarray
    at: np.ndarray
    ray: np.ndarray


class Measured(NamedTuple):
    """What coefficients reach.

    Attributes:
        q: TC^2 on shells and rays, (s, d).
        crossings: Of each level that is rewarded.
        radii: Radius for each reward.
        volumes: Volume for each reward.
        missed: Most that TC is below the floor.
        score: What it is worth.
    """

    q: np.ndarray
    crossings: dict[float, Crossings]
    radii: np.ndarray
    volumes: np.ndarray
    missed: float
    score: float


class Samples:
    """Rays h = |h| u through a part of momentum space that tells all.

    Attributes:
        directions: u, (d, 3); `add` takes more.
        shells: |h|, (s,).
        angles: Solid angle that each direction stands for; 0 for those at an edge.
        floor: Least TC wanted on each shell.
        coefficients: Number n of coefficients.
    """

    def __init__(self, family: Family, degree: int, goal: Goal, radius: float) -> None:
        """Lay out rays for a goal with an envelope of a radius."""
        self.family, self.degree, self.goal = family, degree, goal
        self.coefficients = len(family.orbits(degree))
        reach = family.extent * (_BROAD if goal.volumes else 1.0)
        shells = reach * (np.arange(_SHELLS) + 1) / _SHELLS
        self.shells = np.unique(np.concatenate([shells, [radius], goal.shells]))
        self.floor = np.where(self.shells <= radius, _ALIVE, 0.0)
        if goal.floor is not None:
            self.floor = np.maximum(self.floor, goal.floor(self.shells))
        self.floor[self.shells < _INNER * family.extent] = 0.0
        self.directions, self.angles = part(family)
        self.rows = rows_of(family.counts, family.extent)
        self._lay()

    def _lay(self) -> None:
        self.points = (self.shells[:, None, None] * self.directions).reshape(-1, 3)
        self.powers = self.family.powers(self.degree, self.points)

    def add(self, momenta: np.ndarray) -> None:
        """Add rays through momenta (k, 3), turned into the part that tells all."""
        h = np.abs(momenta)
        if self.family.equal:
            h = np.concatenate([h, h[:, [0, 2, 1]]])
        else:
            h[:, 0] = momenta[:, 0]
        h = h[np.linalg.norm(h, axis=1) > 0]
        unit = h / np.linalg.norm(h, axis=1, keepdims=True)
        self.directions = np.concatenate([self.directions, unit])
        self.angles = np.concatenate([self.angles, np.zeros(len(unit))])
        self._lay()

    def measure(self, c: np.ndarray, penalty: float) -> Measured:
        """Return what coefficients reach."""
        goal = self.goal
        q = self.rows.squares(self.points, self.powers @ c).reshape(len(self.shells), -1)
        levels = {reward.torque_capability for reward in (*goal.radii, *goal.volumes)}
        found = {level: self.crossings(c, q, level) for level in levels}
        radii = np.array([self._radius(q, found[t], t) for t, _ in goal.radii])
        volumes = np.array([self._volume(found[t]) for t, _ in goal.volumes])
        missed = float(np.max(self.floor - np.sqrt(q.min(axis=1)), initial=0.0))
        score = _worth(goal.radii, radii) + _worth(goal.volumes, volumes) - penalty * missed
        return Measured(q, found, radii, volumes, missed, score)

    def _radius(self, q: np.ndarray, found: Crossings, level: float) -> float:
        """Return the least |h| at which TC falls below a level."""
        if (q[0] < level**2).any():
            return 0.0
        return float(np.min(found.at[found.falls], initial=self.shells[-1]))

    def _volume(self, found: Crossings) -> float:
        """Return the volume with TC at least a level: sum of |h|^3 over crossings, by sign."""
        share = self.angles[found.ray] * found.at**3 / 3.0
        return float(np.sum(np.where(found.falls, share, -share)))

    def crossings(self, c: np.ndarray, q: np.ndarray, level: float) -> Crossings:
        """Return where rays cross a level, from q on shells: halvings, then a chord."""
        over = q - level**2
        i, ray = np.nonzero((over[:-1] >= 0) != (over[1:] >= 0))
        falls, u = over[i, ray] >= 0, self.directions[ray]
        ends, values = np.stack([self.shells[i], self.shells[i + 1]]), over[[i, i + 1], ray]
        for _ in range(_HALVINGS):
            middle = 0.5 * (ends[0] + ends[1])
            h = middle[:, None] * u
            found = self.rows.squares(h, self.family.powers(self.degree, h) @ c) - level**2
            first = (found >= 0) == falls  # the middle is on the first end's side
            moved = np.stack([first, ~first])
            ends, values = np.where(moved, middle, ends), np.where(moved, found, values)
        share = values[0] / (values[0] - values[1])
        return Crossings(falls, ends[0] + share * (ends[1] - ends[0]), ray)

    def slopes(self, h: np.ndarray, c: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return q of each row (N, k) and its slope over the coefficients (N, k, n)."""
        powers = self.family.powers(self.degree, h)
        q, slope = self.rows.slopes(h, powers @ c)
        return q, slope @ powers


def _worth(rewards: tuple[Reward, ...], values: np.ndarray) -> float:
    return float(sum(r.weight * v for r, v in zip(rewards, values, strict=True)))
