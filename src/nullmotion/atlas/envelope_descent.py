"""Looking for unreachable momenta of the least size: found here, proven elsewhere.

Next to an unreachable momentum y, every local minimum of |y - h(delta)| shows one sheet of the
boundary of R, with the normal u along y - h(delta). Between the sheets, momenta stay unreachable as
long as

    u_j . y >= u_j . h(delta_j) + margin    for all j,

which holds to first order; the smallest y of that polyhedron (least distance programming, Lawson
and Hanson 1974, Ch 23) is the next guess: smooth minima, creases and corners alike.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.optimize import nnls

from nullmotion.atlas import envelope_three
from nullmotion.atlas.envelope_rings import Rings

Starts = Callable[[np.ndarray], np.ndarray]  # momenta (B, m) to angles (B, S, c)

_KNOWN = 24  # sheets that are kept
_STEPS = 20  # of damped Newton
_ROUNDS = 40
_FIRST = 0.3  # farthest step over |h|
_SHRUNK = 0.4  # of a step that led into R


def closest(
    rings: Rings, delta: np.ndarray, h: np.ndarray, steps: int = _STEPS
) -> tuple[np.ndarray, np.ndarray]:
    """Return angles (B, c) moved to local minima of |h - h(delta)|, and h - h(delta), (B, m).

    Damped Newton with the whole Hessian A^T A + diag(h_i . (h - h(delta))): on a fold A^T A alone
    says nothing of the direction that counts.
    """
    part, column = rings.parts(delta)
    gap = h - part.sum(axis=1)
    size, damping = np.linalg.norm(gap, axis=1), np.full(len(gap), 1e-2)
    eye = np.eye(delta.shape[1])
    for _ in range(steps):
        bend = np.sum(part * gap[:, None], axis=2)
        hessian = column @ column.mT + (bend + damping[:, None])[..., None] * eye
        trial = delta + np.linalg.solve(hessian, column @ gap[..., None])[..., 0]
        fresh, slope = rings.parts(trial)
        rest = h - fresh.sum(axis=1)
        length = np.linalg.norm(rest, axis=1)
        good = length < size
        delta, gap = np.where(good[:, None], trial, delta), np.where(good[:, None], rest, gap)
        part = np.where(good[:, None, None], fresh, part)
        column = np.where(good[:, None, None], slope, column)
        size = np.where(good, length, size)
        damping = np.clip(np.where(good, 0.1 * damping, 8.0 * damping), 1e-13, 1e3)
    return delta, gap


def distances(rings: Rings, starts: Starts, h: np.ndarray) -> np.ndarray:
    """Return the least distance found from momenta (B, m) to reachable ones, (B,)."""
    delta = starts(h)
    count = delta.shape[1]
    _, gap = closest(rings, delta.reshape(-1, delta.shape[2]), np.repeat(h, count, axis=0))
    least: np.ndarray = np.linalg.norm(gap, axis=1).reshape(-1, count).min(axis=1)
    if envelope_three.applies(rings):
        least[envelope_three.judged(rings, h[:, None]).inside] = 0.0
    return least


def smallest_near(
    rings: Rings, starts: Starts, h: np.ndarray, margin: float, straight: bool = False
) -> np.ndarray:
    """Return a momentum (m,) as small as found from h on that stays ``margin`` away from R.

    Args:
        rings: The array's rings.
        starts: Gives angles to start from for momenta.
        h: A momentum that is that far from R.
        margin: Least distance to R that counts as unreachable.
        straight: Stay on the line through no momentum.
    """
    smallest = _smallest_ahead if straight else _smallest
    known = np.zeros((0, len(rings.ring_of)))
    known, gap = _sheets(rings, starts, known, h)
    farthest = _FIRST * float(np.linalg.norm(h))
    for _ in range(_ROUNDS):
        if np.linalg.norm(gap, axis=1).min() <= margin:
            break  # it is reachable after all
        step = smallest(h, gap, 2 * margin, farthest) - h
        length = float(np.linalg.norm(step))
        if length < 0.1 * margin or farthest < 0.1 * margin:
            break
        trial = h + step * min(1.0, farthest / length)
        angles, rest = _sheets(rings, starts, known, trial)
        outside = distances(rings, starts, trial[None])[0] > margin
        outside &= np.linalg.norm(rest, axis=1).min() > margin
        if outside and np.linalg.norm(trial) < np.linalg.norm(h):
            h, known, gap = trial, angles, rest
        else:
            known = np.concatenate([known, angles])
            farthest = _SHRUNK * min(farthest, length)
            known, gap = _sheets(rings, starts, known, h)
    return h


def _sheets(
    rings: Rings, starts: Starts, known: np.ndarray, h: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return angles (S, c) of local minima around h, the nearest first, and h minus theirs."""
    start = np.concatenate([known[:_KNOWN], starts(h[None])[0]])
    delta, gap = closest(rings, start, np.tile(h, (len(start), 1)))
    order = np.argsort(np.linalg.norm(gap, axis=1))
    return delta[order], gap[order]


def _smallest(h: np.ndarray, gap: np.ndarray, margin: float, near: float) -> np.ndarray:
    """Return the smallest y with u . y >= u . h(delta) + margin for the sheets that are near."""
    u, least = _bounds(h, gap, margin, near)
    rest = nnls(np.column_stack([u, least]).T, np.append(np.zeros(len(h)), 1.0))[0]
    y = np.column_stack([u, least]).T @ rest - np.append(np.zeros(len(h)), 1.0)
    return -y[:-1] / y[-1] if abs(y[-1]) > 1e-12 else h


def _smallest_ahead(h: np.ndarray, gap: np.ndarray, margin: float, near: float) -> np.ndarray:
    """Return the smallest such y along h."""
    u, least = _bounds(h, gap, margin, near)
    ahead = u @ h
    share = least[ahead > 0] / ahead[ahead > 0]
    return h * min(1.0, max(0.0, float(share.max(initial=0.0))))


def _bounds(
    h: np.ndarray, gap: np.ndarray, margin: float, near: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return u and the least u . y for the sheets that are near."""
    size = np.linalg.norm(gap, axis=1)
    close = size < np.maximum(near, 2 * size.min())
    u = gap[close] / size[close, None]
    return u, u @ h - size[close] + margin
