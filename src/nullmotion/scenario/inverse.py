"""Gimbal angles at which an array has a given momentum."""

from __future__ import annotations

import numpy as np

from nullmotion.array import CmgArray

_RESTARTS, _ROUNDS, _HALVINGS = 31, 60, 14
_ENOUGH = 0.75  # share of the starts that has to arrive
_PULL = 0.1  # share of the way home that null motion goes in a step
_SEED = 20210615
_TOLERANCE, _ARRIVED = 1e-9, 1e-13  # of the mean momentum: accepted, no further step


def angles_with_momentum(
    array: CmgArray, wanted: np.ndarray, home: np.ndarray
) -> np.ndarray | None:
    """Return angles with h(delta) = wanted, nearest to home, within the angle limits.

    Damped Gauss-Newton steps from home and from random angles (the same every time), then
    steps that shorten the way from home at the same momentum. The nearest that is found.

    Args:
        array: The array.
        wanted: Its momentum [N m s], (m,).
        home: Angles to be near to [rad], (n,).

    Returns:
        Angles [rad], (n,); None if none are found: outside the envelope.
    """
    found = _solved(array, wanted, home, 0.0, _starts(array, home))
    found = found[_error(array, wanted, found) < _TOLERANCE]
    if not len(found):
        return None
    near = _solved(array, wanted, home, _PULL, _turned_to(array, home, found))
    near = _solved(array, wanted, home, 0.0, near)
    found = np.concatenate([near, found])
    found = found[_error(array, wanted, found) < _TOLERANCE]
    way = np.linalg.norm(found - home, axis=1)
    nearest: np.ndarray = found[int(np.argmin(np.round(way, 6)))]
    return nearest


def reach(array: CmgArray, wanted: np.ndarray, home: np.ndarray) -> float:
    """Return the size [N m s] up to which momenta along an unreachable one are reached."""
    low, high, starts = 0.0, 1.0, _starts(array, home)
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        found = _solved(array, middle * wanted, home, 0.0, starts)
        if (_error(array, middle * wanted, found) < _TOLERANCE).any():
            low = middle
        else:
            high = middle
    return low * float(np.linalg.norm(wanted))


def _starts(array: CmgArray, home: np.ndarray) -> np.ndarray:
    around = np.random.default_rng(_SEED).uniform(-np.pi, np.pi, (_RESTARTS, array.n))
    starts: np.ndarray = array.within_angle_limits(np.vstack([home, home + around]))
    return starts


def _error(array: CmgArray, wanted: np.ndarray, delta: np.ndarray) -> np.ndarray:
    off = np.linalg.norm(wanted - array.momentum(delta), axis=1)
    error: np.ndarray = off / float(array.mean_momentum)
    return error


def _solved(
    array: CmgArray, wanted: np.ndarray, home: np.ndarray, pull: float, delta: np.ndarray
) -> np.ndarray:
    """Return angles (k, n) after steps towards a momentum, and home by null motion if pulled."""
    scale = float(array.mean_momentum)
    for _ in range(_ROUNDS):
        A = array.jacobian(delta) / scale
        e = (wanted - array.momentum(delta)) / scale
        if not pull and np.mean(np.linalg.norm(e, axis=1) < _ARRIVED) >= _ENOUGH:
            break
        damping = np.minimum(0.1, np.einsum("km,km->k", e, e)) + 1e-12
        away = pull * (delta - home)
        e = e + np.einsum("kmn,kn->km", A, away)
        AAT = A @ A.transpose(0, 2, 1) + damping[:, None, None] * np.eye(array.m)
        step = np.einsum("kmn,km->kn", A, np.linalg.solve(AAT, e[:, :, None])[:, :, 0]) - away
        size = np.linalg.norm(step, axis=1, keepdims=True)
        delta = array.within_angle_limits(delta + step / np.maximum(1.0, size))
    return delta


def _turned_to(array: CmgArray, home: np.ndarray, delta: np.ndarray) -> np.ndarray:
    """Return the same angles less whole turns, where the angle limits allow it."""
    low, high = array.angle_limits.T
    near = home + (delta - home + np.pi) % (2 * np.pi) - np.pi
    turned: np.ndarray = np.where((low <= near) & (near <= high), near, delta)
    return turned
