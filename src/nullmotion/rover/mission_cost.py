"""What a trip costs a CMG rover, with the rotor that turns whether it moves or not.

    cost of travel = c + P (t_pause + t_step)/(M d) + (I_r w_r^2/2 + P t_up)/(M D)

c: energy of the steps per mass and distance; P: power that bearings and air take; d: distance of
a step; D: of the trip; t_up: time to spin the rotor up. The last term fades with the distance, so
that the CMG rover beats one with reaction wheels beyond some distance. Elliott 2019, Section
5.6.2 and Table 7.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nullmotion.errors import InputError
from nullmotion.rover.chassis import positive
from nullmotion.rover.rover import Rover

DRAG_POWER = 50.0  # [W], Section 5.6.2
PAUSE = 60.0  # [s]
SPIN_UP_TIME = 86_400.0  # [s]


@dataclass(frozen=True)
class Upkeep:
    """What the rotor takes beside the steps.

    Args:
        power: P, drawn by drag [W].
        pause: t_pause before each step [s].
        spin_up_time: t_up [s].
        rotor_energy: I_r w_r^2/2 [J].

    Raises:
        InputError: For a value that is not finite or below 0.
    """

    power: float = DRAG_POWER
    pause: float = PAUSE
    spin_up_time: float = SPIN_UP_TIME
    rotor_energy: float = 0.0

    def __post_init__(self) -> None:
        """Check what can be checked."""
        for key in ("power", "pause", "spin_up_time", "rotor_energy"):
            if not 0 <= getattr(self, key) < np.inf:
                raise InputError(f"upkeep.{key}", getattr(self, key), "a finite number, 0 or more")

    @classmethod
    def of(
        cls,
        rover: Rover,
        power: float = DRAG_POWER,
        pause: float = PAUSE,
        spin_up_time: float = SPIN_UP_TIME,
    ) -> Upkeep:
        """Return the upkeep of a rover's rotor."""
        cmg = rover.cmg
        energy = 0.5 * cmg.rotor_inertia * cmg.rotor_speed**2
        return cls(power, pause, spin_up_time, energy)

    @property
    def spin_up_energy(self) -> float:
        """Energy to get the rotor to its speed [J]."""
        return self.rotor_energy + self.power * self.spin_up_time

    def between(self, time: float, steps: int = 1) -> float:
        """Return what drag takes during steps and the pauses before them [J].

        Args:
            time: Duration of the steps together [s].
            steps: Number of steps.
        """
        return self.power * (self.pause * steps + time)


@dataclass(frozen=True)
class CmgMission:
    """Trips of a CMG rover whose steps cost the same on average.

    Args:
        mass: M [kg].
        step_cost: c [J/(kg m)].
        pace: (t_pause + t_step)/d [s/m].
        upkeep: What the rotor takes.

    Raises:
        InputError: For a mass or pace that is not above 0, or a cost below 0.
    """

    mass: float
    step_cost: float
    pace: float
    upkeep: Upkeep

    def __post_init__(self) -> None:
        """Check what can be checked."""
        positive("mass", self.mass)
        positive("pace_s_m", self.pace)
        if not 0 <= self.step_cost < np.inf:
            raise InputError("step_cost", self.step_cost, "a finite number, 0 or more")

    @classmethod
    def of(
        cls, rover: Rover, step_cost: float, step_time: float, upkeep: Upkeep | None = None
    ) -> CmgMission:
        """Return trips of a rover by its mean cost [J/(kg m)] and time [s] of a step."""
        care = upkeep or Upkeep.of(rover)
        pace = (care.pause + step_time) / rover.edge_frame(1).distance
        return cls(rover.mass, step_cost, pace, care)

    @property
    def running_cost(self) -> float:
        """Cost of travel of a trip without end [J/(kg m)]."""
        return self.step_cost + self.upkeep.power * self.pace / self.mass

    def cost_of_travel(self, distance: float) -> float:
        """Return the cost of travel of a trip [J/(kg m)].

        Raises:
            InputError: For a distance that is not above 0.
        """
        D = positive("distance_m", distance)
        return self.running_cost + self.upkeep.spin_up_energy / (self.mass * D)

    def break_even(self, other: float) -> float:
        """Return the distance from which a trip costs less than another rover's [m].

        Args:
            other: The other rover's cost of travel [J/(kg m)].

        Returns:
            The distance; inf if the other rover is always better.
        """
        saved = other - self.running_cost
        return self.upkeep.spin_up_energy / (self.mass * saved) if saved > 0 else np.inf
