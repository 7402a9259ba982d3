"""Patches of the sphere of singular directions, each looked at with one sign pattern."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np


class View(NamedTuple):
    """What is known about each gimbal axis all over patches.

    Attributes:
        u: Centres, (B, 3).
        radius: Angle from the centre that is not exceeded [rad], (B,).
        towards: Directions of p_i at the centre, (B, k, 3).
        column: Directions t_i of the columns with that, (B, k, 3).
        across: |p_i| at the centre, (B, k).
        least: Least |p_i|, (B, k); 0 where the axis is touched.
        most: Greatest |p_i|, (B, k).
        least_around: Least |p_i| of all the disc of that radius, (B, k).
        turn: By how much ``towards`` turns [rad], (B, k).
        roll: By how much ``column`` turns in the plane normal to u [rad], (B, k).
        own: Axes that a cap is about, (B, k).
        azimuth: Direction in which ``towards`` of those turns, (B, 3).
        moves: How far the centre is from the sides in both coordinates of a cap, (B, 2, 3).
        half: Half of the azimuths of a cap's patch [rad]; infinite for other patches, (B,).
        speed: Greatest |du/ds|^2 on a line in a cap's coordinates from the centre, (B,).
        veer: Greatest |D^2 u / ds^2| on such a line, for s from 0 to 1, (B,).
        covered: Patches that lie in a cap, which has patches of its own, (B,).
        wide: Which side is to be cut: the first if true, (B,).
    """

    u: np.ndarray
    radius: np.ndarray
    towards: np.ndarray
    column: np.ndarray
    across: np.ndarray
    least: np.ndarray
    most: np.ndarray
    least_around: np.ndarray
    turn: np.ndarray
    roll: np.ndarray
    own: np.ndarray
    azimuth: np.ndarray
    moves: np.ndarray
    half: np.ndarray
    speed: np.ndarray
    veer: np.ndarray
    covered: np.ndarray
    wide: np.ndarray


@dataclass(frozen=True, eq=False)
class Patches:
    """Patches between two values of each of two coordinates.

    Attributes:
        chart: Index of each one's coordinates, (B,): of a cap, or of a face of the cube.
        box: Bounds (B, 4): of the angle from the axis and the azimuth [rad], or of the two
            coordinates on the face, each first the lower.
        pattern: Index of the signs that it is looked at with, (B,).
    """

    chart: np.ndarray
    box: np.ndarray
    pattern: np.ndarray

    def __len__(self) -> int:
        """Return their number."""
        return len(self.chart)

    def take(self, which: np.ndarray) -> Patches:
        """Return some of them."""
        return Patches(self.chart[which], self.box[which], self.pattern[which])

    def joined(self, other: Patches) -> Patches:
        """Return these and others."""
        pairs = zip(vars(self).values(), vars(other).values(), strict=True)
        return Patches(*(np.concatenate(pair) for pair in pairs))

    def halves(self, wide: np.ndarray) -> Patches:
        """Return both halves of each, cut across the first coordinate where ``wide``."""
        rows, low = np.arange(len(self)), np.where(wide, 0, 2)
        middle = 0.5 * (self.box[rows, low] + self.box[rows, low + 1])
        one, other = self.box.copy(), self.box.copy()
        one[rows, low + 1] = other[rows, low] = middle
        return Patches(self.chart, one, self.pattern).joined(
            Patches(self.chart, other, self.pattern)
        )
