"""Pereira 2022: convex allocation that keeps away from the triangle's singular lines.

Inertia, h0, acceleration limit, gains and weights are not printed; those of the scenario
``pereira-eq45`` give what the paper says of its figures.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

from nullmotion.papers import pereira2022_figures as drawn
from nullmotion.papers.base import Cell, Paper, PaperResult, Progress
from nullmotion.papers.pereira2022_cases import BEYOND, CASES, flights
from nullmotion.papers.pereira2022_text import cells

_NOTE = (
    "The flights behind Figs 11-18 in numbers, and others of the same scenario. Mismatch is "
    "|J gamma_dot - hdot_c| at the start of a sample, mean torque error that of the change of "
    "momentum over it; its fraction of hdot_c counts where that is above 1 % of its peak. The "
    "wheel's momentum is the greatest of the reaction wheel."
)


@dataclass(frozen=True)
class Pereira2022(Paper):
    """Eqs 23 and 24, Figures 7-9 and 11-18, and the numbers behind them."""

    name: ClassVar[str] = "pereira2022"
    title: ClassVar[str] = (
        "A Convex Allocation Framework for Singularity Avoidance in Control Moment Gyro Clusters"
    )
    citation: ClassVar[str] = "H. A. C. Pereira, Instituto Superior Técnico (2022)"

    def cells(self, progress: Progress | None = None) -> list[Cell]:
        """Return every printed value with ours."""
        return cells(flights(CASES, _counted(progress, len(CASES))))

    def run(self, out: Path, progress: Progress | None = None, figures: bool = True) -> PaperResult:
        """Write ``tables.json``, ``tables.md``, ``beyond.json`` and ``figures/``."""
        total = len(CASES) + len(BEYOND) + (drawn.COUNT if figures else 0)
        done = _counted(progress, total)
        flown = flights(CASES, done)
        result = PaperResult(
            self.name, self.title, cells(flown), note=_NOTE, citation=self.citation
        )
        result.runs = {name: flight.run for name, flight in flown.items()}
        every = flown | flights(BEYOND, done)
        result.beyond = [flight.row(name) for name, flight in every.items()]
        result.write(out)
        if figures:
            for path in drawn.draw(out / "figures", flown):
                result.figures.append(path)
                done()
        return result


def _counted(progress: Progress | None, total: int) -> Callable[[], None]:
    count = 0

    def done() -> None:
        nonlocal count
        count += 1
        if progress:
            progress(count / total)

    return done
