"""The momenta that the array is about to go through: knots along a path in momentum space."""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from nullmotion.array.model import CmgArray

_DIRECTIONS = {1: 2, 2: 64, 3: 400}  # half spaces that stand for the envelope
_INSIDE = 0.97  # share of the envelope that is used: every state on it is singular
_COARSE = 40.0  # second step of a plan, as a share of the horizon; the first is a sample's
_RESTING = 0.1  # share of the rate limit: what a second without torque counts for


class Path(NamedTuple):
    """Knots of a plan; momenta are relative to now and divided by the mean momentum.

    Attributes:
        place: Distance of each knot along the path, (N,).
        step: Distance from the knot before, (N,).
        seconds: Time from the knot before [s], (N,).
        target: Momentum to have at each knot, (N, m).
    """

    place: np.ndarray
    step: np.ndarray
    seconds: np.ndarray
    target: np.ndarray


@lru_cache(maxsize=256)
def spaced(first: float, horizon: float, count: int) -> np.ndarray:
    """Return the places of ``count`` knots: the first at ``first``, the last at the horizon.

    The steps behind the first are stretched geometrically from a fortieth of the horizon.
    """
    rest = count - 1
    second = max(first, horizon / _COARSE)
    left = max(horizon - first, rest * 1e-3)
    if second * rest >= left:
        steps = np.full(rest, left / rest)
    else:
        steps = second * _ratio(left / second, rest) ** np.arange(rest)
    place = np.cumsum(np.concatenate([[first], steps]))
    place.setflags(write=False)
    return place


def _ratio(total: float, count: int) -> float:
    """Return r > 1 with 1 + r + ... + r^(count - 1) = total > count, by Newton from above."""
    r = max(1.0 + 1e-6, total ** (1.0 / (count - 1)) if count > 1 else 1.0)
    for _ in range(60):
        power = r**count
        value = (power - 1.0) / (r - 1.0) - total
        slope = (count * power / r * (r - 1.0) - (power - 1.0)) / (r - 1.0) ** 2
        change = value / slope
        r = max(1.0 + 1e-9, r - change)
        if abs(change) < 1e-10:
            break
    return r


class Envelope:
    """Half spaces u . h <= sum_i h0_i |(s_i.u, t_i.u)| around what an array can hold."""

    def __init__(self, array: CmgArray) -> None:
        """Take the directions: evenly spread in one or two dimensions, a spiral in three."""
        m, count = array.m, _DIRECTIONS[array.m]
        k = np.arange(count)
        if m == 3:
            z, turn = 1.0 - (2.0 * k + 1.0) / count, np.pi * (3.0 - np.sqrt(5.0)) * k
            side = np.sqrt(1.0 - z * z)
            u = np.stack([side * np.cos(turn), side * np.sin(turn), z], axis=1)
        else:
            turn = 2.0 * np.pi * k / count
            u = np.stack([np.cos(turn), np.sin(turn)], axis=1)[:, :m]
        spin, torque = array.rotor_momenta(np.zeros(array.n)), array.jacobian(np.zeros(array.n)).T
        reach = np.sqrt((u @ spin.T) ** 2 + (u @ torque.T) ** 2).sum(axis=1)
        self.directions, self.reach = u, _INSIDE * reach / array.mean_momentum

    def held(self, start: np.ndarray, target: np.ndarray) -> np.ndarray:
        """Return targets (N, m) that stay where the path leaves the envelope.

        The first one is a command and stays as it is.

        Args:
            start: Momentum now, (m,), over the mean momentum and without bias.
            target: Momenta to have, (N, m), alike.
        """
        along = target @ self.directions.T
        outside = np.nonzero((along > self.reach).any(axis=1))[0]
        if len(outside) == 0:
            return target
        k = int(outside[0])
        before = along[k - 1] if k else self.directions @ start
        rise = along[k] - before
        rising = rise > 1e-12
        shares = (self.reach - before)[rising] / rise[rising]
        share = float(np.clip(shares.min(initial=1.0), 0.0, 1.0))
        last = target[k - 1] if k else start
        kept = target.copy()
        kept[max(k, 1) :] = target[0] if k == 0 else last + share * (target[k] - last)
        return kept


def held(rate: np.ndarray, period: float, horizon: float, count: int) -> Path:
    """Return the path of a torque that stays as it is.

    Args:
        rate: hdot over the mean momentum [rad/s], (m,), not zero.
        period: Time of the first step [s].
        horizon: Momentum to look ahead, in mean momenta.
        count: Number of knots.
    """
    size = float(np.sqrt(rate @ rate))
    place = spaced(size * period, horizon, count)
    step = np.diff(place, prepend=0.0)
    return Path(place, step, step / size, np.outer(place / size, rate))


def previewed(
    rates: np.ndarray, period: float, horizon: float, count: int, rate_limit: float
) -> Path:
    """Return the path of a torque known over the coming samples and held behind them.

    Knots stand at equal distances along the path in momentum space as in `held`; a sample
    without torque counts as much as some rotation of the gimbals: time for null motion.

    Args:
        rates: hdot of this and the coming samples over the mean momentum [rad/s], (k, m).
        period: Time between samples [s].
        horizon: Momentum to look ahead.
        count: Number of knots.
        rate_limit: Least rate limit [rad/s].
    """
    size = np.sqrt(np.sum(rates * rates, axis=1))
    rest = _RESTING * rate_limit
    lengths = np.cumsum(np.concatenate([[0.0], np.maximum(size, rest) * period]))
    momentum = np.concatenate([np.zeros((1, rates.shape[1])), np.cumsum(rates * period, axis=0)])
    time = period * np.arange(len(lengths))
    pace = max(size[-1], rest)
    place = spaced(float(lengths[1]), horizon, count)
    beyond = np.maximum(place - lengths[-1], 0.0)
    target = np.stack([np.interp(place, lengths, column) for column in momentum.T], axis=1)
    target = target + np.outer(beyond / pace, rates[-1])
    at = np.interp(place, lengths, time) + beyond / pace
    return Path(place, np.diff(place, prepend=0.0), np.diff(at, prepend=0.0), target)
