"""The sphere of singular directions in patches, and what is known of the CMGs all over them.

Near a gimbal axis the direction of p_i = u - (u . g_i) g_i turns fast, and on the axis itself it
can be any. So a cap around each axis is cut in polar coordinates, in which the direction is the
azimuth; the rest is cut as the faces of a cube. With theta_i the angle between u and the gimbal
axis, all over a disc of radius r around its centre

    p_i turns by at most asin(sin r / sin theta_i)
    t_i turns by at most r cot(theta_i - r)         in the plane normal to u, carried along
    sin(theta_i - r) <= |p_i| <= sin(theta_i + r)

CMGs with parallel gimbal axes have p_i and t_i in common: what is said is said of k axes.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from nullmotion.array.model import CmgArray
from nullmotion.atlas.grid import hole_axes
from nullmotion.atlas.internal_patches import Patches, View

_CAP, _APART = 0.35, 0.45  # rad; largest radius of a cap, and over the distance of two axes
_AZIMUTHS, _SQUARES = 24, 4
_ALONG = 1 - 1e-12
_NONE = 1e-300
_MARGIN = 1e-12  # rad; for rounding


class Sphere:
    """The charts of the sphere of an array with m = 3 whose CMGs all have momentum.

    Attributes:
        gimbal: The gimbal axes, each once for all CMGs that have it, either way round, (k, 3).
        of: Which of them each CMG has, (n,).
        share: Momenta of the CMGs over their mean, all those of an axis together, (k,).
        axes: The gimbal axes, both ways, (2 k, 3).
        cap: Radius of the cap around each [rad].
        charts: Three vectors for each chart, the caps first, (2 k + 6, 3, 3).
    """

    def __init__(self, array: CmgArray) -> None:
        """Choose the caps."""
        self.axes = hole_axes(array)
        self.gimbal = self.axes[::2]
        assert array.torque_axes is not None
        along = np.abs(array.gimbal_axes @ array.torque_axes.T @ self.gimbal.T)
        self.of = np.argmax(along, axis=1)
        share = np.asarray(array.h0, float) / float(array.mean_momentum)
        self.share = np.bincount(self.of, share)
        cosine = self.axes @ self.axes.T - 2 * np.eye(len(self.axes))
        self.cap = min(_CAP, _APART * float(np.arccos(np.clip(cosine.max(), -1, 1))))
        turned = [np.roll(np.eye(3), k, axis=0) for k in range(3)]
        faces = [np.stack([s * e[0], e[1], e[2]]) for e in turned for s in (1, -1)]
        self.charts = np.stack([*(_frame(axis) for axis in self.axes), *faces])

    def cover(self, patterns: int) -> Patches:
        """Return patches that cover the sphere once for each sign pattern."""
        azimuth = np.linspace(0, 2 * np.pi, _AZIMUTHS + 1)
        side = list(pairwise(np.linspace(-1, 1, _SQUARES + 1)))
        cap = [[0, self.cap, *turn] for turn in pairwise(azimuth)]
        face = [[*x, *y] for x in side for y in side]
        box = np.array([*(cap * len(self.axes)), *(face * 6)])
        count = [len(cap)] * len(self.axes) + [len(face)] * 6
        chart = np.repeat(np.arange(len(self.charts)), count)
        return Patches(
            np.tile(chart, patterns),
            np.tile(box, (patterns, 1)),
            np.repeat(np.arange(patterns), len(chart)),
        )

    def view(self, patches: Patches) -> View:
        """Return what is known all over patches."""
        polar, frame = patches.chart < len(self.axes), self.charts[patches.chart]
        x0, x1, y0, y1 = patches.box.T
        x, long, half = 0.5 * (x0 + x1), 0.5 * (x1 - x0), 0.5 * (y1 - y0)
        u, side = _at(frame, polar, x, 0.5 * (y0 + y1))
        corners = np.stack([_at(frame, polar, a, b)[0] for a in (x0, x1) for b in (y0, y1)], axis=1)
        away = np.arccos(np.clip(np.einsum("bck,bk->bc", corners, u), -1, 1)).max(axis=1)
        r = (np.where(polar, long + np.sin(x) * half, away) + _MARGIN)[:, None]
        p = u[:, None] - (u @ self.gimbal.T)[..., None] * self.gimbal
        across = np.linalg.norm(p, axis=2)
        own = polar[:, None] & (np.abs(frame[:, 0] @ self.gimbal.T) > _ALONG)
        towards = p / np.maximum(across, _NONE)[..., None]
        towards = np.where(own[..., None], side[:, None], towards)
        theta = np.arcsin(np.minimum(across, 1.0))
        inner, outer = np.maximum(theta - r, 0), np.minimum(theta + r, np.pi / 2)
        turn = np.arcsin(np.minimum(np.sin(r) / np.maximum(across, _NONE), 1.0))
        with np.errstate(divide="ignore"):
            roll = r / np.tan(inner)
        in_cap = np.einsum("bck,ak->bca", corners, self.axes) > np.cos(self.cap) + _MARGIN
        drift = np.where(own, 0.0, self.share / np.maximum(across, 0.02)).sum(axis=1)
        across_y = half * (np.where(polar, np.sin(x), 1.0) * drift + polar * (own @ self.share))
        azimuth = np.cross(frame[:, 0], side)
        outward = np.cos(x)[:, None] * side - np.sin(x)[:, None] * frame[:, 0]
        widest, steps = np.sin(x1), np.stack([long, half * np.sin(x)], axis=1)
        return View(
            u,
            r[:, 0],
            towards,
            np.cross(self.gimbal, towards),
            across,
            own=own,
            azimuth=azimuth,
            moves=steps[..., None] * np.stack([outward, azimuth], axis=1),
            half=np.where(polar, half, np.inf),
            speed=long**2 + (widest * half) ** 2,
            veer=np.hypot(widest * half**2, 2 * long * half),
            least=np.where(own, np.sin(x0)[:, None], np.sin(inner)),
            most=np.where(own, np.sin(x1)[:, None], np.sin(outer)),
            least_around=np.sin(inner),
            turn=np.where(own, half[:, None], np.where(inner > 0, turn, np.pi)),
            roll=np.where(own, half[:, None], roll),
            covered=~polar & in_cap.all(axis=1).any(axis=1),
            wide=long * drift >= across_y,
        )


def _frame(axis: np.ndarray) -> np.ndarray:
    """Return an axis and two vectors across it, as rows."""
    first = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
    first = first / np.linalg.norm(first)
    return np.stack([axis, first, np.cross(axis, first)])


def _at(
    frame: np.ndarray, polar: np.ndarray, x: np.ndarray, y: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return the directions of coordinates, and for caps the side of the axis they are on."""
    axis, first, second = frame[:, 0], frame[:, 1], frame[:, 2]
    side = np.cos(y)[:, None] * first + np.sin(y)[:, None] * second
    cap = np.cos(x)[:, None] * axis + np.sin(x)[:, None] * side
    face = axis + x[:, None] * first + y[:, None] * second
    face = face / np.linalg.norm(face, axis=1, keepdims=True)
    return np.where(polar[:, None], cap, face), side
