"""One real step after another: where a rover stands, and what the next step costs there."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from nullmotion.rover.path import STEEPEST, Way
from nullmotion.rover.path_cost import StepCost
from nullmotion.rover.path_graph import slopes
from nullmotion.rover.path_lattice import Lattice
from nullmotion.rover.path_roll import rolled
from nullmotion.rover.terrain import HeightField


class Stance(NamedTuple):
    """A footprint: corners, counter-clockwise [m], (3, 3), and the spikes on them, (3,)."""

    corners: np.ndarray
    feet: np.ndarray

    def lattice(self, edge_length: float, normal: np.ndarray) -> Lattice:
        """Return the lattice of which this is the first cell."""
        along = self.corners[1] - self.corners[0]
        heading = float(np.arctan2(along[1], along[0]))
        a, b, c = (int(i) for i in self.feet)
        x, y = (float(v) for v in self.corners[:, :2].mean(axis=0))
        return Lattice.laid(edge_length, (x, y), heading, normal, (a, b, c, 6 - a - b - c))

    def way(self, left: int) -> Way:
        """Return the middles of this footprint and of the one behind a corner on the map."""
        middle = self.corners.mean(axis=0)[:2]
        edge = (self.corners[(left + 1) % 3] + self.corners[(left + 2) % 3])[:2] / 2
        return middle, 2 * edge - middle


class Step(NamedTuple):
    """A step that can be made: what `path_travel.Travel` keeps of it, and where it leads."""

    after: Stance
    left: int
    turn: float
    pitch: float
    cross: float
    energy: float
    time: float
    margin: float


def next_step(field: HeightField, cost: StepCost, stance: Stance, left: int) -> Step | None:
    """Return the step that leaves a corner behind, charged as in `path_graph`.

    Returns:
        The step; None if the rover cannot make it or would not stay where it leads.
    """
    landing = rolled(field, stance.corners, left)
    if landing is None:
        return None
    first, second = (left + 1) % 3, (left + 2) % 3
    ways = slopes(np.array([stance.corners, landing.corners]))
    if (ways[0] <= -STEEPEST).any():
        return None
    forth = np.array([1.0, -1.0])  # the edge is seen from behind after the step
    pitch, cross = (way[:, left] * forth for way in ways)
    costs = cost(np.full(2, stance.feet[first]), np.full(2, stance.feet[second]), pitch, cross)
    energy = float(np.mean(costs.energy))
    if not np.isfinite(energy):
        return None
    feet = np.empty(3, int)
    feet[[left, first, second]] = 6 - stance.feet.sum(), stance.feet[second], stance.feet[first]
    return Step(
        Stance(landing.corners, feet),
        left,
        landing.turn,
        float(pitch[0]),
        float(cross[0]),
        energy,
        float(np.mean(costs.time)),
        float(np.min(costs.margin)),
    )
