"""From the values of compiled nodes to the matrices of the program (`lookahead.program`)."""

from __future__ import annotations

import numpy as np

from nullmotion import qp
from nullmotion.lookahead.program import Node

_TRUST = 0.3  # rad; null motion of a knot in one iteration
_LATE_SQUARE = 1e-2  # what a late step costs beside its price: keeps the Hessian definite


class Layout:
    """Where the values of the nodes go in the program's matrices.

    Attributes:
        free: Dimensions of null motion.
        count: Number of knots N.
    """

    def __init__(self, n: int, free: int, like: Node) -> None:
        """Make the matrices with their constant entries, and the way from node to entry.

        Args:
            n: Number of CMGs.
            free: Dimensions of null motion.
            like: Nodes with the knots as last axis, every value its own place in a flat buffer.
        """
        count = len(like.price)
        self.free, self.count = free, count
        first = count * free  # variables: lambda, then s, then q
        size, rows = first + 2 * count, count * (1 + 2 * n)
        shapes = ((size, size), (size,), (rows, size), (rows,), (rows,))
        ends = np.cumsum([0, *(int(np.prod(shape)) for shape in shapes)]).tolist()
        self._data = np.zeros(ends[-1])
        parts = zip(ends, ends[1:], shapes, strict=False)
        self._parts = [self._data[a:b].reshape(shape) for a, b, shape in parts]
        H, _, A, lower, upper = self._parts
        k = np.arange(count)
        s, q = first + k, first + count + k
        A[k, s], H[q, q] = 1.0, _LATE_SQUARE
        lower[:], upper[:] = -np.inf, np.inf
        self._bounds = np.zeros(size), np.full(size, np.inf)
        self._bounds[0][:first], self._bounds[1][:first] = -_TRUST, _TRUST
        number = np.arange(ends[-1])
        H, g, A, lower, upper = (
            number[a:b].reshape(shape) for a, b, shape in zip(ends, ends[1:], shapes, strict=False)
        )
        lam = np.arange(first).reshape(count, free)
        up = count + np.arange(count * n).reshape(count, n)
        last = np.moveaxis  # nodes carry the knot last, places here carry it first
        pairs = [
            (H[lam, lam], np.tile(like.diagonal[:, None], free)),
            (H[lam[:-1, :, None], lam[1:, None, :]], last(like.cross, -1, 0)[1:]),
            (H[lam[1:, None, :], lam[:-1, :, None]], last(like.cross, -1, 0)[1:]),
            (g[lam], like.gradient.T),
            (H[s, s], like.price),
            (g[q], like.late),
            (A[k[:, None], lam], like.slope.T),
            (lower[:count], like.lacking),
            (upper[up], like.upper.T),
            (lower[up + count * n], like.lower.T),
        ]
        for rows_of, stretch in zip((up, up + count * n), reversed(like.stretch), strict=True):
            pairs += [
                (A[rows_of[:, :, None], lam[:, None, :]], last(like.null, -1, 0)),
                (A[rows_of[1:, :, None], lam[:-1, None, :]], last(like.back, -1, 0)[1:]),
                (A[rows_of, q[:, None]], stretch.T),
            ]
        self._to = np.concatenate([np.ravel(place) for place, _ in pairs])
        self._from = np.concatenate([np.ravel(value) for _, value in pairs])
        assert len(np.unique(self._to)) == len(self._to)

    def problem(self, values: np.ndarray) -> qp.Problem:
        """Return the program of nodes whose values stand in a flat buffer."""
        self._data[self._to] = values[self._from]
        H, g, A, lower, upper = self._parts
        return qp.Problem(H, g, A, lower, upper, *self._bounds)
