"""``nullmotion rerun``: a stored run again."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Annotated

import typer

from nullmotion.cli import options, run


def rerun(
    directory: Annotated[
        Path, typer.Argument(metavar="DIR", help="Folder that `nullmotion run` wrote.")
    ],
    out: Annotated[
        Path | None,
        typer.Option(
            "--out", metavar="DIR", help="Write the repeated run here; else only compare."
        ),
    ] = None,
) -> None:
    """Repeat a stored run and say whether it comes out the same."""
    from nullmotion.scenario import rerun as stored_runs

    stored = stored_runs.read(directory)
    if out is not None:
        options.writable(out)
    if stored.law_file:
        _register(stored.law_file)
    scenario = stored.scenario()
    trajectory = run.fly(scenario, stored.attributes.get("backend", "auto"))
    if out is not None:
        run.write(trajectory, scenario, out, False, stored.law_file)
    run.show(trajectory, scenario)
    typer.echo(f"Against {directory}: {stored_runs.verdict(stored, trajectory)}")
    if out is not None:
        typer.echo(f"Results in {out}")


def _register(text: str) -> None:
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "stored_law.py"
        file.write_text(text, encoding="utf-8")
        options.load_law_file(file)
