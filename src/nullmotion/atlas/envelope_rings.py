"""An array as a sum of rings: what momentum each gimbal axis can hold.

A CMG alone reaches a circle around its gimbal axis. CMGs with parallel gimbal axes reach the
ring between two circles in their common plane,

    max(0, 2 max h0 - sum h0) <= |v| <= sum h0,

and the reachable momenta R are the sum of the rings, h = sum_k v_k. Two circles of radii
(outer + inner) / 2 and (outer - inner) / 2 make the same ring as any number of CMGs, so that the
number of angles to look at is twice the number of different gimbal axes at most. A ring without
a hole is a disc, which is convex; R is convex when all rings are.

In an array of fewer torque dimensions than three the rings are seen along the others: ellipses.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from nullmotion.array.model import CmgArray

_PARALLEL = 1e-12  # of 1 - cos of the angle between gimbal axes
_HOLE = 1e-9  # of the outer radius: a smaller hole is none
_FLAT = 1e-9  # least singular value of an image that is not flat


@dataclass(frozen=True, eq=False)
class Rings:
    """Rings whose sum is the set of reachable momenta, in units of one momentum.

    Attributes:
        frames: Two vectors that span each ring's plane, (k, 2, m); v = x s + y t.
        inner: Least hypot(x, y), (k,).
        outer: Greatest hypot(x, y), (k,).
        unit: What momenta are divided by [N m s].
    """

    frames: np.ndarray
    inner: np.ndarray
    outer: np.ndarray
    unit: float

    @property
    def m(self) -> int:
        """Number of torque dimensions."""
        return int(self.frames.shape[2])

    @cached_property
    def convex(self) -> bool:
        """Whether no ring has a hole."""
        return bool((self.inner == 0).all())

    @cached_property
    def flat(self) -> bool:
        """Whether R has no volume: its rings lie in a plane, or have too few angles."""
        few = len(self.ring_of) < self.m
        sigma = np.linalg.svd(self.frames.reshape(-1, self.m), compute_uv=False)
        return bool(few or sigma[self.m - 1] < _FLAT)

    @cached_property
    def ring_of(self) -> np.ndarray:
        """Ring of each circle, (c,): one circle for a ring without width, two for the others."""
        return np.repeat(np.arange(len(self.inner)), np.where(self.inner < self.outer, 2, 1))

    @cached_property
    def circles(self) -> np.ndarray:
        """Circles that make the rings, (c, 2, m): h = sum_i c_i0 cos delta_i + c_i1 sin delta_i."""
        first = np.append(True, np.diff(self.ring_of) > 0)
        sign = np.where(first, 1.0, -1.0)
        radii = 0.5 * (self.outer[self.ring_of] + sign * self.inner[self.ring_of])
        return radii[:, None, None] * self.frames[self.ring_of]

    def support(self, u: np.ndarray) -> np.ndarray:
        """Return max h . u over R for vectors u (..., m): sum_k outer_k |(s_k . u, t_k . u)|."""
        along = np.moveaxis(self.frames @ np.moveaxis(u, -1, 0).reshape(self.m, -1), 1, 0)
        value: np.ndarray = self.outer @ np.hypot(along[0], along[1])
        return value.reshape(u.shape[:-1])

    def top(self, u: np.ndarray) -> np.ndarray:
        """Return a momentum of R with the greatest h . u, (..., m): the outer surface."""
        along = np.einsum("krm,...m->...kr", self.frames, u)
        size = np.linalg.norm(along, axis=-1, keepdims=True)
        axis = np.array([1.0, 0.0])
        unit = np.where(size > 0, along / np.where(size > 0, size, 1.0), axis)
        return np.einsum("k,...kr,krm->...m", self.outer, unit, self.frames)

    def momentum(self, delta: np.ndarray) -> np.ndarray:
        """Return h of the circles' angles (B, c), (B, m)."""
        c = self.circles
        value: np.ndarray = np.cos(delta) @ c[:, 0] + np.sin(delta) @ c[:, 1]
        return value

    def parts(self, delta: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return each circle's momentum and its derivative, (B, c, m) each."""
        c, cosine, sine = self.circles, np.cos(delta)[..., None], np.sin(delta)[..., None]
        return cosine * c[:, 0] + sine * c[:, 1], cosine * c[:, 1] - sine * c[:, 0]


def rings(array: CmgArray) -> Rings:
    """Return the rings of an array's working CMGs, without its bias and end stops."""
    assert array.torque_axes is not None
    working = np.flatnonzero(np.asarray(array.h0) > 0)
    unit = float(array.mean_momentum)
    left, groups = list(working), []
    while left:
        parallel = np.abs(array.gimbal_axes[left] @ array.gimbal_axes[left[0]]) > 1 - _PARALLEL
        groups.append([i for i, same in zip(left, parallel, strict=True) if same])
        left = [i for i, same in zip(left, parallel, strict=True) if not same]
    h0 = np.asarray(array.h0, float) / unit
    outer = np.array([h0[g].sum() for g in groups])
    inner = np.array([2 * h0[g].max() - h0[g].sum() for g in groups])
    first = [g[0] for g in groups]
    frames = np.stack([array.spin_axes[first], array.transverse_axes[first]], axis=1)
    frames = frames @ array.torque_axes.T
    sigma = np.linalg.svd(frames, compute_uv=False)
    line = sigma[:, -1] < _FLAT if array.m > 1 else np.ones(len(first), bool)
    inner = np.where(line | (inner < _HOLE * outer), 0.0, inner)
    seen = sigma[:, 0] > _FLAT
    return Rings(frames[seen], inner[seen], outer[seen], unit)
