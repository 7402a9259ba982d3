"""Self-motion sets: all gimbal angles of one momentum, in connected components.

    M(h) = {delta : h(delta) = h},  of dimension n - m where A is regular

Null motion moves within a component and never from one to another: what a component has to
offer is all that null motion can reach from any of its angles. Gimbals turn freely here: end
stops are not looked at.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from nullmotion.array.model import CmgArray
from nullmotion.atlas.manifold_best import Best
from nullmotion.atlas.manifold_curves import SINGULAR
from nullmotion.atlas.manifold_pieces import Component, followed, sampled
from nullmotion.atlas.manifold_rotors import Rotors
from nullmotion.atlas.manifold_seeds import seeds, wrapped
from nullmotion.atlas.manifold_trace import Curve
from nullmotion.errors import InputError
from nullmotion.singular_kind import Kind, kind
from nullmotion.singularity import checked_angles

__all__ = ["Best", "Component", "Curve", "component", "escapable", "self_motion"]

STARTS = 150


def self_motion(
    array: CmgArray, momentum: Any, starts: int = STARTS, seed: int = 0, through: Any = None
) -> tuple[Component, ...]:
    """Return the connected components of the gimbal angles that hold a momentum.

    For n = m + 1 they are closed curves, followed by predictor and corrector from many solutions,
    and what hangs together in singular points is one component. For other n they are sampled
    and linked by walks: an upper bound of their number. Components that no start falls on are
    missed; half of the starts are put where the small ones are.

    Args:
        array: The array. CMGs without momentum stay at 0.
        momentum: The momentum to hold, the array's bias included [N m s], (m,).
        starts: Random starts, and as many near singular points.
        seed: Of the random starts.
        through: Gimbal angles of that momentum that must be among the points, (n,).

    Returns:
        The components, that of the best sigma_min first; none for a momentum out of reach.

    Raises:
        InputError: For a momentum of another size or not finite, or less than one start.
    """
    wanted = np.asarray(momentum, float)
    if wanted.shape != (array.m,) or not np.isfinite(wanted).all():
        raise InputError("momentum", np.ravel(wanted).tolist(), f"{array.m} finite numbers (N m s)")
    if not isinstance(starts, (int, np.integer)) or starts < 1:
        raise InputError("starts", starts, "a whole number from 1")
    idle = np.flatnonzero(np.asarray(array.h0) == 0)
    if len(idle):
        kept = np.delete(np.arange(array.n), idle)
        inner = None if through is None else np.asarray(through, float)[kept]
        fewer = self_motion(array.without(idle), wanted, starts, seed, inner)
        return tuple(_spread(c, kept, array.n) for c in fewer)
    rotors = Rotors(array)
    points = seeds(rotors, wanted, starts, seed)
    if through is not None:
        points = np.concatenate([wrapped(np.asarray(through, float))[None], points])
    put_together = followed if array.n == array.m + 1 else sampled
    found = put_together(rotors, points, wanted)
    return tuple(sorted(found, key=lambda c: -c.best["sigma_min"].value))


def component(array: CmgArray, delta: Any, starts: int = STARTS, seed: int = 0) -> Component:
    """Return the component of the self-motion set that gimbal angles (n,) [rad] are on.

    Raises:
        InputError: For angles of another number of CMGs, or angles that are not finite.
    """
    angles = checked_angles(array, delta, single=True)
    found = self_motion(array, array.momentum(angles), starts, seed, angles)
    here = np.where(np.asarray(array.h0) > 0, angles, 0.0)
    return min(found, key=lambda c: c.distance(here))


def escapable(array: CmgArray, delta: Any, least: float = SINGULAR, starts: int = STARTS) -> bool:
    """Return whether null motion from here leads to where the array is not singular.

    Elliptic and saturated states: no. Hyperbolic ones: yes. Degenerate-hyperbolic ones: as far
    as the whole component is known (`self_motion`); close by they cannot be left, but a
    longer null motion may lead to where they can.

    Args:
        array: The array; end stops are not looked at.
        delta: Gimbal angles [rad], (n,).
        least: sigma_min of A over the mean momentum that is to be reached. With a larger one
            the question is whether null motion leads that far from singular: it then
            depends on the whole component for regular and hyperbolic states, too.
        starts: As of `self_motion`.

    Raises:
        InputError: As `component`.
    """
    angles = checked_angles(array, delta, single=True)
    known = close_by(kind(array, angles), least)
    if known is not None:
        return known
    return component(array, delta, starts).best["sigma_min"].value > least


def close_by(what: Kind, least: float = SINGULAR) -> bool | None:
    """Return whether null motion leads to sigma_min above ``least``, by the type alone.

    None where that depends on the whole component.
    """
    if what in (Kind.SATURATION, Kind.ELLIPTIC):
        return False
    if what in (Kind.REGULAR, Kind.HYPERBOLIC) and least <= SINGULAR:
        return True
    return None


def _spread(found: Component, kept: np.ndarray, n: int) -> Component:
    """Return a component of the working CMGs with the idle ones at 0."""

    def wide(angles: np.ndarray) -> np.ndarray:
        every = np.zeros((*angles.shape[:-1], n))
        every[..., kept] = angles
        return every

    parts = tuple(Curve(wide(c.angles), c.closed) for c in found.curves)
    top = {name: Best(b.value, wide(b.delta)) for name, b in found.best.items()}
    return replace(
        found, points=wide(found.points), curves=parts, crossings=wide(found.crossings), best=top
    )
