"""How types of singular points are drawn, and what they mean."""

from __future__ import annotations

from dataclasses import dataclass

from nullmotion.atlas import KINDS
from nullmotion.plot import palette


@dataclass(frozen=True)
class Look:
    """How one type of singular point is drawn, and what it means.

    Args:
        key: As in `nullmotion.atlas.KINDS`.
        name: In legends.
        meaning: What null motion can do there.
        colour: Hex colour.
        alpha: How opaque its surface is, 0 to 1.
        rim: How much more opaque where it is seen from the side.
        width: Line width of its cuts [px].
        stripes: Whether dark lines run over it, so that it is told apart without colour.
    """

    key: str
    name: str
    meaning: str
    colour: str
    alpha: float
    rim: float
    width: float
    stripes: bool = False


LOOKS = (
    Look("saturation", "Saturation", "no more momentum that way", "#5b6570", 0.07, 0.35, 1.4),
    Look(
        "elliptic",
        "Elliptic",
        "impassable: no null motion",
        palette.COLOURS[1],
        0.62,
        0.3,
        2.6,
        True,
    ),
    Look("hyperbolic", "Hyperbolic", "passable by null motion", palette.COLOURS[0], 0.2, 0.35, 1.2),
    Look(
        "degenerate-hyperbolic",
        "Degenerate hyperbolic",
        "impassable: null motion stays singular",
        palette.COLOURS[3],
        0.7,
        0.2,
        3.2,
        True,
    ),
)

assert tuple(look.key for look in LOOKS) == tuple(map(str, KINDS))[: len(LOOKS)]
