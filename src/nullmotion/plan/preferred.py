"""Preferred gimbal angles: the best start among those that hold the same momentum.

Only the piece of the self-motion on which the given start lies is reached by null motion;
another piece takes a torque on the vehicle on the way.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from nullmotion.errors import InputError
from nullmotion.plan import self_motion
from nullmotion.plan.best import TIE, Progress
from nullmotion.plan.result import Found
from nullmotion.plan.rollout import Rollouts

_BEST = 16  # starts that are refined
_AROUND = 8  # attempts about each
_SHORT = 1e-7  # rad: refined enough


def search(
    rollouts: Rollouts,
    *,
    knots: Any = None,
    starts: int = 4096,
    walk: int = 400,
    seed: int = 0,
    progress: Progress | None = None,
) -> Found:
    """Return the best start angles with the momentum of the setup's start.

    Starts are drawn at random over all pieces of the self-motion, and walked to from the
    given start; the best are refined by ever shorter steps along the self-motion. The given
    start is one of them, so that the result is never worse. Nothing is proven.

    Args:
        rollouts: The manoeuvre.
        knots: Null motion on the way, in units of k_max; none by default.
        starts: Number of random starts.
        walk: Strides of 0.05 rad along the self-motion from the given start, each way.
        seed: Of the random starts.
        progress: Called with the finished share.

    Raises:
        InputError: For no starts or strides.
    """
    for key, number in (("starts", starts), ("walk", walk)):
        if number < 1:
            raise InputError(key, number, "a whole number from 1")
    array, given = rollouts.setup.true_array, rollouts.setup.delta
    momentum, rng = array.momentum(given), np.random.default_rng(seed)
    course = np.zeros(rollouts.depth) if knots is None else np.asarray(knots, float)
    search = _Search(rollouts, course, momentum, rng)
    near = search.best(given, self_motion.walked(array, given, momentum, walk, rng))
    if progress:
        progress(0.5)
    far = search.best(given, self_motion.drawn(array, momentum, starts, rng))
    near = _better((float(rollouts.values(course, given[None])[0]), given), near)
    value, delta = _better(near, far)
    reachable = delta is near[1]
    return Found(
        tuple(course.tolist()),
        value,
        False,
        float(search.count),
        certificate={
            "starts_evaluated": search.count,
            "reachable": reachable,
            "reachable_value": near[0],
            "reachable_gimbal_deg": np.degrees(near[1]).tolist(),
            "momentum_error_Nms": float(np.abs(array.momentum(delta) - momentum).max()),
        },
        remarks=[] if reachable else [_ELSEWHERE],
        delta=delta,
    )


_ELSEWHERE = (
    "null motion alone does not lead to the best start, which is on another piece of the "
    "self-motion; reachable_gimbal_deg is the best that it leads to"
)


_Start = tuple[float, np.ndarray]


def _better(first: _Start, second: _Start) -> _Start:
    """Return the better of two starts, the first if they are as good."""
    return second if second[0] > first[0] + TIE * abs(first[0]) else first


class _Search:
    def __init__(
        self, rollouts: Rollouts, course: np.ndarray, momentum: np.ndarray, rng: Any
    ) -> None:
        self.rollouts, self.course, self.momentum, self.rng = rollouts, course, momentum, rng
        self.count = 0

    def values(self, delta: np.ndarray) -> np.ndarray:
        self.count += len(delta)
        return self.rollouts.values(self.course, delta)

    def best(self, given: np.ndarray, pool: np.ndarray) -> _Start:
        """Return value and angles of the best near the best of a pool and the given start."""
        pool = np.concatenate([given[None], pool])
        values = self.values(pool)
        first = np.argsort(-values, kind="stable")[:_BEST]
        best, value = self._refined(pool[first], values[first])
        top = int(value.argmax())
        return float(value[top]), self._turned_back(best[top])

    def _refined(self, best: np.ndarray, value: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Improve starts by steps along the self-motion, halved where none is better."""
        length = np.full(len(best), 2 * self_motion.STRIDE)
        array, rng = self.rollouts.setup.true_array, self.rng
        while (length > _SHORT).any():
            base = np.repeat(best, _AROUND, axis=0)
            turn = self_motion.along(array, base, rng.normal(size=base.shape))
            size = np.repeat(length, _AROUND)[:, None] * rng.uniform(0.2, 1.0, (len(base), 1))
            tried = self_motion.projected(array, base + size * turn, self.momentum, rounds=4)
            good = self_motion.holds(array, tried, self.momentum)
            found = np.where(good, self.values(tried), -np.inf).reshape(len(best), -1)
            top, greatest = found.argmax(axis=1), found.max(axis=1)
            better = greatest > value
            chosen = tried.reshape(len(best), _AROUND, -1)[np.arange(len(best)), top]
            best, value = np.where(better[:, None], chosen, best), np.maximum(value, greatest)
            length = np.where(better, length, 0.5 * length)
        return best, value

    def _turned_back(self, delta: np.ndarray) -> np.ndarray:
        """Return the same angles within half a turn of the given start, where none is limited."""
        if self.rollouts.setup.true_array.has_angle_limits:
            return delta
        start = self.rollouts.setup.delta
        turns = np.round((delta - start) / (2 * np.pi))
        return np.where(turns == 0, delta, delta - 2 * np.pi * turns)
