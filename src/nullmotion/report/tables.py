"""Tables that scroll inside their own box."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from nullmotion.report.markup import Markup, join, tag
from nullmotion.report.wording import Meaning, meaning, quantity


def table(
    head: Sequence[object],
    rows: Sequence[Sequence[object]],
    caption: str,
    numeric: Sequence[int] = (),
    wide: bool = False,
) -> Markup:
    """Return a table whose first column names the row.

    Args:
        head: Column titles.
        rows: Cells; a cell that is `Markup` stands as it is.
        caption: What the table says; read out, and the name of its box.
        numeric: Columns that hold numbers.
        wide: Whether the first column stays in view while the others scroll.
    """
    top = tag(
        "tr",
        join(
            *(tag("th", cell, scope="col", class_=_side(i, numeric)) for i, cell in enumerate(head))
        ),
    )
    body = join(*(_row(cells, numeric) for cells in rows))
    inner = tag("table", tag("caption", caption), tag("thead", top), tag("tbody", body))
    return tag(
        "div",
        inner,
        class_="scroll wide" if wide else "scroll",
        tabindex="0",
        role="region",
        aria_label=caption,
    )


def _row(cells: Sequence[object], numeric: Sequence[int]) -> Markup:
    first = tag("th", cells[0], scope="row")
    rest = (tag("td", cell, class_=_side(i, numeric)) for i, cell in enumerate(cells[1:], 1))
    return tag("tr", first, join(*rest))


def _side(column: int, numeric: Sequence[int]) -> str | None:
    return "number" if column in numeric else None


def metric_table(metrics: Mapping[str, Any]) -> Markup:
    """Return all metrics of a run with units and what they mean."""
    rows = []
    for key, value in metrics.items():
        said = meaning(key)
        written, unit = quantity(value, said.unit, key)
        rows.append((tag("code", key), written, unit or "–", _explained(said)))
    return table(
        ("Metric", "Value", "Unit", "Meaning"), rows, "All metrics of the run", numeric=(1,)
    )


def _explained(said: Meaning) -> Markup:
    more = [part for part in (said.definition, said.citation) if part]
    return join(
        said.words[:1].upper() + said.words[1:],
        ".",
        tag("small", " · ".join(more), class_="more") if more else "",
    )
