"""How far the energy of a step depends on how the planner is set.

The least margin that Eq 84 maximises fixes a step only where the margin is least. Elsewhere the
regularisation, the guess and the time allowed decide, and with them the energy.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

from nullmotion.rover.plan_error import PlanError
from nullmotion.rover.planner import plan_step
from nullmotion.rover.rover import Rover, Site
from nullmotion.rover.settings import Settings
from nullmotion.rover.step_plan import StepPlan
from nullmotion.rover.watch import Progress

VARIED = tuple(
    Settings(regularisation=weight, start_durations=(guess,), longest=longest)
    for weight, guess, longest in product((1e-3, 3e-3, 1e-2), (2.5, 6.0), (5.0, 10.0))
)


@dataclass(frozen=True, eq=False)
class Spread:
    """Plans of one step under several settings.

    Attributes:
        settings: The settings, (k,).
        plans: The plans, None where there is none, (k,).
    """

    settings: tuple[Settings, ...]
    plans: tuple[StepPlan | None, ...]

    @property
    def costs(self) -> tuple[float, ...]:
        """Cost of travel of the plans there are [J/(kg m)], ascending."""
        return tuple(sorted(plan.cost_of_travel for plan in self.plans if plan is not None))


def energy_spread(
    rover: Rover,
    edge: int = 1,
    site: Site | None = None,
    settings: Sequence[Settings] = VARIED,
    progress: Progress | None = None,
) -> Spread:
    """Plan a step under several settings.

    Args:
        rover: The rover.
        edge: Edge, from 1.
        site: Gravity and slope; level ground on Mars by default.
        settings: What to try.
        progress: Called with the share done, in [0, 1].

    Raises:
        InputError: For an edge that the rover does not have.
    """
    plans: list[StepPlan | None] = []
    for one in settings:
        try:
            plans.append(plan_step(rover, edge, site, settings=one))
        except PlanError:
            plans.append(None)
        if progress:
            progress(len(plans) / len(settings))
    return Spread(tuple(settings), tuple(plans))
