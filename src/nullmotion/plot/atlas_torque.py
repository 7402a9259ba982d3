"""Torque in pictures: what is left of it at singular points, and the colours that tell it."""

from __future__ import annotations

import numpy as np

from nullmotion.atlas.torque_surface import surface_torque
from nullmotion.plot.atlas_view import Scene

# Viridis (Smith and van der Walt 2015) at 17 even places: lightness grows evenly, for every kind
# of colour vision.
SCALE = (
    "#440154", "#48186a", "#472d7b", "#424086", "#3b528b", "#33638d", "#2c728e", "#26818e",
    "#21908c", "#1f9f88", "#28ae80", "#3ebc74", "#5dc963", "#82d34c", "#abdc32", "#d5e21a",
    "#fde725",
)  # fmt: skip
UNREACHABLE = "#eceef1"
_FAR = 0.4  # least over largest value above which a scale does not begin at 0
_SLACK = 1e-9


def torque_left(scene: Scene) -> list[np.ndarray]:
    """Return what torque is left at the points of a scene's sheets, and of each flat piece.

    The second smallest singular value of A over the mean momentum: across u, where there is no
    torque at all, the worst direction has that much. A A^T does not depend on the signs, so it is
    the same on all sheets: they come once, first. For two torque dimensions there is none.
    """
    if scene.array.m != 3:
        return []
    return [surface_torque(scene.array, one) for one in (scene.sheets[0], *scene.flats)]


def span(left: list[np.ndarray]) -> tuple[float, float]:
    """Return the ends of the scale of `torque_left`: from 0, unless all of it is far from 0."""
    low = float(min(values.min() for values in left))
    most = float(max(values.max() for values in left))
    return (low if _FAR * most < low < most else 0.0), most or 1.0


def ticks(low: float, high: float, count: int = 4) -> list[float]:
    """Return about so many round numbers between two."""
    if not high > low:
        return [low]
    power = 10.0 ** np.floor(np.log10((high - low) / count))
    steps = (f * power for f in (1.0, 2.0, 2.5, 5.0, 10.0))
    step = next(s for s in steps if s * count >= 0.999 * (high - low))
    first, last = np.ceil(low / step - _SLACK), np.floor(high / step + _SLACK)
    return [float(f"{step * k:.6g}") + 0.0 for k in np.arange(first, last + 1)]
