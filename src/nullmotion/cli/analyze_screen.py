"""What `nullmotion analyze` puts on the screen."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nullmotion.cli import screen

if TYPE_CHECKING:
    from nullmotion.atlas.analysis import Analysis
    from nullmotion.report.atlas_numbers import Number

_HEAD = ("Quantity", "Lower bound", "Upper bound", "Unit", "Over mean h0", "What it is")


def show(found: Analysis, title: str) -> None:
    """Print the numbers of an analysis."""
    from nullmotion.report.atlas_rows import failure_rows, number_rows
    from nullmotion.report.atlas_state import state_rows

    console = screen.console()
    cells = [_cells(row) for row in number_rows(found)]
    console.print(screen.table(title, _HEAD, cells, numeric=(1, 2, 4)))
    if found.failures:
        head, rows = failure_rows(found)
        name = "One CMG failed, its momentum gone [N m s]"
        console.print(screen.table(name, head, rows, numeric=(1, 2, 3, 4)))
    if found.state is not None:
        console.print(screen.table("State looked at", ("", ""), state_rows(found.state)))


def _cells(row: Number) -> list[str]:
    from nullmotion.report.wording import number

    bounds = [number(value, 6) for value in (row.lower, row.upper)]
    share = None
    if row.lower is not None and row.upper is not None:
        share = 0.5 * (row.lower + row.upper) / row.scale
    return [row.name, *bounds, row.unit, number(share), row.note]
