"""An impassable singular point inside the reachable momenta."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from nullmotion.array.model import CmgArray
from nullmotion.atlas.internal_points import Point, momenta
from nullmotion.atlas.manifold_rotors import Rotors
from nullmotion.atlas.manifold_seeds import CLOSE, held
from nullmotion.singular_kind import form, kind, working

_EDGE = 1e-6  # part of h across u over the mean momentum, above which |h| is not stationary
_STARTS, _BEYOND = 400, 1e-3  # how it is found out whether there is more momentum beyond


@dataclass(frozen=True, eq=False)
class Impassable:
    """The impassable internal singular point of the least momentum.

    Attributes:
        radius: |h| without the array's bias [N m s]: an upper bound of the least one.
        lower: No impassable point is nearer [N m s]: a proven lower bound; 0 where there is none.
        momentum: h without the array's bias [N m s], (m,).
        delta: Gimbal angles [rad], (n,).
        u: Unit singular direction in which the momentum cannot go on from there, (m,).
        signs: Side of u that each rotor is on, (n,); 1 for a CMG without momentum.
        kind: Type of these angles, as `nullmotion.singularity.classify` has it.
        eigenvalues: Those of Q, which is positive, over the mean momentum, (n - m + 1,): how much
            momentum along u a null motion would cost. Next to 0: only just impassable, as in
            arrays that would have none if their momenta were equal.
        edge: Whether it lies on the edge of the elliptic points, where |h| is not stationary:
            this one is elliptic, but only just.
        inside: Whether there is more momentum beyond it, with other gimbal angles. If not, it
            is part of the envelope's border, and what is inside is farther out.
        points: Number of singular points that were searched.
        basis: What the lower bound rests on.
        seconds: Time it took [s].
    """

    radius: float
    lower: float
    momentum: np.ndarray
    delta: np.ndarray
    u: np.ndarray
    signs: np.ndarray
    kind: str
    eigenvalues: np.ndarray
    edge: bool
    inside: bool
    points: int
    basis: str
    seconds: float

    def as_dict(self) -> dict[str, Any]:
        """Return the point for a JSON file, angles in degrees."""
        return {
            "radius": self.radius,
            "lower": self.lower,
            "basis": self.basis,
            "momentum": self.momentum.tolist(),
            "gimbal_deg": np.degrees(self.delta).tolist(),
            "u": self.u.tolist(),
            "signs": self.signs.astype(int).tolist(),
            "kind": self.kind,
            "eigenvalues": self.eigenvalues.tolist(),
            "edge": self.edge,
            "inside": self.inside,
            "seconds": round(self.seconds, 3),
        }


def described(
    array: CmgArray, point: Point, lower: float, basis: str, points: int, seconds: float
) -> Impassable:
    """Return what there is to say about a point of the CMGs that have momentum."""
    kept, _ = working(array, np.zeros(array.n))
    here = momenta(kept, point.u, point.signs)
    value = _eigenvalues(kept, here.delta, point.u)
    side = -1.0 if len(value) and value[0] < 0 else 1.0
    at = np.flatnonzero(np.asarray(array.h0) > 0)
    delta, signs = np.zeros(array.n), np.ones(array.n)
    delta[at], signs[at] = here.delta, side * point.signs
    u, h = side * point.u, here.momentum
    across = np.linalg.norm(h - (h @ u) * u)
    return Impassable(
        radius=point.size,
        lower=min(lower, point.size),
        momentum=h,
        delta=delta,
        u=u,
        signs=signs,
        kind=str(kind(array, delta)),
        eigenvalues=np.sort(np.abs(value)),
        edge=bool(across > _EDGE * array.mean_momentum),
        inside=_more_beyond(kept, here.delta, u),
        points=points,
        basis=basis,
        seconds=seconds,
    )


def _eigenvalues(array: CmgArray, delta: np.ndarray, u: np.ndarray) -> np.ndarray:
    """Return the eigenvalues of Q for u over the mean momentum."""
    found = form(array, delta)
    assert found is not None
    value: np.ndarray = np.linalg.eigvalsh(found.matrix(np.atleast_2d(found.u.T @ u))[0])
    return value


def _more_beyond(array: CmgArray, delta: np.ndarray, u: np.ndarray) -> bool:
    """Return whether gimbal angles are found whose momentum is a little farther along u."""
    wanted = array.momentum(delta) + _BEYOND * array.mean_momentum * u
    starts = np.random.default_rng(0).uniform(-np.pi, np.pi, (_STARTS, array.n))
    rotors = Rotors(array)
    missing = rotors.missing(held(rotors, starts, wanted, 60), wanted)
    return bool((np.abs(missing).max(axis=1) < CLOSE).any())
