"""Self-motion of arrays with n = m + 1: curves, followed by predictor and corrector.

The predictor goes along the null vector of A, the corrector back to the momentum by least
steps; the length of a step follows the turn of the null vector. Where two curves cross, the
array is singular and det [A; t] changes sign. The same jump would lead from one curve to
another that comes close, so the step is cut before it is believed: a crossing is what is left
of it at the shortest step, and there the curve ends.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nullmotion.atlas.manifold_rotors import Rotors
from nullmotion.atlas.manifold_seeds import CLOSE, held, wrapped

_LONGEST, _SHORTEST = 0.05, 1e-6  # rad
_TURN = 0.08  # rad, of the null vector that a step aims at; three times that is refused
_MOST_STEPS = 20_000
_SAME = 1e-7  # rad; points closer than this are one
_NEAREST = 3  # points of a curve beside which others are looked for
_DAMPING = 1e-15


@dataclass(frozen=True, eq=False)
class Curve:
    """A piece of the self-motion set of one dimension.

    Attributes:
        angles: Gimbal angles along it [rad], (P, n), continuous; a closed curve ends where it
            began, up to whole turns.
        closed: Whether it comes back to its beginning; otherwise it ends at singular points
            on both sides, where curves cross.
    """

    angles: np.ndarray
    closed: bool

    @property
    def length(self) -> float:
        """Its length, the 2-norm over the CMGs [rad]."""
        return float(np.linalg.norm(np.diff(self.angles, axis=0), axis=1).sum())

    @property
    def turns(self) -> np.ndarray:
        """Whole turns of each gimbal along a closed curve, (n,)."""
        found: np.ndarray = np.rint((self.angles[-1] - self.angles[0]) / (2 * np.pi)).astype(int)
        return found


def trace(rotors: Rotors, start: np.ndarray, momentum: np.ndarray) -> Curve:
    """Return the curve of constant momentum through regular angles (n,) [rad]."""
    tangent = null_vector(rotors, start)
    ahead, closed = _follow(rotors, start, tangent, momentum)
    if closed:
        return Curve(np.array(ahead), True)
    behind, _ = _follow(rotors, start, -tangent, momentum)
    return Curve(np.array([*behind[:0:-1], *ahead]), False)


def null_vector(rotors: Rotors, delta: np.ndarray) -> np.ndarray:
    """Return a unit null vector of A at angles (n,), the one of the least singular value."""
    vector: np.ndarray = np.linalg.svd(rotors.unit_jacobian(delta))[2][-1]
    return vector


def _follow(
    rotors: Rotors, start: np.ndarray, tangent: np.ndarray, momentum: np.ndarray
) -> tuple[list[np.ndarray], bool]:
    """Return points from a start on, and whether they come back to it."""
    path, heading, size = [start], tangent, 0.3 * _LONGEST
    for _ in range(_MOST_STEPS):
        step = _step(rotors, path[-1], heading, momentum, size)
        if step is None:
            break
        here, heading, size = step
        if len(path) > 2 and _passes(rotors, start, tangent, path[-1], here, momentum):
            turns = 2 * np.pi * np.rint((here - start) / (2 * np.pi))
            return [*path, start + turns], True
        path.append(here)
    return path, False


def _step(
    rotors: Rotors, here: np.ndarray, heading: np.ndarray, momentum: np.ndarray, size: float
) -> tuple[np.ndarray, np.ndarray, float] | None:
    """Return the next point, the heading there and the size of the next step; None at an end."""
    side = _side(rotors, here, heading)
    while size > _SHORTEST:
        guess = here + size * heading
        found = held(rotors, guess[None], momentum, 4)[0]
        onward = null_vector(rotors, found)
        onward = onward if onward @ heading > 0 else -onward
        turn = float(np.arccos(np.clip(onward @ heading, -1, 1)))
        near = np.linalg.norm(found - guess) < 0.3 * size
        good = np.abs(rotors.missing(found, momentum)).max() < 10 * CLOSE
        if good and near and turn < 3 * _TURN and _side(rotors, found, onward) == side:
            return found, onward, min(_LONGEST, size * min(2.0, _TURN / max(turn, 1e-3)))
        size /= 2
    return None


def _side(rotors: Rotors, delta: np.ndarray, heading: np.ndarray) -> bool:
    return bool(np.linalg.det(np.vstack([rotors.unit_jacobian(delta), heading])) > 0)


def _passes(
    rotors: Rotors, point: np.ndarray, tangent: np.ndarray, begin: np.ndarray, end: np.ndarray,
    momentum: np.ndarray,
) -> bool:  # fmt: skip
    """Return whether a short piece of the curve goes through a point of the self-motion set."""
    chord, away = end - begin, wrapped(point - begin)
    size = float(np.linalg.norm(chord))
    share = float(away @ chord) / (size * size)
    if not -0.01 < share < 1.01 or np.linalg.norm(away - share * chord) > 0.2 * size:
        return False
    near = point - away + share * chord
    return bool(_meets(rotors, point[None], tangent[None], near[None], momentum)[0])


def lie_on(rotors: Rotors, points: np.ndarray, curve: Curve, momentum: np.ndarray) -> np.ndarray:
    """Return which regular angles (k, n) of the momentum are on a curve, (k,)."""
    away = wrapped(points[:, None] - curve.angles)  # (k, P, n)
    distance = np.linalg.norm(away, axis=2)
    order = np.argsort(distance, axis=1)[:, :_NEAREST]
    tangent = np.linalg.svd(rotors.unit_jacobian(points))[2][:, -1]
    rows, found = np.arange(len(points)), np.zeros(len(points), bool)
    for k in order.T:
        close = distance[rows, k] < 2 * _LONGEST
        found |= close & _meets(rotors, points, tangent, points - away[rows, k], momentum)
    return found


def _meets(
    rotors: Rotors, point: np.ndarray, tangent: np.ndarray, near: np.ndarray, momentum: np.ndarray
) -> np.ndarray:
    """Return whether the curve beside ``near`` meets the plane normal to its tangent at a point.

    All (k, n); Newton's method for both conditions.
    """
    here = near
    for _ in range(8):
        J = np.concatenate([rotors.unit_jacobian(here), tangent[:, None]], axis=1)
        ahead = np.sum(tangent * (point - here), axis=1)
        lack = np.concatenate([rotors.missing(here, momentum), ahead[:, None]], axis=1)
        square = J @ J.mT + _DAMPING * np.eye(rotors.n)
        move = (J.mT @ np.linalg.solve(square, lack[..., None]))[..., 0]
        size = np.linalg.norm(move, axis=1, keepdims=True)
        here = here + move * np.minimum(1.0, _LONGEST / np.maximum(size, 1e-300))
    met: np.ndarray = np.linalg.norm(here - point, axis=1) < _SAME
    return met
