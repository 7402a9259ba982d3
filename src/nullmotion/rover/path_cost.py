"""What a step costs by its kind and by the slope of the ground under it.

A `StepCost` answers for many steps at once; a path is searched with whichever is given. The
default one is a `StepTable`: planned steps at some slopes, linear between them. Nothing is
extrapolated: outside the table, and beside a slope at which no step was found, steps are
refused.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple, Protocol

import numpy as np

from nullmotion.errors import InputError


class StepCosts(NamedTuple):
    """Energies [J], times [s] and margins [N m] of steps, (...); energy inf where refused."""

    energy: np.ndarray
    time: np.ndarray
    margin: np.ndarray


class StepCost(Protocol):
    """What a path planner asks of a rover."""

    def __call__(
        self, a: np.ndarray, b: np.ndarray, pitch: np.ndarray, cross: np.ndarray
    ) -> StepCosts:
        """Return what steps cost; all arguments (...).

        Args:
            a: Spike at the start of the edge, a corner of the chassis.
            b: Spike at its end: the rover turns positively about a -> b.
            pitch: Slope of the ground in the direction of the step [rad], uphill above 0.
            cross: Slope along the edge [rad], b higher above 0.
        """
        ...


class PlannedStep(NamedTuple):
    """What a planner finds for one step: energy [J], time [s], margin [N m]."""

    energy: float
    time: float
    margin: float


@dataclass(frozen=True, eq=False)
class StepTable:
    """Planned steps over the slope, for each kind of step; linear in pitch and |cross|.

    Beyond the last cross slope c in the table a step is charged as at c, and what more weight
    shifts from one spike to the other is taken off its margin: at most M g d (sin|cross| - sin c)
    [N m], d being the greatest height of the mass centre above the edge.

    Args:
        kinds: Kind of the step about a -> b, (V, V).
        pitches: Slopes in the direction of the step [rad], increasing, (p,).
        energy: Energies [J], (kinds, p, c); NaN where there is no step.
        time: Durations [s], (kinds, p, c).
        margin: Margins [N m], (kinds, p, c).
        weight_moment: M g d [N m].
        crosses: Slopes along the edge [rad], 0 and more, increasing, (c,).
        least_margin: Margin below which a step is refused [N m].

    Raises:
        InputError: For arrays that do not fit, slopes that do not increase, or an energy below 0.
    """

    kinds: np.ndarray
    pitches: np.ndarray
    energy: np.ndarray
    time: np.ndarray
    margin: np.ndarray
    weight_moment: float
    crosses: np.ndarray = field(default_factory=lambda: np.zeros(1))
    least_margin: float = 0.0

    def __post_init__(self) -> None:
        """Check what can be checked."""
        shape = (int(np.max(self.kinds)) + 1, len(self.pitches), len(self.crosses))
        for key in ("pitches", "crosses"):
            slopes = np.asarray(getattr(self, key), float)
            if not len(slopes) or not (np.diff(slopes) > 0).all():
                raise InputError(f"rover.{key}", slopes.tolist(), "slopes that increase")
        if self.crosses[0] != 0:
            raise InputError("rover.crosses", float(self.crosses[0]), "slopes from 0 on")
        for key in ("energy", "time", "margin"):
            values = np.asarray(getattr(self, key), float)
            if values.shape != shape:
                allowed = " x ".join(map(str, shape)) + " numbers"
                raise InputError(f"rover.{key}", list(values.shape), allowed)
        if np.nanmin(self.energy, initial=0.0) < 0:
            raise InputError("rover.energy", float(np.nanmin(self.energy)), "0 or more (J)")

    def __call__(
        self, a: np.ndarray, b: np.ndarray, pitch: np.ndarray, cross: np.ndarray
    ) -> StepCosts:
        """Return what steps cost, as `StepCost` says."""
        a, b, pitch, cross = np.broadcast_arrays(a, b, pitch, cross)
        kind, tilt = self.kinds[a, b], np.abs(cross)
        last = self.crosses[-1]
        i, u = _place(self.pitches, pitch)
        j, v = _place(self.crosses, np.minimum(tilt, last))
        energy, time, margin = (
            _between(table, kind, i, u, j, v) for table in (self.energy, self.time, self.margin)
        )
        beyond = np.sin(np.maximum(tilt, last)) - np.sin(last)
        margin = margin - self.weight_moment * beyond
        inside = (self.pitches[0] <= pitch) & (pitch <= self.pitches[-1])
        made = inside & (kind >= 0) & np.isfinite(energy) & (margin >= self.least_margin)
        return StepCosts(np.where(made, energy, np.inf), time, margin)


def _place(nodes: np.ndarray, at: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the node before each value and how far it is beyond, 0 to 1."""
    if len(nodes) == 1:
        return np.zeros(np.shape(at), int), np.zeros(np.shape(at))
    i = np.clip(np.searchsorted(nodes, at, side="right") - 1, 0, len(nodes) - 2)
    return i, np.clip((at - nodes[i]) / (nodes[i + 1] - nodes[i]), 0.0, 1.0)


def _between(
    table: np.ndarray, kind: np.ndarray, i: np.ndarray, u: np.ndarray, j: np.ndarray, v: np.ndarray
) -> np.ndarray:
    """Return values between nodes.

    Where one of the four nodes around has no value, the plane through the other three counts
    within their triangle; a node without weight never counts.
    """
    rows, columns = (
        np.minimum(n + 1, size - 1) for n, size in zip((i, j), table.shape[1:], strict=True)
    )
    nodes = [[table[kind, r, c] for c in (j, columns)] for r in (i, rows)]
    found = np.zeros(np.shape(u))
    for a, share in enumerate((1 - u, u)):
        for b, part in enumerate((1 - v, v)):
            found += np.where(share * part > 0, share * part * nodes[a][b], 0.0)
    for a, share in enumerate((1 - u, u)):
        for b, part in enumerate((1 - v, v)):
            far, beside, below = nodes[1 - a][1 - b], nodes[a][1 - b], nodes[1 - a][b]
            plane = far + share * (beside - far) + part * (below - far)
            inside = np.isnan(nodes[a][b]) & (share + part <= 1.0)
            found = np.where(np.isnan(found) & inside, plane, found)
    return found
