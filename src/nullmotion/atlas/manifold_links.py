"""Which angles of one momentum hang together: found by walking from one to the other.

A walk goes along the null space of A towards its target and is held to the momentum; arriving
proves that the two belong together, getting stuck proves nothing. So many pairs are tried, and
the number of pieces that are left is an upper bound.
"""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from nullmotion.atlas.manifold_rotors import Rotors
from nullmotion.atlas.manifold_seeds import held, wrapped

_STRIDE = 0.15  # rad
_STRIDES = 150
_ARRIVED = 0.02  # rad; a gap that is checked at its middle
_HELD = 1e-7  # momentum error of a walk over the mean momentum
_SHARP = 1e-10  # squared singular value of A that counts as none
_IDLE = 5  # rounds without a new link that end the search
_NEAREST = 6


def pieces(rotors: Rotors, points: np.ndarray, momentum: np.ndarray) -> np.ndarray:
    """Return the number of the piece that each of the angles (k, n) belongs to, (k,)."""
    label, idle = np.arange(len(points)), 0
    links: list[np.ndarray] = []
    distance = np.linalg.norm(wrapped(points[:, None] - points), axis=-1)
    rng = np.random.default_rng(0)
    while label.max(initial=0) > 0 and idle < _IDLE:
        pairs = _pairs(distance, label, rng)
        there = walks(rotors, points[pairs[:, 0]], points[pairs[:, 1]], momentum)
        links.append(pairs[there])
        idle = 0 if there.any() else idle + 1
        edge = np.concatenate(links)
        graph = coo_array((np.ones(len(edge)), (edge[:, 0], edge[:, 1])), shape=distance.shape)
        label = connected_components(graph, directed=False)[1]
    return label


def _pairs(distance: np.ndarray, label: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Return one walk for each point outside the largest piece: to a near one of another."""
    outside = np.flatnonzero(label != np.bincount(label).argmax())
    apart = np.where(label[outside, None] == label, np.inf, distance[outside])
    near = np.argsort(apart, axis=1)[:, :_NEAREST]
    chosen = near[np.arange(len(outside)), rng.integers(near.shape[1], size=len(outside))]
    good = np.isfinite(apart[np.arange(len(outside)), chosen])
    return np.stack([outside, chosen], axis=1)[good]


def walks(
    rotors: Rotors, start: np.ndarray, target: np.ndarray, momentum: np.ndarray
) -> np.ndarray:
    """Return which walks from angles (k, n) to others of the same momentum arrive, (k,)."""
    here, there = start.copy(), np.zeros(len(start), bool)
    going = np.arange(len(start))
    for _ in range(_STRIDES):
        left = wrapped(target[going] - here[going])
        size = np.linalg.norm(left, axis=1)
        close = size < _ARRIVED
        there[going[close]] = _joined(rotors, here[going[close]], left[close], momentum)
        going, left, size = going[~close], left[~close], size[~close]
        if not len(going):
            break
        onward = _along(rotors, here[going], left) * np.minimum(1.0, _STRIDE / size)[:, None]
        new = held(rotors, here[going] + onward, momentum, 8)
        nearer = np.linalg.norm(wrapped(target[going] - new), axis=1) < size - 1e-4
        held_on = np.abs(rotors.missing(new, momentum)).max(axis=1) < _HELD
        here[going] = new
        going = going[nearer & held_on]
    return there


def _along(rotors: Rotors, delta: np.ndarray, heading: np.ndarray) -> np.ndarray:
    """Return the part of headings (k, n) in the null space of A."""
    A = rotors.unit_jacobian(delta)
    square = A @ A.mT + _SHARP * np.eye(rotors.m)
    across: np.ndarray = A.mT @ np.linalg.solve(square, A @ heading[..., None])
    return heading - across[..., 0]


def _joined(rotors: Rotors, here: np.ndarray, gap: np.ndarray, momentum: np.ndarray) -> np.ndarray:
    """Return whether the middle of each small gap is on the self-motion set, (k,)."""
    middle = here + 0.5 * gap
    off = np.linalg.norm(held(rotors, middle, momentum, 8) - middle, axis=1)
    good: np.ndarray = off <= 0.1 * np.linalg.norm(gap, axis=1) + 1e-6
    return good
