"""A proof that no impassable singular point is nearer than a radius.

Patches of the directions u (`internal_sphere`), for each sign pattern, are left out where all
their momenta are farther out, or all their points hyperbolic; others are cut. |h| is bounded by

    |h| >= |h(u_0)| - sum_i 2 |W_i| sin(turn_i / 2)
    |h| >= w . h(u_0) - |C w| r - 1/2 sum_i |W_i| (2 / sqrt 3) r^2 / |p_i|^2,    w = h / |h|

(|d^2/ds^2 p_i / |p_i|| <= 2 / (sqrt 3 |p_i|^2) along great circles), where W_i is the sum of
epsilon h0 over the CMGs of gimbal axis i; in a cap by the like of the second in its own
coordinates, in which the p_i / |p_i| of the axis itself is a circle. The type is bounded by
`internal_inertia`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from nullmotion.array.model import CmgArray
from nullmotion.atlas.internal_inertia import cases_of, hyperbolic
from nullmotion.atlas.internal_patches import View
from nullmotion.atlas.internal_sphere import Sphere

Progress = Callable[[float], None]

_BATCH = 8000  # patches looked at together
_LEFT = 4000  # of those not done with that are reported
_FINEST = 1e-7  # rad; the lowest patch that is smaller than this is where it ends
_BEND = 2 / np.sqrt(3)
_ROUNDING = 1e-11


class Proof(NamedTuple):
    """A bound from below.

    Attributes:
        radius: No elliptic singular point has a smaller |h| [N m s].
        patches: Number of patches looked at.
        u: Directions where it could not be shown farther out, the lowest first, (p, 3).
        signs: Sign patterns of these, (p, n).
    """

    radius: float
    patches: int
    u: np.ndarray
    signs: np.ndarray


def nothing_within(
    array: CmgArray,
    signs: np.ndarray,
    wanted: float,
    budget: int,
    progress: Progress | None = None,
) -> Proof:
    """Return a radius within which no point of some sign patterns is elliptic.

    Args:
        array: The array, with m = 3, all CMGs with momentum.
        signs: The patterns, (k, n), none of them of one sign only.
        wanted: The radius to be proven [N m s]: more is not tried.
        budget: Number of patches after which what is proven has to do.
        progress: Called with the share that is proven.
    """
    if wanted < _ROUNDING * array.mean_momentum:
        return Proof(0.0, 0, np.zeros((0, 3)), signs[:0])
    sphere, unit = Sphere(array), float(array.mean_momentum)
    case = cases_of(sphere, np.asarray(array.h0, float) / unit, signs)
    target, looked = wanted / unit, 0
    patches = sphere.cover(len(case.weights))
    low = np.zeros(len(patches))
    fine = False
    while len(patches) and looked < budget and not fine:
        order = np.argsort(low, kind="stable")
        first, rest = order[:_BATCH], order[_BATCH:]
        here = patches.take(first)
        view, cases = sphere.view(here), case.take(here.pattern)
        bound = np.maximum(size_bound(view, cases.weights), low[first])
        left = (bound < target) & ~view.covered
        left[left] &= ~hyperbolic(_part(view, left), cases.take(left))
        cut = here.take(left).halves(view.wide[left])
        low = np.concatenate([low[rest], np.tile(bound[left], 2)])
        patches, looked = patches.take(rest).joined(cut), looked + len(first)
        fine = left[0] and view.radius[0] < _FINEST
        if progress is not None:
            progress(min(1.0, max(low.min(initial=target) / target, looked / budget)))
    patches = patches.take(np.argsort(low, kind="stable")[:_LEFT])
    radius = unit * min(target, float(low.min(initial=np.inf)))
    return Proof(radius, looked, sphere.view(patches).u, case.signs[patches.pattern])


def _part(view: View, which: np.ndarray) -> View:
    return View(*(value[which] for value in view))


def size_bound(view: View, weights: np.ndarray) -> np.ndarray:
    """Return a lower bound of |h| over patches, in units of the mean momentum, (B,)."""
    h = np.einsum("bn,bnk->bk", weights, view.towards)
    size, share = np.linalg.norm(h, axis=1), np.abs(weights)
    first = size - np.sum(2 * np.sin(0.5 * view.turn) * share, axis=1)
    w = h / np.maximum(size, 1e-300)[:, None]
    with np.errstate(divide="ignore", invalid="ignore"):
        pull = weights / view.across * np.einsum("bnk,bk->bn", view.column, w)
        bend, drag = _BEND * share / view.least_around**2, share / view.least_around
        slope = np.linalg.norm(np.einsum("bn,bnk->bk", pull, view.column), axis=1)
        disc = size - slope * view.radius - 0.5 * np.sum(bend, axis=1) * view.radius**2
        rest = np.einsum("bn,bnk->bk", np.where(view.own, 0.0, pull), view.column)
        steps = np.einsum("bck,bk->bc", view.moves, rest)
        own = np.sum(np.where(view.own, weights, 0.0), axis=1)
        steps[:, 1] += view.half * own * np.einsum("bk,bk->b", view.azimuth, w)
        turned = np.where(view.own, share * view.half[:, None] ** 2, 0.0)
        other = bend * view.speed[:, None] + drag * view.veer[:, None]
        second = np.sum(np.where(view.own, turned, other), axis=1)
        cap = size - np.abs(steps).sum(axis=1) - 0.5 * second
    return np.fmax(np.fmax(first, disc), cap) - _ROUNDING
