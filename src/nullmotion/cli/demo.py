"""``nullmotion demo``: every law on the elliptic-singularity manoeuvre."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from nullmotion.cli import compare as comparing
from nullmotion.cli import comparison_table, options, screen

_SCENARIO = "elliptic-singularity"
_NEXT = f"""Next:
  nullmotion run {_SCENARIO} --set law.name=vcbsae     one law, its whole trajectory
  nullmotion compare {_SCENARIO} --vary array.skew_deg=45:60:5 --laws gsr,vcbsae
  nullmotion list laws                                 what each law claims, and its source"""


def demo(
    out: Annotated[
        Path, typer.Option("--out", metavar="DIR", help="Folder for the report.")
    ] = Path("nullmotion-demo"),
) -> None:
    """Fly all laws through an elliptic singularity."""
    scenario = options.load(_SCENARIO, {})
    options.writable(out)
    console = screen.console()
    console.print(scenario.about.description)
    comparison = comparing.fly(scenario, None)
    comparing.write(comparison, out, figure=False)
    for made in comparison_table.tables(comparison):
        console.print(made)
    typer.echo(f"Report: {out / 'report.html'} (open it in a browser)")
    typer.echo(_NEXT)
