"""Cells of momentum space: a patch of directions times an interval of sizes.

Directions are seen on the faces of a cube: with the rows e_0, e_1, ... of an orthonormal frame,

    h = r w / |w|,    w = e_0 + s_1 e_1 + ...,    s in a box, r in an interval.

A cell lies in the convex hull of r_0 w_k / |w_k| and (r_1 / c) w_k / |w_k| over the corners w_k of
its patch, c the least cosine between them and the patch's centre: w / |w| = sum l_k w_k / |w_k|
with l_k >= 0 and 1 <= sum l_k <= 1 / c, for all combinations of the corners are at least c long.
R is the same seen from both sides (all rotors reversed: -h), so half the faces are enough.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import product

import numpy as np

SEEDS = 3  # sets of angles that a cell hands on


@dataclass(frozen=True, eq=False)
class Cells:
    """Cells, and gimbal angles from which to look for their momenta.

    Attributes:
        frames: Orthonormal frames as rows, (F, m, m).
        face: Frame of each cell, (B,).
        box: Ends of s_1, ..., s_(m-1) and r, (B, m, 2).
        seeds: Angles of the circles that hold momenta near by, (B, SEEDS, c).
    """

    frames: np.ndarray
    face: np.ndarray
    box: np.ndarray
    seeds: np.ndarray

    def __len__(self) -> int:
        """Return the number of cells."""
        return len(self.face)

    @property
    def straight(self) -> bool:
        """Whether all cells lie on one line through no momentum."""
        return bool((self.box[:, :-1, 0] == self.box[:, :-1, 1]).all()) and len(self.frames) == 1

    @property
    def nearest(self) -> np.ndarray:
        """Least |h| in each cell, (B,)."""
        return self.box[:, -1, 0]

    @property
    def longest(self) -> np.ndarray:
        """Bound of the longest edge of each cell, (B,)."""
        size = self.box[:, :, 1] - self.box[:, :, 0]
        size[:, :-1] *= self.box[:, -1:, 1]
        greatest: np.ndarray = size.max(axis=1)
        return greatest

    @property
    def share(self) -> np.ndarray:
        """Volume of each cell (m = 2: area, m = 1: length), (B,)."""
        box, m = self.box, self.box.shape[1]
        shell = (box[:, -1, 1] ** m - box[:, -1, 0] ** m) / m
        return shell * _solid_angle(box[:, :-1])

    def take(self, chosen: np.ndarray) -> Cells:
        """Return some of the cells."""
        return replace(self, face=self.face[chosen], box=self.box[chosen], seeds=self.seeds[chosen])

    def seeded(self, seeds: np.ndarray) -> Cells:
        """Return the cells with other seeds."""
        return replace(self, seeds=seeds)

    def joined(self, other: Cells) -> Cells:
        """Return these cells and others of the same frames."""
        pairs = {k: (getattr(self, k), getattr(other, k)) for k in ("face", "box", "seeds")}
        return replace(self, **{k: np.concatenate(v) for k, v in pairs.items()})

    def centres(self) -> np.ndarray:
        """Return a momentum in each cell, (B, m)."""
        middle = self.box.mean(axis=2)
        return self._directions(middle[:, :-1]) * middle[:, -1:]

    def hulls(self) -> np.ndarray:
        """Return points in whose convex hull each cell lies, (B, 2^m, m); r changes last."""
        m = self.box.shape[1]
        middle = self._directions(self.box[:, :-1].mean(axis=2))
        rows = np.arange(m - 1)
        corners = [self._directions(self.box[:, rows, k]) for k in product((0, 1), repeat=m - 1)]
        corner = np.stack(corners, axis=1)
        cosine = np.einsum("bkm,bm->bk", corner, middle).min(axis=1)
        near, far = self.box[:, -1, 0], self.box[:, -1, 1] / cosine
        return np.concatenate([near[:, None, None] * corner, far[:, None, None] * corner], axis=1)

    def edges(self, hulls: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the cells' mean edges, along each s, then along r, (B, m, m), and their sag.

        The sag is by how much the hull is thicker than the cell, because the patch is curved.
        """
        m = self.box.shape[1]
        bits = np.array(list(product((-1, 1), repeat=m)))  # r first, as in `hulls`
        order = [*range(1, m), 0]
        edges = bits[:, order].T @ hulls / 2 ** (m - 1)
        thick = np.linalg.norm(edges[:, -1], axis=1)
        share = (self.box[:, -1, 1] - self.box[:, -1, 0]) / np.maximum(thick, 1e-300)
        across = edges[:, -1].copy()
        edges[:, -1] *= np.minimum(share, 1.0)[:, None]
        return edges, across - edges[:, -1]

    def halves(self, axis: np.ndarray) -> Cells:
        """Return both halves of each cell, cut along one axis each, (B,)."""
        rows = np.arange(len(self))
        low, high = self.box.copy(), self.box.copy()
        middle = self.box[rows, axis].mean(axis=1)
        low[rows, axis, 1] = high[rows, axis, 0] = middle
        return replace(self, box=low).joined(replace(self, box=high))

    def _directions(self, s: np.ndarray) -> np.ndarray:
        w = np.concatenate([np.ones((len(s), 1)), s], axis=1)
        along = np.einsum("bi,bim->bm", w, self.frames[self.face])
        unit: np.ndarray = along / np.linalg.norm(along, axis=1, keepdims=True)
        return unit


def ball(m: int, radius: float, circles: int, pieces: int = 4, shells: int = 3) -> Cells:
    """Return cells that cover half a ball: the other half is their mirror image."""
    frames = np.stack([np.roll(np.eye(m), -i, axis=0) for i in range(m)])
    return _grid(frames, [(-1.0, 1.0, pieces)] * (m - 1) + [(0.0, radius, shells)], circles)


def ray(direction: np.ndarray, radius: float, circles: int, shells: int = 8) -> Cells:
    """Return cells along a unit direction (m,)."""
    m = len(direction)
    basis = np.linalg.qr(np.column_stack([direction, np.eye(m)]))[0].T
    basis[0] = direction
    return _grid(basis[None], [(0.0, 0.0, 1)] * (m - 1) + [(0.0, radius, shells)], circles)


def sphere(m: int, pieces: int = 8) -> Cells:
    """Return cells that cover half the unit sphere; r is 1."""
    frames = np.stack([np.roll(np.eye(m), -i, axis=0) for i in range(m)])
    return _grid(frames, [(-1.0, 1.0, pieces)] * (m - 1) + [(1.0, 1.0, 1)], 0)


def _grid(frames: np.ndarray, sides: list[tuple[float, float, int]], circles: int) -> Cells:
    ends = [np.linspace(low, high, count + 1) for low, high, count in sides]
    spans = [np.stack([e[:-1], e[1:]], axis=1) for e in ends]
    box = np.array([np.stack(b) for _ in frames for b in product(*spans)])
    face = np.repeat(np.arange(len(frames)), len(box) // len(frames))
    return Cells(frames, face, box, np.zeros((len(box), SEEDS, circles)))


def _solid_angle(s: np.ndarray) -> np.ndarray:
    """Return the part of the unit sphere that boxes (B, m - 1, 2) of a cube's face cover."""
    if s.shape[1] == 0:
        return np.ones(len(s))
    if s.shape[1] == 1:
        angle = np.arctan(s[:, 0])
        return angle[:, 1] - angle[:, 0]
    x, y = s[:, 0, :, None], s[:, 1, None, :]
    corner = np.arctan2(x * y, np.sqrt(1 + x * x + y * y))
    return corner[:, 1, 1] - corner[:, 0, 1] - corner[:, 1, 0] + corner[:, 0, 0]
