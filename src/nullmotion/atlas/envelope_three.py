"""A proof that all momenta of a convex hull are reachable by three circles in space.

Without null motion there are momenta all of whose angles are singular and that are reachable
from all sides none the less, along whole curves: cusps, where a momentum is like x^3. No
expansion shows that, a change of sign does. With circle i at the angle phi, y = h - h_i(phi) is
to be the sum of circles j and k. Let w = g_j x g_k / s, s = |g_j x g_k|: w lies in both planes, and

    x_j = y . g_k / s,    x_k = y . g_j / s       components of h_j and h_k across w (up to signs)
    y . w = z_j + z_k,    z = +-sqrt(r^2 - x^2)

so that for each pair of signs the defect  f(phi) = y . w - z_j - z_k  is continuous where both
roots exist; where one ends its two signs meet. If f changes sign between two angles on one
such branch for every y of the hull, every momentum of the hull is reachable.

Everything is linear in h but the roots, which are monotonic in |x|: bounds over the hull's
corners are bounds over the hull. Between two angles of the grid x leaves the line between its
ends by less than |g . h_i| step^2 / 8.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from nullmotion.atlas.envelope_rings import Rings

_STEPS = 96  # angles of circle i
_OBLIQUE = 0.05  # least sine between the gimbal axes of circles j and k
_TINY = 1e-11
_ORDERS = ((0, 1, 2), (1, 2, 0), (2, 0, 1))


def applies(rings: Rings) -> bool:
    """Return whether an array has three circles in three dimensions."""
    return rings.m == 3 and len(rings.ring_of) == 3


def proven(rings: Rings, hulls: np.ndarray) -> np.ndarray:
    """Return which hulls (B, p, 3) are reachable for certain, (B,)."""
    normal = np.cross(rings.circles[:, 0], rings.circles[:, 1])
    radius = np.linalg.norm(rings.circles[:, 0], axis=1)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    good = np.zeros(len(hulls), bool)
    for i, j, k in _ORDERS:
        left = np.flatnonzero(~good)
        across = np.cross(normal[j], normal[k])
        size = np.linalg.norm(across)
        if size < _OBLIQUE or len(left) == 0:
            continue
        axes = np.stack([across / size, normal[k] / size, normal[j] / size])
        sweep = _sweep(rings.circles[i], axes, radius[[j, k]], hulls[left])
        good[left] = sweep.proves() | sweep.backwards().proves()
    return good


class _Sweep(NamedTuple):
    """What is known over a hull on the grid of angles phi, the last axis.

    Attributes:
        sign: 1 or -1 where f has this sign all over the hull, else 0; (2, 2, B, N) for the
            signs + and - of z_j and of z_k.
        most: Greatest |x| / r of j and k, (2, B, N).
        least: Least |x| / r, (2, B, N).
        sag: By how much |x| / r may exceed both ends of a step, (2, 1).
    """

    sign: np.ndarray
    most: np.ndarray
    least: np.ndarray
    sag: np.ndarray

    def backwards(self) -> _Sweep:
        """Return the same with phi running down."""
        return _Sweep(*(v[..., ::-1] for v in self[:3]), self.sag)

    def proves(self) -> np.ndarray:
        """Return where f changes sign on a branch, (B,)."""
        after = np.roll(self.most, -1, axis=-1)
        goes_on = np.maximum(self.most, after) + self.sag[..., None] < 1.0 - _TINY
        ended = np.roll(self.least, -1, axis=-1) > 1.0 + _TINY
        meets = (self.most < 1.0 - _TINY).all(axis=0) & ended & goes_on[::-1]
        linked = goes_on.all(axis=0)
        last = np.zeros(self.sign.shape[:-1], np.int8)
        found = np.zeros(last.shape[2], bool)
        for a in np.tile(np.arange(_STEPS), 2):
            here = self.sign[..., a]
            found |= (last * here < 0).any(axis=(0, 1))
            last = np.where(here != 0, here, last)
            found |= meets[0, :, a] & (last[0] * last[1] < 0).any(axis=0)
            found |= meets[1, :, a] & (last[:, 0] * last[:, 1] < 0).any(axis=0)
            last = np.where(linked[:, a], last, np.int8(0))
        return found


def _sweep(circle: np.ndarray, axes: np.ndarray, radius: np.ndarray, hulls: np.ndarray) -> _Sweep:
    """Return signs and extents for circle i, the axes of y . w, x_j, x_k, and r_j, r_k."""
    phi = 2 * np.pi * np.arange(_STEPS) / _STEPS
    turning = circle @ axes.T  # (2, 3)
    own = np.cos(phi)[:, None] * turning[0] + np.sin(phi)[:, None] * turning[1]  # (N, 3)
    along = hulls @ axes.T
    low = np.moveaxis(along.min(axis=1)[:, None] - own, -1, 0)  # (3, B, N)
    high = np.moveaxis(along.max(axis=1)[:, None] - own, -1, 0)
    r = radius[:, None, None]
    most = np.maximum(-low[1:], high[1:]) / r
    least = np.maximum(np.maximum(low[1:], -high[1:]), 0.0) / r
    valid = (most < 1.0 - _TINY).all(axis=0)
    root = r * np.sqrt(np.maximum(1.0 - np.stack([least, most]) ** 2, 0.0))  # most, least; j, k
    amplitude = np.hypot(turning[0, 1:], turning[1, 1:])
    sag = (amplitude / radius)[:, None] * (2 * np.pi / _STEPS) ** 2 / 8
    return _Sweep(_signs(low[0], high[0], root, valid), most, least, sag)


def _signs(low: np.ndarray, high: np.ndarray, root: np.ndarray, valid: np.ndarray) -> np.ndarray:
    """Return the signs of f from the ends of y . w and of both roots, (2, 2, B, N)."""
    great, small = root
    ends = [(great, small), (-small, -great)]  # of z, greatest first, for + and -
    sign = np.zeros((2, 2, *valid.shape), np.int8)
    for p, (high_j, low_j) in enumerate((g[0], s[0]) for g, s in ends):
        for q, (high_k, low_k) in enumerate((g[1], s[1]) for g, s in ends):
            above = low - high_j - high_k > _TINY
            below = high - low_j - low_k < -_TINY
            sign[p, q] = valid * (above.astype(np.int8) - below.astype(np.int8))
    return sign
