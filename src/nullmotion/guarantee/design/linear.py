"""What a small change of the coefficients does to a goal: one linear program."""

from __future__ import annotations

import numpy as np

from nullmotion.guarantee.design.program import Program
from nullmotion.guarantee.design.samples import Measured, Samples

_ASIDE = 1e-5  # of a radius, for slopes along a ray
_NEAR = 2.0  # q over what is wanted, beyond which a row is out of reach
_ROOM = 0.1  # of q, the same
_ADVANCE = 0.3  # greatest step of a radius
_STEEP = 1e-2  # least slope of q along a ray of a crossing that moves with the coefficients
_FAR = 200.0  # greatest slope of a crossing's |h|^3


def improved(
    samples: Samples,
    bounds: tuple[np.ndarray, np.ndarray],
    c: np.ndarray,
    now: Measured,
    size: float,
    penalty: float,
) -> np.ndarray | None:
    """Return the coefficients that are best to first order within a change of a size.

    Args:
        samples: Where to look.
        bounds: A and b of A c + b >= 0, which holds in any case.
        c: Coefficients.
        now: What they reach.
        size: Greatest change of a coefficient.
        penalty: Cost of a unit of TC that the floor is missed by.
    """
    goal, n = samples.goal, samples.coefficients
    program = Program(n, len(goal.radii))
    for k, (level, _) in enumerate(goal.radii):
        if now.radii[k] > 0:
            _level(program, samples, c, now, k, level)
    _floor(program, samples, c, now)
    slope, value = bounds
    program.need(np.maximum(value + slope @ c, 0.0), slope)
    gain = np.zeros(n)
    for level, weight in goal.volumes:
        gain += weight * _volume_slope(samples, c, now, level)
    weights = np.array([weight for _, weight in goal.radii])
    ceiling = np.where(now.radii > 0, _ADVANCE, 0.0) if len(weights) else np.empty(0)
    step = program.solve(gain, weights, penalty, size, ceiling)
    return None if step is None else c + step.change


def _level(
    program: Program, samples: Samples, c: np.ndarray, now: Measured, k: int, level: float
) -> None:
    """Ask for q >= level^2 up to the radius that is to grow."""
    wanted, radius = level**2, float(now.radii[k])
    q, slope = samples.slopes(radius * samples.directions, c)
    inner, _ = samples.slopes((1.0 - _ASIDE) * radius * samples.directions, c)
    rate = (q - inner) / (_ASIDE * radius)
    near = q < _NEAR * wanted + _ROOM
    program.need(q[near] - wanted, slope[near], rate[near], k)
    i, ray = np.nonzero((samples.shells[:, None] < radius) & (now.q < _NEAR * wanted + _ROOM))
    q, slope = samples.slopes(samples.shells[i, None] * samples.directions[ray], c)
    near = q < _NEAR * wanted + _ROOM
    program.need(q[near] - wanted, slope[near])


def _floor(program: Program, samples: Samples, c: np.ndarray, now: Measured) -> None:
    """Ask for the floor, with slack; divided by 2 TC, so that it is one of TC."""
    wanted = samples.floor[:, None]
    i, ray = np.nonzero((wanted > 0) & (now.q < _NEAR * wanted**2 + _ROOM))
    q, slope = samples.slopes(samples.shells[i, None] * samples.directions[ray], c)
    least = np.broadcast_to(samples.floor[i, None], q.shape)
    near = q < _NEAR * least**2 + _ROOM
    scale = 2.0 * least[near]
    values = (q[near] - least[near] ** 2) / scale
    program.need(values, slope[near] / scale[:, None], elastic=True)


def _volume_slope(samples: Samples, c: np.ndarray, now: Measured, level: float) -> np.ndarray:
    """Return the slope of the volume with TC >= level over the coefficients, (n,)."""
    falls, at, ray = now.crossings[level]
    u = samples.directions[ray]
    q, slope = samples.slopes(at[:, None] * u, c)
    inner, _ = samples.slopes((1.0 - _ASIDE) * at[:, None] * u, c)
    row, k = np.arange(len(at)), np.where(np.isfinite(q), q, np.inf).argmin(axis=1)
    rate = (q - inner)[row, k] / (_ASIDE * at)
    moves = np.isfinite(rate) & (np.abs(rate) > _STEEP) & (falls == (rate < 0))
    size = np.where(moves, samples.angles[ray] * at**2, 0.0) * np.where(falls, 1.0, -1.0)
    pull = -slope[row, k] / np.where(moves, rate, 1.0)[:, None]
    pull = np.where(moves[:, None], np.clip(pull, -_FAR, _FAR), 0.0)
    found: np.ndarray = size @ pull
    return found
