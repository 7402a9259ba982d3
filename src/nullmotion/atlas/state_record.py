"""What is known about one state of an array."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from nullmotion.atlas.manifold import Component


@dataclass(frozen=True, eq=False)
class State:
    """What there is to know about gimbal angles.

    Attributes:
        delta: The gimbal angles [rad], (n,).
        momentum: Their momentum, the array's bias included [N m s], (m,).
        kind: ``regular``, ``saturation``, ``elliptic``, ``hyperbolic``, ``degenerate-hyperbolic``.
        measures: Those of `nullmotion.singularity.measures`, of A over the mean momentum.
        torque_capability: Torque that some law can give in every direction, over mean momentum
            and least rate limit.
        directions: Number of independent singular directions; 0 where regular.
        u: A unit direction without torque, (m,); None where regular. Turned so that it is the
            blocked one of an elliptic point and outwards in saturation; else h . u >= 0.
        signs: Side of u that each rotor is on, (n,): 1, -1, or 0 for neither; None where regular.
        passable: Whether null motion leads out of the singular set from right here.
        passable_along: Whether the momentum can go on along u; None where regular.
        passable_against: Whether it can go on along -u; None where regular.
        components: Connected pieces of all gimbal angles of this momentum, with the best
            measures on each: that of the best sigma_min first.
        here: Which of them the state is on.
        escapable: Whether null motion, however long, leads to where the array is not singular.
        seconds: Time it took [s].
    """

    delta: np.ndarray
    momentum: np.ndarray
    kind: str
    measures: Mapping[str, float]
    torque_capability: float
    directions: int
    u: np.ndarray | None
    signs: np.ndarray | None
    passable: bool
    passable_along: bool | None
    passable_against: bool | None
    components: tuple[Component, ...]
    here: int
    escapable: bool
    seconds: float

    @property
    def component(self) -> Component:
        """The piece of the self-motion set that the state is on."""
        return self.components[self.here]

    def as_dict(self) -> dict[str, Any]:
        """Return the state for a JSON file, angles in degrees."""
        return {
            "gimbal_deg": np.degrees(self.delta).tolist(),
            "momentum_Nms": self.momentum.tolist(),
            "kind": self.kind,
            "measures": dict(self.measures),
            "torque_capability": self.torque_capability,
            "singular_directions": self.directions,
            "u": None if self.u is None else self.u.tolist(),
            "signs": None if self.signs is None else self.signs.tolist(),
            "passable": self.passable,
            "passable_along_u": self.passable_along,
            "passable_against_u": self.passable_against,
            "escapable": self.escapable,
            "components": [_piece(c) for c in self.components],
            "on_component": self.here,
            "seconds": round(self.seconds, 3),
        }


def _piece(piece: Component) -> dict[str, Any]:
    top = {
        name: {"value": best.value, "gimbal_deg": np.degrees(best.delta).tolist()}
        for name, best in piece.best.items()
    }
    return {
        "best": top,
        "curves": len(piece.curves),
        "length_rad": float(piece.length) if piece.curves else None,
        "crossings_deg": np.degrees(piece.crossings).tolist(),
        "followed": piece.followed,
    }
