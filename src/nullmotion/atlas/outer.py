"""The outer surface: the sheet of all plus signs, which is not the envelope.

    h(u) = sum_i h0_i p_i / |p_i|,    p_i = u - (u . g_i) g_i

is the momentum that is farthest along u. Where u is along a gimbal axis the sheet has a hole,
bounded by a circle; the reachable momenta go on below it. The least |h| of this sheet is what
tools print that know no other one.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.optimize import minimize

from nullmotion.array.model import CmgArray
from nullmotion.atlas.envelope_rings import Rings, rings

_DIRECTIONS = 20_000
_POLISHED = 24  # of the directions with the least |h|
_APART = 0.05  # [rad] between directions that are polished
_EXACT = 1e-12
_ALONG = 1e-9  # length of p_i at which u counts as along a gimbal axis


class Outer(NamedTuple):
    """The momentum of the outer surface with the least size.

    Attributes:
        radius: Its size [N m s].
        momentum: The momentum without the array's bias [N m s], (m,).
        u: The direction along which it is the farthest one, (m,).
    """

    radius: float
    momentum: np.ndarray
    u: np.ndarray


def outer_surface(array: CmgArray) -> Outer:
    """Return the least |h| on the outer surface, the rims of its holes included.

    The least of 20,000 directions, the lowest of them polished; the rims in closed form. CMGs
    with parallel gimbal axes count as one (`envelope_rings`).
    """
    found = rings(array)
    candidates = [*_smooth(found), *_rims(found)]
    h, u = min(candidates, key=lambda pair: float(np.linalg.norm(pair[0])))
    return Outer(float(np.linalg.norm(h)) * found.unit, h * found.unit, u)


def _smooth(found: Rings) -> list[tuple[np.ndarray, np.ndarray]]:
    u = _directions(found.m)
    size = np.linalg.norm(found.top(u), axis=1)
    order, chosen = np.argsort(size), list[int]()
    for i in order[:2000]:
        if all(abs(u[i] @ u[j]) < np.cos(_APART) for j in chosen):
            chosen.append(int(i))
        if len(chosen) == _POLISHED:
            break
    return [_polished(found, u[i]) for i in chosen]


def _polished(found: Rings, u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the local minimum of |h| next to a direction, and its direction."""
    if found.m == 1:
        return found.top(u), u
    tangents = np.linalg.svd(u[None])[2][1:]

    def direction(s: np.ndarray) -> np.ndarray:
        w = u + s @ tangents
        return np.asarray(w / np.linalg.norm(w))

    def size(s: np.ndarray) -> float:
        return float(np.linalg.norm(found.top(direction(s))))

    options = {"xatol": 1e-10, "fatol": _EXACT, "initial_simplex": _simplex(found.m - 1)}
    best = minimize(size, np.zeros(found.m - 1), method="Nelder-Mead", options=options)
    turned = direction(best.x)
    return found.top(turned), turned


def _simplex(d: int) -> np.ndarray:
    return np.concatenate([np.zeros((1, d)), 0.01 * np.eye(d)])


def _rims(found: Rings) -> list[tuple[np.ndarray, np.ndarray]]:
    """Return the nearest momentum on each hole's rim: along u all of its ring is as far."""
    pairs = []
    for k, frame in enumerate(found.frames):
        normal = np.linalg.svd(frame)[2][2:]  # none where the ring is seen at an angle, m = 2
        for u in (*normal, *-normal):
            others = _without(found, k).top(u)
            across = others - (others @ u) * u
            size = float(np.linalg.norm(across))
            inward = -across / size if size > _ALONG else frame[0] / np.linalg.norm(frame[0])
            pairs.append((others + found.outer[k] * inward, u))
    return pairs


def _without(found: Rings, k: int) -> Rings:
    keep = np.arange(len(found.inner)) != k
    return Rings(found.frames[keep], found.inner[keep], found.outer[keep], found.unit)


def _directions(m: int) -> np.ndarray:
    """Return unit vectors that cover half of the directions evenly, (N, m)."""
    if m == 1:
        return np.ones((1, 1))
    if m == 2:
        angle = np.pi * np.arange(_DIRECTIONS) / _DIRECTIONS
        return np.column_stack([np.cos(angle), np.sin(angle)])
    k = np.arange(_DIRECTIONS)
    z = 1 - (k + 0.5) / _DIRECTIONS
    turn = np.pi * (3 - np.sqrt(5)) * k
    across = np.sqrt(1 - z * z)
    return np.column_stack([across * np.cos(turn), across * np.sin(turn), z])
