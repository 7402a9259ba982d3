"""Flat pieces of singular surfaces: where several CMGs have one gimbal axis.

With u along a gimbal axis that k >= 2 CMGs share, all k are free to turn, and their momenta
together reach every point of an annulus across u:

    |sum_k h_k| in [max(0, 2 max h0 - sum h0), sum h0]

All of it is singular; sheets only have circles of it, those of rotors that are in line. With the
k rotors not in line any motion of the other CMGs can be made a null motion, so the quadratic
form is diag(epsilon_i h0_i |p_i|) over them: saturation if their signs are alike, else hyperbolic.
"""

from __future__ import annotations

from itertools import product

import numpy as np

from nullmotion.array.model import CmgArray
from nullmotion.atlas import KINDS, Surface, singular_points

MOST_FLATS = 64
_AROUND, _RINGS = 72, 6
_LEAST = 1e-6  # radius of an annulus without a hole over its outer one
_ALONG = 1 - 1e-12  # cosine above which two axes are one


def flats(array: CmgArray, most: int = MOST_FLATS) -> tuple[Surface, ...]:
    """Return the annuli of an array with three torque dimensions, those of few minus signs first.

    Their signs are 0 for the CMGs that are free; all other attributes are those of sheets.

    Args:
        array: The array.
        most: How many at most.
    """
    if array.m != 3:
        return ()
    found = [(free, signs) for free in _groups(array) for signs in _signs(array, free)]
    found.sort(key=lambda pair: min(np.sum(pair[1] < 0), np.sum(pair[1] > 0)))
    return tuple(_annulus(array, free, signs) for free, signs in found[:most])


def _groups(array: CmgArray) -> list[np.ndarray]:
    """Return the working CMGs of each shared gimbal axis."""
    left = list(np.flatnonzero(np.asarray(array.h0) > 0))
    groups = []
    while left:
        same = np.abs(array.gimbal_axes[left] @ array.gimbal_axes[left[0]]) > _ALONG
        groups.append(np.array(left)[same])
        left = [i for i, gone in zip(left, same, strict=True) if not gone]
    return [group for group in groups if len(group) > 1]


def _signs(array: CmgArray, free: np.ndarray) -> list[np.ndarray]:
    others = np.setdiff1d(np.flatnonzero(np.asarray(array.h0) > 0), free)
    made = []
    for values in product((1, -1), repeat=len(others)):
        signs = np.ones(array.n, int)
        signs[free], signs[others] = 0, values
        made.append(signs)
    return made if len(others) else []


def _annulus(array: CmgArray, free: np.ndarray, signs: np.ndarray) -> Surface:
    assert array.torque_axes is not None
    g = array.gimbal_axes[free[0]]
    h0 = np.asarray(array.h0)[free]
    inner, outer = max(0.0, 2 * h0.max() - h0.sum()), h0.sum()
    bends = _chain(h0, np.linspace(max(inner, _LEAST * outer), outer, _RINGS + 1))
    angle = 2 * np.pi * np.arange(_AROUND) / _AROUND
    turn = np.exp(1j * (bends[:, None] + angle[:, None])).reshape(-1, len(free))
    e1 = np.cross(g, np.eye(3)[np.abs(g).argmin()])
    e1 = e1 / np.linalg.norm(e1)
    way = turn.real[..., None] * e1 + turn.imag[..., None] * np.cross(g, e1)
    u = np.broadcast_to(array.torque_axes @ g, (len(turn), 3))
    delta = np.array(singular_points(array, u, np.where(signs == 0, 1, signs)).delta)
    along, across = (
        np.einsum("pki,ki->pk", way, axes[free])
        for axes in (array.spin_axes, array.transverse_axes)
    )
    delta[:, free] = np.arctan2(across, along)
    alike = len(np.unique(signs[(signs != 0) & (np.asarray(array.h0) > 0)])) == 1
    kind = KINDS.index("saturation" if alike else "hyperbolic")
    points = len(u)
    none, never = np.zeros(points), np.zeros(points, bool)
    momentum = array.momentum(delta)
    return Surface(signs, u, _cells(), delta, momentum, np.full(points, kind), none, never)


def _chain(h0: np.ndarray, radii: np.ndarray) -> np.ndarray:
    """Return angles of links h0 whose sum is a radius along angle 0, (radii, k) [rad].

    From the last link to the first, what the others have to reach together is taken as large
    as may be; both sides of a triangle with it are known then.
    """
    angles = np.zeros((len(radii), len(h0)))
    r, base = radii, np.zeros(len(radii))
    for k in range(len(h0) - 1, 0, -1):
        rest = np.minimum(h0[:k].sum(), r + h0[k])
        angles[:, k] = base + _corner(r, h0[k], rest)
        base = base - _corner(r, rest, h0[k])
        r = rest
    angles[:, 0] = base
    return angles


def _corner(a: np.ndarray, b: np.ndarray, c: np.ndarray) -> np.ndarray:
    """Return the angle between sides a and b of a triangle, c being the third."""
    size = 2 * a * b
    cosine = np.where(size > 0, (a * a + b * b - c * c) / np.where(size > 0, size, 1.0), 1.0)
    return np.arccos(np.clip(cosine, -1, 1))


def _cells() -> np.ndarray:
    ring, k = np.meshgrid(np.arange(_RINGS), np.arange(_AROUND), indexing="ij")
    following = (k + 1) % _AROUND
    a, b = ring * _AROUND + k, ring * _AROUND + following
    c, d = a + _AROUND, b + _AROUND
    found: np.ndarray = np.stack([[a, c, d], [a, d, b]]).reshape(2, 3, -1)
    return found.transpose(0, 2, 1).reshape(-1, 3).astype(np.int32)
