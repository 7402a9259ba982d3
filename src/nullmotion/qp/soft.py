"""Constraints that may be violated at a price."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from nullmotion.errors import InputError
from nullmotion.qp.problem import Problem


def softened(
    problem: Problem, rows: Sequence[int], square: ArrayLike, linear: ArrayLike = 0.0
) -> Problem:
    """Return the problem with slack s >= 0 in some rows of A.

        lower_i - s_i <= a_i x <= upper_i + s_i,    cost + 1/2 square_i s_i^2 + linear_i s_i

    A linear price above the row's multiplier keeps the row exactly wherever that is possible.
    The new variables come behind x in the order of ``rows``. A row bounded on both sides becomes
    two: its upper side stays in place, its lower side comes behind all rows.

    Args:
        problem: The hard problem.
        rows: Numbers of the rows that give way, each once.
        square: Price of s^2, above 0; one or one for each row.
        linear: Price of s, from 0 on.

    Raises:
        InputError: For rows that are not there, and prices that are not of their sign.
    """
    index = np.asarray(rows, int)
    if len(set(index.tolist())) != len(index) or not np.isin(index, np.arange(problem.rows)).all():
        raise InputError("rows", list(rows), f"different numbers from 0 to {problem.rows - 1}")
    n, count = problem.variables, len(index)
    W, w = np.broadcast_to(square, count), np.broadcast_to(linear, count)
    if not (np.all(W > 0) and np.all(w >= 0)):
        raise InputError("square, linear", (square, linear), "above 0 and from 0 on")
    A, lower, upper = (np.array(v) for v in (problem.A, problem.lower, problem.upper))
    low, high = np.isfinite(lower[index]), np.isfinite(upper[index])
    both = index[low & high]
    slack = np.zeros((problem.rows, count))
    slack[index, np.arange(count)] = np.where(high, -1.0, 1.0)
    below = np.concatenate([A[both], np.eye(count)[low & high]], axis=1)
    floor = lower[both]
    lower[both] = -np.inf
    H = np.zeros((n + count, n + count))
    H[:n, :n], H[n:, n:] = problem.H, np.diag(W)
    return Problem(
        H,
        np.concatenate([np.asarray(problem.g), w]),
        np.concatenate([np.concatenate([A, slack], axis=1), below]),
        np.concatenate([lower, floor]),
        np.concatenate([upper, np.full(len(both), np.inf)]),
        np.concatenate([np.asarray(problem.x_lower), np.zeros(count)]),
        np.concatenate([np.asarray(problem.x_upper), np.full(count, np.inf)]),
    )
