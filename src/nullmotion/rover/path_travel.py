"""A trip as it was made: footprints on the ground, and what it cost."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from nullmotion.rover.mission_cost import Upkeep
from nullmotion.rover.path import Path


@dataclass(frozen=True, eq=False)
class Travel:
    """A trip of n steps.

    Attributes:
        goal: Where it went, (x, y) [m].
        mass: Of the rover [kg].
        upkeep: What the rotor takes beside the steps.
        path: The path that was planned at the start.
        corners: Footprints, counter-clockwise from above [m], (n + 1, 3, 3).
        feet: Which spike stands on each corner, (n + 1, 3).
        left: Which corner each step leaves, (n,).
        turn: Angle of each step [rad], (n,).
        pitch: Slope under the rover in the direction of each step [rad], (n,).
        cross: Slope along the edge of each step [rad], (n,).
        energy: Energy of each step [J], (n,).
        time: Duration of each step [s], (n,).
        margin: Torque to spare in each step [N m], (n,).
        drift: How far a spike came to stand from its lattice point at most [m].
        searches: How often the path was searched.
    """

    goal: tuple[float, float]
    mass: float
    upkeep: Upkeep
    path: Path
    corners: np.ndarray
    feet: np.ndarray
    left: np.ndarray
    turn: np.ndarray
    pitch: np.ndarray
    cross: np.ndarray
    energy: np.ndarray
    time: np.ndarray
    margin: np.ndarray
    drift: float
    searches: int

    @property
    def steps(self) -> int:
        """Number of steps."""
        return len(self.left)

    @property
    def edges(self) -> np.ndarray:
        """Spikes (a, b) about which each step turns, (n, 2)."""
        rows = np.arange(self.steps)
        return np.column_stack([self.feet[rows, (self.left + k) % 3] for k in (1, 2)])

    @property
    def middles(self) -> np.ndarray:
        """Middles of the footprints [m], (n + 1, 3)."""
        return self.corners.mean(axis=1)

    @property
    def distance(self) -> float:
        """Way of the footprints' middles [m]."""
        return float(np.linalg.norm(np.diff(self.middles, axis=0), axis=1).sum())

    @property
    def straight(self) -> float:
        """Distance from the first to the last footprint as the crow flies [m]."""
        return float(np.linalg.norm(self.middles[-1] - self.middles[0]))

    @property
    def miss(self) -> float:
        """Distance of the last footprint's middle from the goal on the map [m]."""
        return float(np.linalg.norm(self.middles[-1, :2] - self.goal))

    @property
    def duration(self) -> float:
        """Time of all steps and the pauses before them, without the spin-up [s]."""
        return float(self.time.sum()) + self.upkeep.pause * self.steps

    @property
    def step_energy(self) -> float:
        """Energy of all steps [J]."""
        return float(self.energy.sum())

    @property
    def drag_energy(self) -> float:
        """What drag takes on the way [J]."""
        return self.upkeep.between(float(self.time.sum()), self.steps)

    @property
    def cost_of_travel(self) -> float:
        """All energy, spin-up included, per mass and distance [J/(kg m)]; NaN without a step."""
        total = self.step_energy + self.drag_energy + self.upkeep.spin_up_energy
        return self._per_metre(total)

    @property
    def step_cost(self) -> float:
        """Energy of the steps alone per mass and distance [J/(kg m)]; NaN without a step."""
        return self._per_metre(self.step_energy)

    def summary(self) -> dict[str, Any]:
        """Return the trip in numbers, for files and tables."""
        return {
            "steps": self.steps,
            "distance_m": self.distance,
            "straight_m": self.straight,
            "miss_m": self.miss,
            "duration_s": self.duration,
            "step_energy_J": self.step_energy,
            "drag_energy_J": self.drag_energy,
            "spin_up_energy_J": self.upkeep.spin_up_energy,
            "cost_of_travel_J_kg_m": self.cost_of_travel,
            "step_cost_J_kg_m": self.step_cost,
            "least_margin_Nm": float(self.margin.min(initial=np.inf)),
            "steepest_climb_deg": float(np.degrees(self.pitch.max(initial=0.0))),
            "steepest_descent_deg": float(np.degrees(-self.pitch.min(initial=0.0))),
            "drift_m": self.drift,
            "searches": self.searches,
        }

    def _per_metre(self, energy: float) -> float:
        return energy / (self.mass * self.distance) if self.steps else float("nan")
