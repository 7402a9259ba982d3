"""Convex allocation on the triangle: time of a sample, and the flights of Eq 45."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from common import Row, median_time

import nullmotion as nm
from nullmotion.allocation.compiled import evaluate
from nullmotion.laws.allocation_mpc import AllocationMpc
from nullmotion.scenario import build, load_scenario
from nullmotion.sim import run

MOVES = (1, 5, 10, 20)
TARGET = 300.0  # [us] for five moves


@dataclass(frozen=True)
class Watched(AllocationMpc):
    """The law, keeping what it was asked."""

    name = "watched"
    seen: list[Any] = field(default_factory=list)

    def step(self, array: Any, obs: Any, state: Any) -> Any:
        self.seen.append((array, obs, state))
        return self.law().step(array, obs, state)

    def law(self) -> AllocationMpc:
        return AllocationMpc(N_p=self.N_p, acceleration_limit_rad_s2=7.0)


def samples(moves: int) -> list[Any]:
    """Return what the law is asked in the first 20 s of both slews of Eq 45."""
    law = Watched(N_p=moves, acceleration_limit_rad_s2=7.0)
    run(replace(build.setup(load_scenario("pereira-eq45")), law=law, metrics=()))
    return [asked for asked in law.seen if asked[1].t % 30.0 < 20.0 and asked[1].t > 29.0]


def sample_time(moves: int, rounds: int) -> Row:
    """Measure a whole sample: matrices, solution, its check, shifted plan."""
    asked, law, at = samples(moves), Watched(N_p=moves).law(), 0

    def sample() -> None:
        nonlocal at
        law.step(*asked[at % len(asked)])
        at += 1

    sample()
    seconds = median_time(sample, rounds * len(asked))
    limit = TARGET if moves == 5 else None
    note = f"{len(asked)} samples of the slews, {rounds} rounds"
    return Row(
        f"allocation-mpc, triangle, N = {moves}", 1e6 * seconds, "us", at_most=limit, note=note
    )


def matrices_time(rounds: int) -> Row:
    """Measure the compiled blocks and the nearest line alone."""
    array, plan = nm.layouts.create("triangle", rate_limit=1.5), np.zeros((5, 3))
    delta, wanted = np.array([0.3, 0.9, -1.0]), np.full((5, 2), 0.3)

    def made() -> None:
        evaluate(array, delta, plan, wanted, 100.0, 0.1, False)

    made()
    return Row("its matrices and nearest line, N = 5", 1e6 * median_time(made, rounds), "us")


def flown(quick: bool) -> list[Row]:
    """Fly the attitude steps of Eq 45."""
    from nullmotion.papers.pereira2022_cases import CASES, fly

    limits = {
        "N = 1, no term": ({"at_least": 0.3}, {"at_most": 0.1}, {}),
        "N = 1, term": ({}, {"at_least": 0.3}, {}),
        "N = 5, term": ({"at_most": 1e-3}, {"at_least": 0.49}, {"at_most": 1.3}),
        "N = 5, no term": ({}, {}, {}),
    }
    found = []
    for name in ["N = 5, term"] if quick else CASES:
        flight = fly(CASES[name])
        values = (
            ("torque mismatch", float(flight.mismatch.max()), "N m"),
            ("least distance", float(flight.distance.min()), "rad"),
            ("peak rate", flight.peak_rate, "rad/s"),
        )
        for (what, value, unit), limit in zip(values, limits[name], strict=True):
            found.append(Row(f"Eq 45, {name}: {what}", value, unit, **limit))
    return found


def rows(quick: bool) -> list[Row]:
    """Measure everything."""
    rounds = 2 if quick else 10
    moves = (5,) if quick else MOVES
    timed = [sample_time(count, rounds) for count in moves]
    return [*timed, matrices_time(2000), *flown(quick)]


if __name__ == "__main__":
    import sys

    for each in rows("--quick" in sys.argv):
        print(each.markdown())
