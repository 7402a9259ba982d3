"""Papakonstantinou et al. 2021: null motion planned over a whole manoeuvre on a ternary tree.

The readings of what the paper leaves open stand in the scenarios ``papakonstantinou-*`` of
the library and in ``docs/papers.md``.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

from nullmotion.papers import papakonstantinou2021_beyond as beyond
from nullmotion.papers import papakonstantinou2021_figures as drawn
from nullmotion.papers import papakonstantinou2021_table1 as table1
from nullmotion.papers import papakonstantinou2021_tables as tables
from nullmotion.papers import papakonstantinou2021_text as text
from nullmotion.papers.base import Cell, Paper, PaperResult, Progress
from nullmotion.papers.papakonstantinou2021_cases import (
    CASES,
    FINE,
    FINE_KINEMATIC,
    NONE,
    PUBLISHED,
    Manoeuvre,
    plants,
)
from nullmotion.papers.papakonstantinou2021_flight import Flight


@dataclass(frozen=True)
class Papakonstantinou2021(Paper):
    """Tables 1-4, Figures 6-12, and the exact optimum beside the paper's plans."""

    name: ClassVar[str] = "papakonstantinou2021"
    title: ClassVar[str] = (
        "Global Steering for Control Moment Gyroscope Clusters "
        "Using Heuristic Variable Search Techniques"
    )
    citation: ClassVar[str] = (
        "C. Papakonstantinou, V. J. Lappas, H. Schaub, V. Kostopoulos, "
        "J. Spacecraft and Rockets (2021)"
    )

    def cells(self, progress: Progress | None = None) -> list[Cell]:
        """Return Tables 1 to 4 and the figures printed in the text."""
        runs = published()
        return cells(runs, fly(runs, counted(progress, len(runs))))

    def run(self, out: Path, progress: Progress | None = None, figures: bool = True) -> PaperResult:
        """Write ``tables.json``, ``tables.md``, ``beyond.json`` and ``figures/``."""
        runs = published()
        every = planned(runs)
        physical = {title(run): run for run in every if run.plant in (FINE, FINE_KINEMATIC)}
        drawing = len(physical) + drawn.COUNT if figures else 0
        done = counted(progress, len(runs) + len(every) + drawing)

        flights = fly(runs, done)
        result = PaperResult(
            self.name, self.title, cells(runs, flights), note=beyond.NOTE, citation=self.citation
        )
        for run in every:
            result.beyond += beyond.rows(run)
            done()
        result.write(out)
        if figures:
            titles = {name: case.title for name, case in CASES.items()}
            others = fly(physical, done)
            for path in drawn.draw(out / "figures", flights, titles, others):
                result.figures.append(path)
                done()
        return result


def published() -> dict[str, Manoeuvre]:
    """Return the manoeuvres on the paper's plant, by name."""
    return {name: Manoeuvre(case) for name, case in CASES.items()}


def planned(runs: dict[str, Manoeuvre]) -> list[Manoeuvre]:
    """Return these and the same on every other plant, case by case."""
    return [
        runs[name] if plant is PUBLISHED else Manoeuvre(case, plant)
        for name, case in CASES.items()
        for plant in plants(case)
    ]


def fly(runs: dict[str, Manoeuvre], done: Callable[[], None]) -> dict[str, dict[str, Flight]]:
    """Fly manoeuvres without null motion, with the paper's L, and with the best course."""
    flights = {}
    for name, run in runs.items():
        courses = {"none": NONE, "paper": run.case.course, "optimum": run.optimum.knots}
        flights[name] = {course: run.fly(knots) for course, knots in courses.items()}
        done()
    return flights


def cells(runs: dict[str, Manoeuvre], flights: dict[str, dict[str, Flight]]) -> list[Cell]:
    """Return every printed value with ours."""
    return [
        *table1.cells(runs["roll"], runs["kinematic"]),
        *tables.cells(flights),
        *text.cells(runs, flights),
    ]


def title(run: Manoeuvre) -> str:
    """Return a title that names the plant too."""
    return f"{run.case.name}: {run.plant.name}"


def counted(progress: Progress | None, total: int) -> Callable[[], None]:
    """Return what is called after each of so many parts of the work."""
    count = 0

    def done() -> None:
        nonlocal count
        count += 1
        if progress:
            progress(count / total)

    return done
