"""The manoeuvres of Papakonstantinou et al. 2021, on the paper's plant and on others.

Everything comes from the scenarios ``papakonstantinou-*`` of the library.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from functools import cached_property
from typing import Any

import numpy as np

from nullmotion.laws.follow_plan import FollowPlan
from nullmotion.papers.papakonstantinou2021_flight import Flight
from nullmotion.plan import Found, Rollouts, exact, prepared, skip
from nullmotion.plan.costs.papakonstantinou import Papakonstantinou
from nullmotion.plan.result import Knots
from nullmotion.scenario import Scenario, build, load_scenario
from nullmotion.scenario.schema_spacecraft import PlanSection
from nullmotion.sim import Setup, run

NONE: Knots = (0.0,) * 10
PRINTED_DT = 0.1  # step of the paper [s], in which its cost counts time


@dataclass(frozen=True)
class Case:
    """One manoeuvre of the paper.

    Attributes:
        name: Short name; the scenario is ``papakonstantinou-`` and this.
        title: For figures.
        course: The paper's L, in units of k_max.
        printed: As it stands in the paper, where that is not the same.
    """

    name: str
    title: str
    course: Knots
    printed: Knots = ()


CASES = {
    "roll": Case("roll", "roll by -90 deg", (1, 1, 0, -1, 0, 0, 0, 0, 0, 0)),
    "three-axis": Case(
        "three-axis",
        "turn about three axes",
        (0, -1, 1, 0, 0, 0, 0, 0, 1, -1),
        (0, -1, 1, 0, 0, 0, 0, 1, -1),  # one zero is lost
    ),
    "kinematic": Case("kinematic", "kinematics only", (-1, 1, 1, 1, 1, 0, -1, 0, 0, -1)),
}


@dataclass(frozen=True)
class Plant:
    """What flies.

    Attributes:
        name: In tables.
        values: Set over the scenario; those of a body only where there is one.
    """

    name: str
    values: Mapping[str, Any] = field(default_factory=dict)


_COUPLED = {"spacecraft.momentum_coupling": True}
_FINE = {"simulation.dt_s": 0.01, "simulation.integrator": "rk4", "plan.lag": False}
PUBLISHED = Plant("as published")
COUPLED = Plant("with omega x h", _COUPLED)
FINE = Plant("with omega x h, RK4 at 0.01 s", _COUPLED | _FINE)
FINE_KINEMATIC = Plant("RK4 at 0.01 s", _FINE)


def plants(case: Case) -> tuple[Plant, ...]:
    """Return the plants on which a manoeuvre is planned."""
    if case.name == "kinematic":
        return PUBLISHED, FINE_KINEMATIC
    return PUBLISHED, COUPLED, FINE


@dataclass(frozen=True)
class Manoeuvre:
    """One manoeuvre on one plant; what is costly is done once."""

    case: Case
    plant: Plant = PUBLISHED

    @cached_property
    def scenario(self) -> Scenario:
        """The scenario."""
        return load_scenario(f"papakonstantinou-{self.case.name}", self.plant.values)

    @property
    def section(self) -> PlanSection:
        """How null motion is planned."""
        found = self.scenario.plan
        assert found is not None
        return found

    @cached_property
    def setup(self) -> Setup:
        """The run without null motion."""
        return replace(build.setup(self.scenario), metrics=())

    @cached_property
    def cost(self) -> Papakonstantinou:
        """Eq 25; time counts in steps of 0.1 s whatever the step."""
        assert self.section.weights is not None
        g1, g2, g3, g4 = self.section.weights
        scale = self.setup.dt / PRINTED_DT
        return Papakonstantinou(
            (g1, g2 * scale, g3, g4 * scale),
            self.section.manipulability_threshold,
            index=self.section.index,
        )

    def follow(self, knots: Sequence[float]) -> FollowPlan:
        """Return the law with a course of null motion."""
        base = self.setup.law
        return FollowPlan(
            base.name,
            {f.name: getattr(base, f.name) for f in fields(base)},
            tuple(knots),
            self.setup.steps * self.setup.dt,
            self.section.k_max,
            self.section.lag,
        )

    def fly(self, knots: Sequence[float]) -> Flight:
        """Return the run with a course of null motion."""
        flown = run(replace(self.setup, law=self.follow(knots)))
        return Flight(flown, self.cost)

    @cached_property
    def rollouts(self) -> Rollouts:
        """The manoeuvre compiled for searches."""
        section = self.section
        return prepared(self.setup, self.cost, section.depth, section.k_max, section.lag)

    @cached_property
    def heuristic(self) -> Found:
        """What the paper's search finds."""
        return skip.search(self.rollouts, self.section.levels)

    @property
    def heuristic_course(self) -> Knots:
        """Its own course, also where that is worse than no null motion."""
        return tuple(self.heuristic.certificate["heuristic_knots"])

    @cached_property
    def optimum(self) -> Found:
        """The best course of all, with proof."""
        return exact.search(self.rollouts, self.section.levels)

    def value(self, knots: Sequence[float]) -> float:
        """Return the cost of a course."""
        return float(self.rollouts.values(np.array([knots], float))[0])

    def parts(self, knots: Sequence[float]) -> dict[str, float]:
        """Return the terms of a course's cost."""
        totals = self.rollouts.totals(np.array([knots], float))[:, 0]
        found = self.cost.parts(totals, self.rollouts.steps)
        return {name: float(value) for name, value in found.items()}
