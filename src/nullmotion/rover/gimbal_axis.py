"""The gimbal axis that leaves the CMG the most authority about the edge where it has least.

min over |g| = 1 of max_j |e_j . g|                                 (Elliott 2019, Eq 68)
"""

from __future__ import annotations

from itertools import combinations, product

import numpy as np

_SAME = 1e-9


def best_axis(directions: np.ndarray) -> np.ndarray:
    """Return the best axis for edges with these directions (of any length), (E, 3) -> (3,).

    With x = g / max_j |e_j . g|, the task is to find the longest x in the polytope
    |e_j . x| <= 1. It is one of its corners, where three edges bind, so that trying all of them
    finds it. Of equal ones it is the first along +b1, then b2, then b3: the paper's, for the
    tetrahedron.
    """
    e = directions / np.linalg.norm(directions, axis=1, keepdims=True)
    corners = _corners(_distinct(e))
    length = np.linalg.norm(corners, axis=1)
    best = corners[length > length.max() * (1 - _SAME)]
    axis: np.ndarray = best[np.lexsort(np.round(best, 9).T[::-1])[-1]]
    return axis / np.linalg.norm(axis)


def _distinct(e: np.ndarray) -> np.ndarray:
    """Return unit vectors without those parallel to an earlier one."""
    parallel = np.abs(e @ e.T) > 1 - _SAME
    return e[~np.tril(parallel, -1).any(axis=1)]


def _corners(e: np.ndarray) -> np.ndarray:
    """Return the corners of |e_j . x| <= 1, (k, 3)."""
    signs = np.array(list(product((1.0, -1.0), repeat=3)))
    found = []
    for three in combinations(range(len(e)), 3):
        rows = e[list(three)]
        if abs(np.linalg.det(rows)) > _SAME:
            x = np.linalg.solve(rows, signs.T).T
            found.append(x[np.abs(x @ e.T).max(axis=1) < 1 + _SAME])
    return np.concatenate(found)
