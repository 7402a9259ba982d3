"""The command ``nullmotion``. Nothing heavy is imported before a command runs."""

from __future__ import annotations

import sys
from typing import Annotated

import typer

from nullmotion.cli import (
    analyze,
    catalogue,
    compare,
    demo,
    design,
    guarantee,
    paper,
    plan,
    rerun,
    rover,
    run,
    size,
)

app = typer.Typer(
    name="nullmotion",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
    context_settings={"help_option_names": ["-h", "--help"]},
)


def _version(asked: bool) -> None:
    if asked:
        from nullmotion import __version__

        typer.echo(f"nullmotion {__version__}")
        raise typer.Exit


@app.callback()
def _options(
    version: Annotated[
        bool,
        typer.Option(
            "--version", callback=_version, is_eager=True, help="Show the version and exit."
        ),
    ] = False,
    debug: Annotated[bool, typer.Option("--debug", help="Show the traceback of an error.")] = False,
) -> None:
    """Momentum control with control moment gyroscopes: steer an array, compare steering laws.

    Start with `nullmotion demo`, then `nullmotion list scenarios`.
    """


app.command("demo")(demo.demo)
app.command("run")(run.run)
app.command("rerun")(rerun.rerun)
app.command("compare")(compare.compare)
app.command("plan")(plan.plan)
app.command("analyze")(analyze.analyze)
app.command("guarantee")(guarantee.guarantee)
app.add_typer(design.app, name="design")
app.command("size")(size.size)
app.add_typer(rover.app, name="rover")
app.command("list")(catalogue.list_)
app.command("paper")(paper.paper)


def main() -> None:
    """Run the command line and leave with its exit status."""
    from nullmotion.cli import guard

    sys.exit(guard.call(app, sys.argv[1:]))
