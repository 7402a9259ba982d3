"""One state of an array: how singular it is, what is blocked there, and where null motion leads."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import numpy as np

from nullmotion import singularity
from nullmotion.array.capability import torque_capability
from nullmotion.array.model import CmgArray
from nullmotion.atlas.manifold import SINGULAR, Component, close_by, self_motion
from nullmotion.atlas.passable import passable
from nullmotion.atlas.state_record import State
from nullmotion.singular_kind import TOLERANCE, Form, Kind, form, kind, saturating, working

__all__ = ["State", "inspect"]


def inspect(array: CmgArray, delta: Any, progress: Callable[[float], None] | None = None) -> State:
    """Return all there is to know about gimbal angles.

    Args:
        array: The array; end stops are not looked at.
        delta: Gimbal angles [rad], (n,).
        progress: Called with the finished share. Ctrl-C ends the work.

    Raises:
        InputError: For angles of another number of CMGs, or angles that are not finite.
    """
    start = time.perf_counter()
    report = progress or (lambda share: None)
    angles = singularity.checked_angles(array, delta, single=True)
    measures = {name: float(v) for name, v in singularity.measures(array, angles).items()}
    what = kind(array, angles)
    kept, inner = working(array, angles)
    found = form(kept, inner)
    u = None if found is None else _turned(found)
    along, against = (
        (None, None) if u is None else (passable(array, angles, s * u) for s in (1, -1))
    )
    report(0.1)
    pieces = self_motion(array, array.momentum(angles), through=angles)
    at = np.where(np.asarray(array.h0) > 0, angles, 0.0)
    here = int(np.argmin([piece.distance(at) for piece in pieces]))
    report(1.0)
    return State(
        delta=angles,
        momentum=np.asarray(array.momentum(angles)),
        kind=str(what),
        measures=measures,
        torque_capability=float(torque_capability(array, angles, "optimal")),
        directions=0 if found is None else found.u.shape[1],
        u=u,
        signs=None if u is None else _sides(array, angles, u),
        passable=what in (Kind.REGULAR, Kind.HYPERBOLIC),
        passable_along=along,
        passable_against=against,
        components=pieces,
        here=here,
        escapable=_escapable(what, pieces[here]),
        seconds=time.perf_counter() - start,
    )


def _turned(found: Form) -> np.ndarray:
    """Return the singular direction, turned as `State` says."""
    weights = saturating(found)
    if len(weights):
        middle = weights.sum(axis=0)
        w = middle if np.linalg.norm(middle) > TOLERANCE else weights[0]
        u: np.ndarray = found.u @ w
        return u / np.linalg.norm(u)
    value = np.linalg.eigvalsh(found.matrix(np.eye(found.u.shape[1])[:1])[0])
    blocked = len(value) > 0 and (value[0] > TOLERANCE or value[-1] < -TOLERANCE)
    turn = value[0] < 0 if blocked else found.along[:, 0].sum() < 0
    return found.u[:, 0] * (-1.0 if turn else 1.0)


def _sides(array: CmgArray, delta: np.ndarray, u: np.ndarray) -> np.ndarray:
    along = np.asarray(array.rotor_momenta(delta)) @ u / array.mean_momentum
    return np.where(np.abs(along) > TOLERANCE, np.sign(along), 0.0).astype(int)


def _escapable(what: Kind, piece: Component) -> bool:
    known = close_by(what)
    return piece.best["sigma_min"].value > SINGULAR if known is None else known
