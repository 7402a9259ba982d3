"""``nullmotion list``: what there is."""

from __future__ import annotations

import json
from typing import Annotated, Any

import typer

from nullmotion.cli import screen

KINDS = (
    "laws",
    "layouts",
    "constraints",
    "controllers",
    "metrics",
    "costs",
    "papers",
    "scenarios",
    "rovers",
)


def list_(
    kind: Annotated[str, typer.Argument(metavar="|".join(KINDS))],
    as_json: Annotated[bool, typer.Option("--json", help="As JSON.")] = False,
) -> None:
    """List laws, layouts, constraints, controllers, metrics, costs, papers, scenarios or rovers."""
    from nullmotion.errors import UnknownNameError

    if kind not in KINDS:
        raise UnknownNameError("list", kind, KINDS)
    from nullmotion.cli import records

    entries: list[dict[str, Any]] = getattr(records, kind)()
    if as_json:
        typer.echo(json.dumps(entries, indent=2))
        return
    columns = [key for key in (entries[0] if entries else {"name": ""}) if key not in records.LONG]
    rows = [[_cell(entry[key]) for key in columns] for entry in entries]
    heads = [key.replace("_", " ").capitalize() for key in columns]
    screen.console().print(screen.table(f"{len(entries)} {kind}", heads, rows))


def _cell(value: Any) -> str:
    return ", ".join(map(str, value)) if isinstance(value, list) else str(value)
