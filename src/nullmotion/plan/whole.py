"""Whole courses in batches, over threads where it pays."""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING, Any

import numpy as np

from nullmotion.plan.segment import LEAVES

if TYPE_CHECKING:
    from nullmotion.plan.rollout import Rollouts

_LANES = 1024  # runs that go through all segments together: their state stays in the cache
_WORTH_THREADS = 200_000  # run-steps


def totals(rollouts: Rollouts, knots: Any, delta: np.ndarray | None) -> np.ndarray:
    """Return the totals of the cost's terms over whole courses, (terms, runs)."""
    courses = np.atleast_2d(np.asarray(knots, float))
    runs = len(courses) if delta is None else len(delta)
    table = np.broadcast_to(courses, (runs, rollouts.depth))
    found = np.empty((rollouts.terms, runs))
    chunks = [slice(i, min(i + _LANES, runs)) for i in range(0, runs, _LANES)]
    threads = rollouts.threads or os.cpu_count() or 1
    if threads == 1 or len(chunks) == 1 or runs * rollouts.steps < _WORTH_THREADS:
        _through(rollouts, chunks, table, delta, found)
        return found
    with ThreadPoolExecutor(threads) as pool:
        shares = [chunks[i::threads] for i in range(threads)]
        list(pool.map(lambda mine: _through(rollouts, mine, table, delta, found), shares))
    return found


def _through(
    rollouts: Rollouts,
    chunks: list[slice],
    table: np.ndarray,
    delta: np.ndarray | None,
    found: np.ndarray,
) -> None:
    """Take chunks of runs through all segments, one chunk after the other."""
    block = rollouts.block(min(_LANES, len(table)))
    for chunk in chunks:
        runs = chunk.stop - chunk.start
        ends = table[chunk].T
        if delta is not None:
            block.values[LEAVES:, :runs] = delta[chunk].T
        for segment in range(rollouts.segments):
            b = ends[min(segment + 1, rollouts.depth - 1)]
            sums = rollouts.advance(block, segment, runs, ends[segment], b)
        found[:, chunk] = sums
