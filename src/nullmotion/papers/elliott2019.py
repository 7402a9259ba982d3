"""Elliott 2019, Chapters 3 and 4: constraint functions for planar arrays and the box-90.

What the dissertation leaves open (the random numbers of Section 4.4, the starts of the
optimiser) is said in ``docs/papers.md``.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

import numpy as np

from nullmotion.papers import elliott2019_comparison as comparison
from nullmotion.papers import elliott2019_equations as equations
from nullmotion.papers import elliott2019_figures as drawn
from nullmotion.papers import elliott2019_planar as planar
from nullmotion.papers import elliott2019_sqp as sqp
from nullmotion.papers.base import Cell, Paper, PaperResult, Progress
from nullmotion.papers.elliott2019_guarantees import Guarantees
from nullmotion.papers.elliott2019_runs import SEED, Section44

SEEDS = (SEED, SEED + 1, SEED + 2)  # the first one in the tables and figures
_STARTS = "{:.1f} % of {} random starts at each of {} momenta end within 1e-6"

Done = Callable[[float], None]


@dataclass(frozen=True)
class Elliott2019(Paper):
    """Numbers of Chapters 3, 4 and Sections 7.2, 7.3; Figures 4, 10-15, 20-28, 37-41."""

    name: ClassVar[str] = "elliott2019"
    title: ClassVar[str] = "Momentum Control Systems and Their Application in Robotic Systems"
    citation: ClassVar[str] = "D. S. Elliott, PhD dissertation, Cornell University (2019), Ch. 3, 4"

    def cells(self, progress: Progress | None = None) -> list[Cell]:
        """Return what is printed in equations and text."""
        return Work(SEEDS[:1]).computed(counted(progress, _COMPUTED)).cells

    def run(self, out: Path, progress: Progress | None = None, figures: bool = True) -> PaperResult:
        """Write ``tables.json``, ``tables.md``, ``beyond.json`` and ``figures/``."""
        total = _COMPUTED + _SEED * (len(SEEDS) - 1) + _FIGURE * drawn.COUNT * figures
        done = counted(progress, total)
        work = Work(SEEDS).computed(done)
        result = PaperResult(
            self.name, self.title, work.cells, note=comparison.NOTE, citation=self.citation
        )
        result.beyond += work.beyond
        result.write(out)
        if figures:
            given = work.planar, work.searched, work.promised, work.section
            for path in drawn.draw(out / "figures", *given):
                result.figures.append(path)
                done(_FIGURE)
        return result


# shares of the work, about seconds
_PLANAR, _EQUATIONS, _SEARCH, _PROMISES, _SEED, _FIGURE = 0.5, 2.0, 0.05, 4.0, 3.0, 1.0
_COMPUTED = _PLANAR * len(planar.SIZES) + _EQUATIONS + _SEARCH * sqp.COUNT + _PROMISES + _SEED


class Work:
    """Everything that cells and figures are made of.

    Attributes:
        planar: Torque capabilities of Chapter 3 by number of CMGs.
        searched: What SLSQP finds, by number of CMGs.
        promised: The box-90's constraints.
        section: Section 4.4 with the first seed.
        cells: The printed values.
        beyond: Section 4.4 law by law and seed by seed.
    """

    def __init__(self, seeds: tuple[int, ...]) -> None:
        """Remember the seeds."""
        self.planar: dict[int, planar.Curves] = {}
        self.searched: dict[int, sqp.Comparison] = {}
        self.promised = Guarantees()
        self.section, self._others = Section44(seeds[0]), seeds[1:]
        self.cells: list[Cell] = []
        self.beyond: list[dict[str, object]] = []

    def computed(self, done: Done) -> Work:
        """Compute everything."""
        for n in planar.SIZES:
            self.planar[n] = planar.curves(n)
            done(_PLANAR)
        self.cells += equations.cells()
        done(_EQUATIONS)
        self.cells += planar.cells(self.planar)
        for n in sqp.SIZES:
            for found in sqp.compare(n):
                if found is not None:
                    self.searched[n] = found
                done(_SEARCH * (found is None))
        self.cells += searched(self.searched)
        self.cells += self.promised.cells()
        done(_PROMISES)
        self.cells += comparison.cells(self.section, self.promised.band)
        for section in (self.section, *map(Section44, self._others)):
            self.beyond += comparison.beyond(section, self.promised.band)
            done(_SEED)
        return self


def searched(found: Mapping[int, sqp.Comparison]) -> Iterator[Cell]:
    """Return what the text says of Figures 37 to 40."""
    for n, c in found.items():
        note = _STARTS.format(100 * c.found, sqp.STARTS, len(c.H))
        for column, value in (
            ("least_difference", float(np.min(c.difference))),
            ("greatest_difference", float(np.max(c.difference))),
        ):
            row = f"SQP less closed form, n = {n}"
            yield Cell("text", row, column, 0.0, value, sqp.TOLERANCE, "inferred", note)


def counted(progress: Progress | None, total: float) -> Done:
    """Return what is called with the size of each finished part of the work."""
    finished = 0.0

    def done(size: float) -> None:
        nonlocal finished
        finished += size
        if progress:
            progress(min(finished / total, 1.0))

    return done
