"""``nullmotion paper``: a paper's tables and figures again."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from nullmotion.cli import options, screen

if TYPE_CHECKING:
    from nullmotion.papers import Cell, PaperResult


def paper(
    name: Annotated[
        str, typer.Argument(metavar="NAME", help="A name from `nullmotion list papers`.")
    ],
    out: options.Out = None,
    figures: Annotated[bool, typer.Option(help="Draw the figures too.")] = True,
) -> None:
    """Compute a paper's tables and figures again."""
    from nullmotion.papers import registry

    entry = registry.get(name)
    target = options.writable(out or Path("out") / name)
    with screen.progress(f"Computing {name}") as progress:
        result = entry().run(target, progress, figures=figures)
    show(result)
    more = ", beyond.json" if result.beyond else ""
    typer.echo(f"Results in {target} (report.html, tables.json, tables.md{more})")


def show(result: PaperResult) -> None:
    """Print how many printed values come back, and those that do not."""
    found = result.counts()
    printed = len(result.cells) - found.pop("not printed", 0)
    counts = ", ".join(f"{count} {status}" for status, count in sorted(found.items()))
    typer.echo(f"{result.title}\n{printed} printed values: {counts}")
    rows = [_row(cell) for cell in result.cells if cell.status == "differs"]
    if rows:
        head = ("Table", "Row", "Column", "Published", "Computed", "Note")
        screen.console().print(screen.table("What differs", head, rows, numeric=(3, 4)))


def _row(cell: Cell) -> tuple[str, ...]:
    return (
        cell.table,
        cell.row,
        cell.column,
        _text(cell.published),
        _text(cell.computed),
        cell.note,
    )


def _text(value: Any) -> str:
    return value if isinstance(value, str) else screen.number(value)
