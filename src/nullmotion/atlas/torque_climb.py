"""Climbing to the greatest torque capability along null motion, for many gimbal angles at once.

The least of bounds f_j has kinks. It is replaced by the smooth

    F = -(1/p) log sum_j exp(-p f_j)        (below min f by (log of their number)/p at most)

with p growing from stage to stage. With the weights w_j of the sum, its slope is g = sum_j w_j g_j
and, where p is large, its curvature -p sum_j w_j (g_j - g)(g_j - g)^T. A step of null motion is

    N (lambda I + p N^T C N)^-1 N^T g,      C = sum_j w_j (g_j - g)(g_j - g)^T,

lambda being lowered where F grows and raised where it does not (Levenberg and Marquardt). Before
each step the angles move back to their momentum by a step of least norm.
"""

from __future__ import annotations

from functools import lru_cache, reduce
from typing import Any, NamedTuple

import numpy as np

from nullmotion import ops
from nullmotion.array.capability_batch import scaled_limits
from nullmotion.array.model import CmgArray
from nullmotion.atlas import torque_bounds
from nullmotion.atlas.torque_bounds import Bound, State
from nullmotion.compile import compile_function

Stages = tuple[tuple[float, int], ...]  # sharpness p, and steps with it

METHODS = {"pseudo-inverse": torque_bounds.pseudo_inverse, "optimal": torque_bounds.optimal}
HELD = 1e-9  # miss that counts as none, over the mean momentum
_UNLIMITED = 1e6  # rate that stands for no limit, over the least limit
_BACK, _ALONG = 0.7, 0.4  # rad; the longest step to the momentum and of null motion
_NEAR = 1e-4  # miss over the mean momentum from which on F counts
_EASIER, _HARDER, _SHORTER = 0.4, 10.0, 0.25  # damping after a good step; after a bad one, and step
_LANES = 16_384  # angles in one call


class Step(NamedTuple):
    """What a step finds, for angles (B, n).

    Attributes:
        delta: The angles, moved to the momentum, (B, n).
        move: Where to go next, (B, n).
        smooth: F, (B,).
        least: min_j f_j: the logarithm of the torque capability, (B,).
        miss: Largest component of what they lack to the momentum, (B,).
    """

    delta: np.ndarray
    move: np.ndarray
    smooth: np.ndarray
    least: np.ndarray
    miss: np.ndarray


class Climber:
    """An array's torque capability, as something to climb on.

    Momenta are in units of the array's mean momentum and without its bias.
    """

    def __init__(self, array: CmgArray, method: str) -> None:
        """Compile the step."""
        assert array.torque_axes is not None
        size = (np.asarray(array.h0) / array.mean_momentum)[:, None]
        self.spin = size * (array.spin_axes @ array.torque_axes.T)
        self.torque = size * (array.transverse_axes @ array.torque_axes.T)
        self.n, self.m = self.spin.shape
        enough = self.n >= self.m
        self._bounds = METHODS[method] if enough else torque_bounds.pseudo_inverse
        self._limits = np.minimum(scaled_limits(array)[0], _UNLIMITED)
        self._step = compile_function(self._source, np.zeros(self.n), np.zeros(self.m), 0.0, 0.0)

    def _source(self, delta: Any, h: Any, sharpness: Any, damping: Any) -> tuple[Any, ...]:
        before = torque_bounds.state(self.spin, self.torque, delta)
        lack = before.inverse @ (h - sum(before.momenta))
        delta = delta + _shortened(before.columns @ lack, _BACK)
        at = torque_bounds.state(self.spin, self.torque, delta)
        miss = ops.amax(ops.absolute(h - sum(at.momenta)))
        bounds = self._bounds(at, self._limits)
        move, smooth, least = _ascent(at, bounds, sharpness, damping)
        return delta, _shortened(move, _ALONG), smooth, least, miss

    def climbed(self, delta: np.ndarray, h: np.ndarray, sharpness: float, steps: int) -> Step:
        """Return angles (B, n), B > 0, moved to momenta (B, m) and up F by steps of null motion."""
        count = -(-len(delta) // _LANES)
        pairs = zip(np.array_split(delta, count), np.array_split(h, count), strict=True)
        parts = [self._climbed(d, k, np.full(len(d), sharpness), steps) for d, k in pairs]
        return Step(*(np.concatenate(column) for column in zip(*parts, strict=True)))

    def _climbed(self, delta: np.ndarray, h: np.ndarray, sharpness: np.ndarray, steps: int) -> Step:
        damping = np.ones(len(delta))
        here = Step(*self._step(delta, h, sharpness, damping))
        for _ in range(steps):
            damping = _EASIER * damping
            there = Step(*self._step(here.delta + here.move, h, sharpness, damping))
            good = (there.smooth >= here.smooth) & (there.miss < _NEAR)
            good |= (there.miss < here.miss) & (here.miss > _NEAR)
            back = here._replace(move=_SHORTER * here.move)
            here = Step(*(_chosen(good, a, b) for a, b in zip(there, back, strict=True)))
            damping = np.where(good, damping, _HARDER * damping)
        return here


@lru_cache(maxsize=8)
def climber(array: CmgArray, method: str) -> Climber:
    """Return the climber of an array, compiled once."""
    return Climber(array, method)


def _chosen(good: np.ndarray, a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.where(good[:, None] if a.ndim > 1 else good, a, b)


def _ascent(at: State, bounds: list[Bound], sharpness: Any, damping: Any) -> tuple[Any, Any, Any]:
    """Return the step of null motion (n,), F and the least bound; source."""
    least = reduce(ops.minimum, [b.value for b in bounds])
    raw = [np.exp(sharpness * (least - b.value)) for b in bounds]
    total = sum(raw)
    weights = [w * (1.0 / total) for w in raw]
    slope = sum(w * b.slope for w, b in zip(weights, bounds, strict=True))
    spread = [b.slope - slope for b in bounds]
    heavy = [(sharpness * w) * d for w, d in zip(weights, spread, strict=True)]
    n = len(slope)
    matrix = np.zeros((n, n), dtype=object)
    for i in range(n):
        for j in range(i + 1):
            matrix[i, j] = matrix[j, i] = sum(
                x[i] * y[j] for x, y in zip(heavy, spread, strict=True)
            )
    matrix = _across(at, _across(at, matrix).T)
    for i in range(n):
        matrix[i, i] = matrix[i, i] + damping
    return _solved(matrix, _across(at, slope)), least - np.log(total) * (1.0 / sharpness), least


def _across(at: State, x: Any) -> Any:
    """Return (I - A^+ A) x, the part of x that is null motion, (n, ...)."""
    return x - at.columns @ (at.inverse @ (at.columns.T @ x))


def _shortened(step: Any, longest: float) -> Any:
    size = ops.sqrt(step @ step + 1e-300)
    return step * ops.where(ops.less(longest, size), longest / size, 1.0)


def _solved(matrix: Any, b: Any) -> Any:
    """Return M^-1 b by M = L D L^T, M symmetric and positive definite; its lower half is read."""
    n = len(b)
    L, D, y = np.zeros((n, n), dtype=object), [0.0] * n, list(b)
    for j in range(n):
        scaled = [L[j, k] * D[k] for k in range(j)]
        D[j] = matrix[j, j] - sum(L[j, k] * scaled[k] for k in range(j))
        for i in range(j + 1, n):
            lower = matrix[i, j] - sum(L[i, k] * scaled[k] for k in range(j))
            L[i, j] = lower * (1.0 / D[j])
        y[j] = y[j] - sum(L[j, k] * y[k] for k in range(j))
    y = [x * (1.0 / d) for x, d in zip(y, D, strict=True)]
    for i in reversed(range(n)):
        y[i] = y[i] - sum(L[k, i] * y[k] for k in range(i + 1, n))
    return np.array(y)
