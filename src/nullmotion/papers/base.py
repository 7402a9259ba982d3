"""What a paper's reproduction is: cells with published and computed values, and figures."""

from __future__ import annotations

import json
import os
from collections import Counter
from collections.abc import Callable
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any, ClassVar, Literal

Progress = Callable[[float], None]
Source = Literal["printed", "inferred", "fitted"]
Value = float | str | None


@dataclass(frozen=True)
class Cell:
    """One printed value beside ours.

    Attributes:
        table: Table (or ``text``) in the paper.
        row: Row.
        column: Column; time columns have ``time`` in their name.
        published: Printed value; None where the paper shows a curve without its numbers.
        computed: Ours.
        tolerance: Largest difference that counts as equal; 0 for words.
        parameters: Whether the paper prints the parameters behind it, they were inferred
            from its text, or fitted to its results.
        note: What a reader should know.
    """

    table: str
    row: str
    column: str
    published: Value
    computed: Value
    tolerance: float = 0.0
    parameters: Source = "printed"
    note: str = ""

    @property
    def agrees(self) -> bool:
        """Whether the values are equal within the tolerance."""
        if isinstance(self.published, str) or isinstance(self.computed, str):
            return self.published == self.computed
        if self.published is None or self.computed is None:
            return False
        return abs(self.published - self.computed) <= self.tolerance

    @property
    def status(self) -> str:
        """``reproduced``, ``matched`` (with fitted parameters), ``differs`` or ``not printed``."""
        if self.published is None:
            return "not printed"
        if not self.agrees:
            return "differs"
        return "matched" if self.parameters == "fitted" else "reproduced"

    def as_row(self) -> dict[str, Any]:
        """Return the cell as a row of ``tables.json``."""
        return {**asdict(self), "status": self.status}


@dataclass
class PaperResult:
    """What `Paper.run` leaves: cells and the files written.

    Attributes:
        name: The paper's name on the command line.
        title: Its title.
        cells: Every printed value with ours.
        figures: Pictures.
        beyond: What the paper does not print, one row each; all have the same keys but for
            the details in tables of their own, which only ``beyond.json`` holds.
        note: What a reader of these rows should know.
        citation: Where the paper appeared.
        runs: Its runs by name, all on one array: what the page shows in momentum space.
    """

    name: str
    title: str
    cells: list[Cell]
    figures: list[Path] = field(default_factory=list)
    beyond: list[dict[str, Any]] = field(default_factory=list)
    note: str = ""
    citation: str = ""
    runs: dict[str, Any] = field(default_factory=dict)

    def counts(self) -> Counter[str]:
        """Return how many cells have each status."""
        return Counter(cell.status for cell in self.cells)

    def write(self, out: Path) -> None:
        """Write tables as JSON, Markdown and a page, each complete or not at all.

        ``tables.json``, ``beyond.json``, ``tables.md`` and ``report.html``.
        """
        from nullmotion.report.paper import paper_report

        rows = [cell.as_row() for cell in self.cells]
        replace_text(out / "tables.json", json.dumps(rows, indent=1) + "\n")
        if self.beyond:
            text = json.dumps(self.beyond, indent=1, allow_nan=False)
            replace_text(out / "beyond.json", text + "\n")
        replace_text(out / "tables.md", self.markdown())
        paper_report(out / "report.html", self.title, self.citation, rows, self.runs)

    def markdown(self) -> str:
        """Return all tables as Markdown."""
        lines = [f"# {self.title}", "", _sentence(self.counts()), ""]
        for table in dict.fromkeys(cell.table for cell in self.cells):
            lines += [f"## Table {table}" if table[0].isdigit() else f"## {table.capitalize()}", ""]
            lines += [
                "| row | column | published | computed | tolerance | parameters | status | note |"
            ]
            lines += ["|---|---|---|---|---|---|---|---|"]
            for c in (c for c in self.cells if c.table == table):
                cells = (
                    c.row,
                    c.column,
                    _text(c.published),
                    _text(c.computed),
                    _text(c.tolerance or None),
                )
                lines.append("| " + " | ".join([*cells, c.parameters, c.status, c.note]) + " |")
            lines.append("")
        return "\n".join(lines + _beyond(self.beyond, self.note))


def _beyond(rows: list[dict[str, Any]], note: str) -> list[str]:
    if not rows:
        return []
    keys = [key for key, value in rows[0].items() if not isinstance(value, dict)]
    lines = ["## Beyond the paper", "", note, ""]
    lines += ["| " + " | ".join(keys) + " |", "|---" * len(keys) + "|"]
    lines += ["| " + " | ".join(_text(row[key]) for key in keys) + " |" for row in rows]
    return [*lines, ""]


def _sentence(counts: Counter[str]) -> str:
    parts = [f"{counts[s]} {s}" for s in ("reproduced", "matched", "differs") if counts[s]]
    printed = sum(counts.values()) - counts["not printed"]
    return f"{printed} printed values: {', '.join(parts)}."


def _text(value: Value | bool | list[Any]) -> str:
    if value is None:
        return ""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, list):
        return ", ".join(map(_text, value))
    return value if isinstance(value, str) else f"{value:.5g}"


def replace_text(path: Path, text: str) -> None:
    """Write a file under a temporary name and rename it."""
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(f".{path.name}.{os.getpid()}.tmp")
    temporary.write_text(text, encoding="utf-8")
    temporary.replace(path)


@dataclass(frozen=True)
class Paper:
    """Base of reproductions: one file under ``papers/`` with one frozen dataclass.

    Class attributes:
        name: Name on the command line.
        title: The paper's title.
        citation: Where it appeared.
    """

    name: ClassVar[str] = ""
    title: ClassVar[str] = ""
    citation: ClassVar[str] = ""

    def cells(self, progress: Progress | None = None) -> list[Cell]:
        """Return every printed value with ours."""
        raise NotImplementedError

    def run(self, out: Path, progress: Progress | None = None, figures: bool = True) -> PaperResult:
        """Compute the tables and figures and write them to a folder."""
        raise NotImplementedError
