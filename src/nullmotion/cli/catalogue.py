"""``nullmotion list``: what there is."""

from __future__ import annotations

import json
from enum import StrEnum
from typing import Annotated, Any

import typer

from nullmotion.cli import screen


class Kind(StrEnum):
    """What can be listed."""

    LAWS = "laws"
    LAYOUTS = "layouts"
    METRICS = "metrics"
    PAPERS = "papers"
    SCENARIOS = "scenarios"


def list_(
    kind: Annotated[Kind, typer.Argument(metavar="laws|layouts|metrics|papers|scenarios")],
    as_json: Annotated[bool, typer.Option("--json", help="As JSON.")] = False,
) -> None:
    """List the laws, layouts, metrics, papers or scenarios."""
    from nullmotion.cli import records

    entries: list[dict[str, Any]] = getattr(records, kind.value)()
    if as_json:
        typer.echo(json.dumps(entries, indent=2))
        return
    columns = [key for key in (entries[0] if entries else {"name": ""}) if key not in records.LONG]
    rows = [[_cell(entry[key]) for key in columns] for entry in entries]
    heads = [key.replace("_", " ").capitalize() for key in columns]
    screen.console().print(screen.table(f"{len(entries)} {kind.value}", heads, rows))


def _cell(value: Any) -> str:
    return ", ".join(map(str, value)) if isinstance(value, list) else str(value)
