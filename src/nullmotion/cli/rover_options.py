"""What the commands of ``nullmotion rover`` share."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from nullmotion.cli import options

if TYPE_CHECKING:
    from nullmotion.rover.rover_run_store import Report

ORIGIN = "command line"
Settings = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="KEY=VALUE",
        help="Set a value over the file: site.gravity_m_s2=9.81. May be repeated.",
    ),
]


def values(settings: list[str] | None, flags: dict[str, Any]) -> dict[str, Any]:
    """Return values by dotted key: what options give, and --set over it."""
    given = {key: value for key, value in flags.items() if value is not None}
    return given | options.values(settings, None)


def tell(target: Path, page: Report | None) -> None:
    """Say where the results are."""
    typer.echo(f"Results in {target}{'' if page is None else ' (open report.html)'}")


@contextmanager
def explained() -> Iterator[None]:
    """End with one message where there is no step, or no planner."""
    from nullmotion.errors import InputError
    from nullmotion.rover.plan_error import PlanError

    try:
        yield
    except PlanError as error:
        typer.echo(f"error: {error}", err=True)
        raise typer.Exit(1) from error
    except InputError as error:
        if error.value != "casadi":
            raise
        what = "planning a step needs CasADi, which is not installed"
        typer.echo(f"error: {what}: pip install 'nullmotion[rover]'", err=True)
        raise typer.Exit(2) from error
