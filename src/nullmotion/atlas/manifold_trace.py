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
_BULGE = 0.05  # of a chord: how far a curve is from it (an eighth of its turn)
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
        last = np.array([path[-1], here])
        beside = float(np.linalg.norm(wrapped(start - here))) < 2 * _LONGEST
        if beside and len(path) > 2 and lie_on(rotors, start[None], last, momentum)[0]:
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


def lie_on(
    rotors: Rotors, points: np.ndarray, angles: np.ndarray, momentum: np.ndarray
) -> np.ndarray:
    """Return which regular angles (k, n) of the momentum are on a curve through points (P, n).

    Such an angle is as close to a chord as the curve is, and what Newton's method makes of its
    foot on the chord. (Beside a crossing it would lead from one curve to the other.)
    """
    begin, chord = angles[:-1], np.diff(angles, axis=0)
    size = np.linalg.norm(chord, axis=1)
    away = wrapped(points[:, None] - begin)  # (k, P - 1, n)
    share = np.clip(np.einsum("kpn,pn->kp", away, chord) / size**2, -0.01, 1.01)
    off = np.linalg.norm(away - share[..., None] * chord, axis=2)
    place = np.argmin(off / size, axis=1)
    rows = np.arange(len(points))
    foot = points - away[rows, place] + share[rows, place, None] * chord[place]
    found = off[rows, place] < _BULGE * size[place]
    tangent = np.linalg.svd(rotors.unit_jacobian(points[found]))[2][:, -1]
    found[found] = _meets(rotors, points[found], tangent, foot[found], momentum)
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
