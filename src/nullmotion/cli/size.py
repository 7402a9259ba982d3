"""``nullmotion size``: the arrays that meet a requirement."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from nullmotion.cli import options, screen

if TYPE_CHECKING:
    from nullmotion.sizing import Sizing

RESULT, FIGURE, PAGE = "size.json", "trade.png", "size.html"


def size(
    requirement: Annotated[
        str,
        typer.Argument(
            metavar="REQUIREMENT",
            help="TOML file, or one that comes along: agile-100kg, imager-1500kg.",
        ),
    ],
    out: options.Out = None,
) -> None:
    """Find the smallest array of each layout that meets a requirement, and fly it."""
    from nullmotion.sizing import load_requirement

    wanted = load_requirement(requirement)
    target = options.writable(out or Path("out") / f"{wanted.name}-size")
    with screen.progress(f"Sizing for {wanted.title}") as progress:
        from nullmotion.sizing import size as search

        found = search(wanted, progress)
    show(found)  # even if the folder cannot be written to after all
    write(found, target)
    flown = [f"{row.layout}.toml" for row in found.rows if row.status == "sized"]
    hint = f"; fly one with: nullmotion run {target / flown[0]}" if flown else ""
    typer.echo(f"Results in {target} (open {PAGE}){hint}")


def write(found: Sizing, target: Path) -> None:
    """Write everything that was found, all files or none."""
    from nullmotion.plot.trade import trade_figure
    from nullmotion.report.size import size_report
    from nullmotion.scenario.files import replacing
    from nullmotion.sizing.schema import layout_names

    stale = [f"{name}.{ending}" for name in layout_names() for ending in ("toml", "csv")]
    owned = (RESULT, FIGURE, PAGE, *stale) if (target / RESULT).is_file() else ()
    with replacing(target, owned) as new:
        (new / RESULT).write_text(found.to_json(), encoding="utf-8")
        trade_figure(found, new / FIGURE)
        size_report(found, new / PAGE)
        for files in found.files.values():
            for name, text in files.items():
                (new / name).write_text(text, encoding="utf-8")


def show(found: Sizing) -> None:
    """Print a row for each design and each certified array."""
    from nullmotion.report.size import HEAD, NUMERIC, cells

    made = screen.table(found.requirement.title, HEAD, cells(found.rows), NUMERIC)
    screen.console().print(made)
    for row in found.rows:
        if row.status == "cannot":
            typer.echo(f"{row.layout}: {row.reason}")
    if not found.complete:
        left = set(found.requirement.layouts) - {row.layout for row in found.rows}
        typer.echo(f"Interrupted; not sized: {', '.join(sorted(left))}")
    typer.echo(f"{sum(row.flights for row in found.rows):,} flights in {found.seconds:.1f} s")
