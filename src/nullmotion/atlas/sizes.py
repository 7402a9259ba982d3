"""Four radii of momentum space that are told apart, of an array whole and with a CMG failed.

- outer surface: least |h| on the sheet of all plus signs (`outer`);
- omnidirectional: radius of the largest ball of reachable momenta (`envelope`);
- nearest impassable: least |h| of an elliptic internal singularity (`internal`), where no null
  motion exists and no law can obey a command along u: the pseudo-inverse sticks there;
- guaranteed: up to which a constraint law gives a torque in every direction (`guaranteed`).

All are about the array's bias.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from nullmotion.array.model import CmgArray
from nullmotion.atlas import alike
from nullmotion.atlas.bounds import Bounds
from nullmotion.atlas.envelope import omnidirectional
from nullmotion.atlas.guaranteed import LEVELS, Guaranteed, guaranteed
from nullmotion.atlas.internal import Impassable, nearest_impassable
from nullmotion.atlas.outer import Outer, outer_surface

Progress = Callable[[float], None]

_SHARES = (0.6, 0.3, 0.1)  # of the time: ball, impassable point, guarantee


@dataclass(frozen=True, eq=False)
class Radii:
    """The radii of one array.

    Attributes:
        outer_surface: Least momentum of the outer surface.
        omnidirectional: Bounds of the largest ball's radius [N m s].
        nearest_impassable: The impassable point; None if no internal singularity is impassable.
        guaranteed: A row for each torque; empty where no constraint law exists.
        no_guarantee: Why there is none.
    """

    outer_surface: Outer
    omnidirectional: Bounds
    nearest_impassable: Impassable | None
    guaranteed: tuple[Guaranteed, ...] = ()
    no_guarantee: str = ""

    def as_dict(self) -> dict[str, Any]:
        """Return the radii for a JSON file [N m s]."""
        nearest = self.nearest_impassable
        return {
            "outer_surface": {
                "radius": self.outer_surface.radius,
                "momentum": self.outer_surface.momentum.tolist(),
            },
            "omnidirectional": self.omnidirectional.as_dict(),
            "nearest_impassable": None if nearest is None else nearest.as_dict(),
            "guaranteed": [row.as_dict() for row in self.guaranteed],
            "no_guarantee": self.no_guarantee or None,
        }


@dataclass(frozen=True, eq=False)
class Failed:
    """The radii that are left when a CMG has failed and its momentum is gone.

    Attributes:
        cmg: The CMG, counted from 0.
        like: The first CMG whose failure leaves the same array, turned or mirrored; itself if
            there is none before.
        radii: What is left.
    """

    cmg: int
    like: int
    radii: Radii

    def as_dict(self) -> dict[str, Any]:
        """Return the failure for a JSON file."""
        return {"cmg": self.cmg, "like": self.like, "radii": self.radii.as_dict()}


def radii(
    array: CmgArray, levels: Sequence[float] = LEVELS, progress: Progress | None = None
) -> Radii:
    """Return the four radii of an array.

    Args:
        array: The array; its end stops are left out.
        levels: Torques for the guaranteed radius, over h0 times the rate limit.
        progress: Called with the finished share.

    Raises:
        InputError: For a level that is not a finite number above 0.
    """
    part = parts(progress, _SHARES)
    held = guaranteed(array, levels, part[2])
    rows, reason = ((), held) if isinstance(held, str) else (held, "")
    ball = omnidirectional(array, progress=part[0])
    nearest = nearest_impassable(array, progress=part[1])
    if progress is not None:
        progress(1.0)  # what there was nothing to do for has told nothing
    return Radii(outer_surface(array), ball, nearest, rows, reason)


def failures(
    array: CmgArray, levels: Sequence[float] = LEVELS, progress: Progress | None = None
) -> tuple[Failed, ...]:
    """Return the radii with each working CMG failed in turn; alike arrays are worked out once.

    Empty for an array of one working CMG.
    """
    working = np.flatnonzero(np.asarray(array.h0) > 0)
    if len(working) < 2:
        return ()
    left = [array.without(int(i)) for i in working]
    first = alike.classes(left)
    different = sorted(set(first))
    part = parts(progress, [1 / len(different)] * len(different))
    known = {k: radii(left[k], levels, part[i]) for i, k in enumerate(different)}
    return tuple(
        Failed(int(i), int(working[k]), known[k]) for i, k in zip(working, first, strict=True)
    )


def parts(progress: Progress | None, shares: Sequence[float]) -> list[Progress | None]:
    """Return functions that each report one part of the whole."""
    if progress is None:
        return [None] * len(shares)
    done = np.zeros(len(shares))

    def report(i: int) -> Progress:
        def told(share: float) -> None:
            done[i] = share
            assert progress is not None
            progress(float(done @ np.asarray(shares)))

        return told

    return [report(i) for i in range(len(shares))]
