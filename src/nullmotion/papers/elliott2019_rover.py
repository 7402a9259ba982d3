"""Elliott 2019, Chapter 5 and Section 7.4: the rover PETER, beside rovers with reaction wheels.

What the dissertation leaves open is said in ``docs/papers.md``.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import ClassVar

from nullmotion.papers import elliott2019_rover_chassis as chassis
from nullmotion.papers import elliott2019_rover_figures as drawn
from nullmotion.papers import elliott2019_rover_missions as missions
from nullmotion.papers import elliott2019_rover_steps as table4
from nullmotion.papers import elliott2019_rover_wheels as wheels
from nullmotion.papers.base import Cell, Paper, PaperResult, Progress

_NOTE = (
    "The ten steps behind Table 4 and Figs 35 and 36: planned, and run in closed loop from a "
    "gimbal at rest, with the edge held by its spikes."
)


@dataclass(frozen=True)
class Elliott2019Rover(Paper):
    """Tables 4 and 6 to 9, Figures 35 and 36, and a step in pictures."""

    name: ClassVar[str] = "elliott2019-rover"
    title: ClassVar[str] = (
        "Momentum Control Systems and Their Application in Robotic Systems: PETER"
    )
    citation: ClassVar[str] = "D. S. Elliott, PhD dissertation, Cornell University (2019), Ch. 5"

    def cells(self, progress: Progress | None = None) -> list[Cell]:
        """Return every printed value with ours."""
        return cells(table4.steps(_counted(progress, table4.COUNT)))

    def run(self, out: Path, progress: Progress | None = None, figures: bool = True) -> PaperResult:
        """Write ``tables.json``, ``tables.md``, ``beyond.json`` and ``figures/``."""
        done = _counted(progress, table4.COUNT + drawn.COUNT * figures)
        found = table4.steps(done)
        result = PaperResult(
            self.name, self.title, cells(found), note=_NOTE, citation=self.citation
        )
        result.beyond = [step.beyond() for step in found.values()]
        result.write(out)
        if figures:
            for path in drawn.draw(out / "figures", found):
                result.figures.append(path)
                done()
        return result


def cells(found: table4.Steps) -> list[Cell]:
    """Return all tables: 4, 6, 7, 8 and 9."""
    six = wheels.cells(table4.averages(found))
    ours = [replace(c, parameters="fitted") if c.column.startswith("peter") else c for c in six]
    return [*table4.cells(found), *ours, *missions.cells(), *chassis.cells()]


def _counted(progress: Progress | None, total: int) -> Callable[[], None]:
    count = 0

    def done() -> None:
        nonlocal count
        count += 1
        if progress:
            progress(count / total)

    return done
