"""Kim et al. 2012: VSCMG flywheels brought to speed from rest while the attitude is tracked.

Gains are not printed; those of the scenarios ``kim2014-case1`` and ``kim2014-case2`` bring back
what the paper says of its two cases.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

from nullmotion.papers import kim2014_beyond as beyond
from nullmotion.papers import kim2014_figures as drawn
from nullmotion.papers.base import Cell, Paper, PaperResult, Progress
from nullmotion.papers.kim2014_cases import CASES, fly
from nullmotion.papers.kim2014_text import cells


@dataclass(frozen=True)
class Kim2014(Paper):
    """Tables 1 and 2, Figures 2-13, and the same startups on plants with nothing left out."""

    name: ClassVar[str] = "kim2014"
    title: ClassVar[str] = (
        "New Startup Method Using Internal Momentum Management "
        "of Variable-Speed Control Moment Gyroscopes"
    )
    citation: ClassVar[str] = (
        "D. Kim, F. A. Leve, N. G. Fitz-Coy, W. E. Dixon, "
        "J. Guidance, Control, and Dynamics 35(5) (2012)"
    )

    def cells(self, progress: Progress | None = None) -> list[Cell]:
        """Return every printed value with ours."""
        return cells(fly(_counted(progress, len(CASES))))

    def run(self, out: Path, progress: Progress | None = None, figures: bool = True) -> PaperResult:
        """Write ``tables.json``, ``tables.md``, ``beyond.json`` and ``figures/``."""
        given = beyond.variants()
        total = len(CASES) + beyond.kernels(given) + (drawn.COUNT if figures else 0)
        done = _counted(progress, total)
        flights = fly(done)
        result = PaperResult(
            self.name, self.title, cells(flights), note=beyond.NOTE, citation=self.citation
        )
        others = beyond.fly(given, done)
        result.beyond = [beyond.row(*item) for item in others.items()]
        result.write(out)
        if figures:
            for path in drawn.draw(out / "figures", flights, others):
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
