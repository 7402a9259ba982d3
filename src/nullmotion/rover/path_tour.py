"""A trip in the making: following paths, and searching again where the ground demands it."""

from __future__ import annotations

import numpy as np

from nullmotion.errors import InputError
from nullmotion.rover.mission_cost import Upkeep
from nullmotion.rover.path import Path, Way, find_path
from nullmotion.rover.path_cost import StepCost
from nullmotion.rover.path_lattice import Lattice
from nullmotion.rover.path_roll import first_footprint
from nullmotion.rover.path_search import Progress
from nullmotion.rover.path_walk import Stance, Step, next_step
from nullmotion.rover.terrain import HeightField

_FIRST = np.zeros(3, int)  # the lattice's first cell
_SLOW = 10  # times as many steps, or searches, as planned: it does not get there


class Tour:
    """A rover on its way.

    Args:
        field: The ground.
        lattice: A lattice whose first cell is where the rover is put down.
        cost: What a step costs.
        size: Edge length [m].
        upkeep: What the rotor takes beside the steps.

    Attributes:
        first: Where it was put down.
        steps: The steps made.
        paths: The paths found.
        off: How far a spike came to stand from its lattice point at most [m].

    Raises:
        InputError: For ground on which it cannot be put down.
    """

    def __init__(
        self, field: HeightField, lattice: Lattice, cost: StepCost, size: float, upkeep: Upkeep
    ) -> None:
        """Put the rover down."""
        self.field, self.cost, self.size, self.upkeep = field, cost, size, upkeep
        self.lattice, self.normal = lattice, field.mean_normal()
        corners = first_footprint(field, lattice.corners(_FIRST), size)
        self.first = self.stance = Stance(corners, lattice.feet(_FIRST))
        self.steps: list[Step] = []
        self.paths: list[Path] = []
        self.off = 0.0

    def go(
        self,
        goal: tuple[float, float],
        within: float,
        drift: float,
        progress: Progress | None = None,
    ) -> None:
        """Go to a goal.

        Args:
            goal: Where, (x, y) [m].
            within: Distance of a footprint's middle from the goal that is good enough [m].
            drift: How far a spike may stand from its lattice point [m].
            progress: Called with the finished share.

        Raises:
            InputError: For a goal that cannot be reached.
        """
        barred: list[Way] = []
        while True:
            path = find_path(
                self.field,
                self.lattice,
                self.cost,
                goal,
                within=within,
                power=self.upkeep.power,
                pause=self.upkeep.pause,
                barred=barred,
            )
            self.paths.append(path)
            self._check(goal)
            done, blocked = self._follow(path, drift, progress)
            if blocked is None and done == len(path.left):
                return
            if blocked is not None:
                barred.append(self.stance.way(blocked))
            self.lattice = self.stance.lattice(self.size, self.normal)

    def _follow(
        self, path: Path, drift: float, progress: Progress | None
    ) -> tuple[int, int | None]:
        """Make the steps of a path; return how many, and which corner cannot be left if any."""
        whole = max(len(self.paths[0].left), 1)
        for k, left in enumerate(path.left):
            step = next_step(self.field, self.cost, self.stance, int(left))
            if step is None:
                return k, int(left)
            self.steps.append(step)
            self.stance = step.after
            lattice = self.lattice.corners(path.cells[k + 1])
            off = float(np.linalg.norm(self.stance.corners[:, :2] - lattice, axis=1).max())
            self.off = max(self.off, off)
            if progress:
                progress(1.0 - (len(path.left) - k - 1) / whole)
            if off > drift:
                return k + 1, None
        return len(path.left), None

    def _check(self, goal: tuple[float, float]) -> None:
        """Refuse a goal that does not come nearer."""
        if max(len(self.steps), len(self.paths)) > _SLOW * (len(self.paths[0].left) + 5):
            allowed = f"a goal that comes nearer: in {len(self.steps)} steps it does not"
            raise InputError("mission.goal_m", list(goal), allowed)
