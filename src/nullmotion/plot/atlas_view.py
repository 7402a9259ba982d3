"""What pictures show of an array's singular surfaces: kinds, sheets, radii, motions.

`nullmotion.report` makes a page of it, `nullmotion.plot.atlas` a figure.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from nullmotion.array.model import CmgArray
from nullmotion.atlas import Surface, patterns, surfaces
from nullmotion.plot import palette
from nullmotion.plot.atlas_flats import flats
from nullmotion.plot.atlas_signs import minority

if TYPE_CHECKING:
    from nullmotion.atlas.torque import TorqueMap

MOST_POINTS = 40_000  # of all sheets together: a page turns them without a graphics card
MOST_SHEETS = 128
MOST_DIRECTIONS, LEAST_DIRECTIONS = 6000, 400
PLANAR_DIRECTIONS = 720
FEW_SHEETS = 40  # so many are switched on from the start


@dataclass(frozen=True)
class Ball:
    """A radius of momentum space that is told by a name.

    Args:
        key: Short name, unique.
        label: What it is.
        radius: Its size [N m s].
        colour: Hex colour.
        dash: One of `palette.DASHES`.
        shown: Whether it is drawn from the start.
    """

    key: str
    label: str
    radius: float
    colour: str
    dash: str
    shown: bool = True


@dataclass(frozen=True, eq=False)
class Motion:
    """How the gimbals turned.

    Args:
        label: What turned them.
        t: Times [s], (k,).
        delta: Gimbal angles [rad], (k, n).
        momentum: Momentum along the torque axes [N m s], (k, m).
        sigma: Least singular value of A over the mean momentum, (k,); None if not known.
        colour: Hex colour.
        dash: One of `palette.DASHES`.
    """

    label: str
    t: np.ndarray
    delta: np.ndarray
    momentum: np.ndarray
    sigma: Any = None
    colour: str = palette.INK
    dash: str = "solid"


@dataclass(frozen=True, eq=False)
class Scene:
    """An array, its singular surfaces and what is drawn among them.

    Attributes:
        array: The array.
        home: Gimbal angles to begin with [rad], (n,).
        sheets: Singular surfaces.
        balls: Radii.
        motions: Runs.
        left_out: Sign patterns that are not among the sheets.
        maps: Torque capability over planes.
        flats: Flat pieces of the surfaces, where gimbal axes are shared.
    """

    array: CmgArray
    home: np.ndarray
    sheets: tuple[Surface, ...]
    balls: tuple[Ball, ...] = ()
    motions: tuple[Motion, ...] = ()
    left_out: int = 0
    maps: tuple[TorqueMap, ...] = ()
    flats: tuple[Surface, ...] = ()

    @property
    def every(self) -> tuple[Surface, ...]:
        """Sheets and flat pieces."""
        return self.sheets + self.flats

    @property
    def middle(self) -> np.ndarray:
        """The array's bias along the torque axes, about which the envelope is [N m s], (m,)."""
        assert self.array.torque_axes is not None
        found: np.ndarray = self.array.torque_axes @ np.asarray(self.array.momentum_bias, float)
        return found

    @property
    def radius(self) -> float:
        """Size of the picture: the largest momentum on a sheet or of a motion [N m s]."""
        found = [np.linalg.norm(sheet.momentum, axis=1).max() for sheet in self.every]
        paths = [np.linalg.norm(motion.momentum, axis=1) for motion in self.motions]
        found += [np.nanmax(path) for path in paths if np.isfinite(path).any()]
        return float(max(found, default=1.0)) or 1.0


def scene(
    array: CmgArray,
    home: Any = None,
    balls: Sequence[Ball] = (),
    motions: Sequence[Motion] = (),
    most: int = MOST_POINTS,
    maps: Sequence[TorqueMap] = (),
) -> Scene:
    """Return an array's singular surfaces, meshed as finely as a picture can show.

    Args:
        array: The array.
        home: Gimbal angles to begin with [rad], (n,); zero by default.
        balls: Radii to draw.
        motions: Runs to draw.
        most: Points of all sheets together.
        maps: Torque capability over planes.
    """
    every = minority(patterns(array), np.asarray(array.h0) > 0)
    signs = every[:MOST_SHEETS]
    count = int(np.clip(most // len(signs), LEAST_DIRECTIONS, MOST_DIRECTIONS))
    count = PLANAR_DIRECTIONS if array.m < 3 else count
    start = np.zeros(array.n) if home is None else np.asarray(home, float)
    sheets = surfaces(array, count, signs)
    return Scene(
        array, start, sheets, tuple(balls), tuple(motions), len(every) - len(signs), tuple(maps),
        flats(array),
    )  # fmt: skip
