"""Components of a self-motion set, put together from curves, singular points and samples."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import combinations
from typing import Any

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from nullmotion.atlas.manifold_best import Best, best
from nullmotion.atlas.manifold_curves import SAME, SINGULAR, curves
from nullmotion.atlas.manifold_links import pieces
from nullmotion.atlas.manifold_rotors import Rotors
from nullmotion.atlas.manifold_seeds import wrapped
from nullmotion.atlas.manifold_trace import Curve

_FEW = 8  # singular solutions up to which each is a place to look for curves


@dataclass(frozen=True, eq=False)
class Component:
    """A connected piece of a self-motion set.

    Attributes:
        momentum: The momentum [N m s], (m,).
        points: Gimbal angles on it in [-pi, pi) [rad], (P, n): along its curves, or samples.
        curves: What it is made of where n = m + 1; else empty.
        crossings: Singular angles where its curves meet or end [rad], (c, n).
        best: ``sigma_min`` and ``sqrt_det_AAT`` at their largest on it.
        followed: Whether it was followed as curves: it is then connected as said. Otherwise
            it was put together from samples: it is connected, but two components may be one.
    """

    momentum: np.ndarray
    points: np.ndarray
    curves: tuple[Curve, ...]
    crossings: np.ndarray
    best: Mapping[str, Best]
    followed: bool

    @property
    def length(self) -> float:
        """Length of its curves, the 2-norm over the CMGs [rad]."""
        return sum(curve.length for curve in self.curves)

    def distance(self, delta: Any) -> float:
        """Return how far gimbal angles (n,) are from the nearest of `points` [rad]."""
        away = wrapped(self.points - np.asarray(delta, float))
        return float(np.linalg.norm(away, axis=1).min())


def followed(rotors: Rotors, points: np.ndarray, momentum: np.ndarray) -> list[Component]:
    """Return the components for n = m + 1."""
    sigma = rotors.sigma_min(points)
    singular = _distinct(points[sigma <= SINGULAR])
    few = singular if len(singular) <= _FEW else singular[:0]
    found, crossings = curves(rotors, points[sigma > SINGULAR], few, momentum)
    nodes = _distinct(np.concatenate([crossings, singular]))
    label = pieces(rotors, nodes, momentum)
    links = [(a, b) for a, b in combinations(range(len(nodes)), 2) if label[a] == label[b]]
    for k, curve in enumerate(found):
        for end in () if curve.closed else (curve.angles[0], curve.angles[-1]):
            away = np.linalg.norm(wrapped(nodes - end), axis=1)
            links += [(len(nodes) + k, int(j)) for j in np.flatnonzero(away < 2 * SAME)]
    group = _groups(len(nodes) + len(found), links)
    return [
        _component(rotors, momentum, nodes[group[: len(nodes)] == g],
                   [c for c, of in zip(found, group[len(nodes) :], strict=True) if of == g], True)
        for g in range(group.max(initial=-1) + 1)
    ]  # fmt: skip


def sampled(rotors: Rotors, points: np.ndarray, momentum: np.ndarray) -> list[Component]:
    """Return the components for other n, from samples."""
    points = _distinct(points)
    label = pieces(rotors, points, momentum)
    return [
        _component(rotors, momentum, points[label == k], [], False)
        for k in range(label.max(initial=-1) + 1)
    ]


def _component(
    rotors: Rotors, momentum: np.ndarray, points: np.ndarray, parts: list[Curve], followed: bool
) -> Component:
    every = np.concatenate([points, *[wrapped(c.angles) for c in parts]])

    measures = {"sigma_min": rotors.sigma_min, "sqrt_det_AAT": rotors.sqrt_det_AAT}
    top = {name: best(rotors, every, momentum, f) for name, f in measures.items()}
    crossings = points if followed else points[:0]
    return Component(momentum, every, tuple(parts), crossings, top, followed)


def _distinct(points: np.ndarray) -> np.ndarray:
    """Return angles (k, n) without those within `SAME` of an earlier one."""
    kept: list[np.ndarray] = []
    for point in points:
        if not kept or np.linalg.norm(wrapped(np.array(kept) - point), axis=1).min() > SAME:
            kept.append(point)
    return np.reshape(kept, (-1, points.shape[1]))


def _groups(count: int, links: list[tuple[int, int]]) -> np.ndarray:
    edge = np.reshape(links, (-1, 2)).astype(int)
    graph = coo_array((np.ones(len(edge)), (edge[:, 0], edge[:, 1])), shape=(count, count))
    label: np.ndarray = connected_components(graph, directed=False)[1]
    return label
