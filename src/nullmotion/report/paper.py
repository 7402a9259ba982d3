"""The page of a paper that was computed again: printed values beside ours, and its runs."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from nullmotion.plot.atlas_runs import case_scene
from nullmotion.plot.view import Run
from nullmotion.report import page
from nullmotion.report.atlas import Atlas
from nullmotion.report.charts import Charts
from nullmotion.report.markup import Markup, join, tag
from nullmotion.report.tables import table
from nullmotion.report.wording import number

_HEAD = ("Row", "Column", "Published", "Computed", "Tolerance", "Parameters", "Status", "Note")
_GOOD = ("reproduced", "matched")
_STATUS = (*_GOOD, "differs", "not printed")


def paper_report(
    path: str | Path,
    title: str,
    citation: str,
    rows: Sequence[Mapping[str, Any]],
    runs: Mapping[str, Run] | None = None,
) -> Path:
    """Write a paper's tables, and its runs in momentum space, as an HTML page without a network.

    Args:
        path: File to write.
        title: The paper's title.
        citation: Where it appeared.
        rows: Its values as rows of ``tables.json``.
        runs: Its runs by name; all on one array.

    Returns:
        The path.
    """
    cases = [SimpleNamespace(label=name, trajectory=run) for name, run in (runs or {}).items()]
    atlas = Atlas(case_scene(cases), begin_at_end=True)
    parts = [atlas.section("Runs in momentum space")]
    for name in dict.fromkeys(str(row["table"]) for row in rows):
        parts.append(_section(name, [row for row in rows if str(row["table"]) == name]))
    head = join(_headline(title, citation, rows), page.links(parts))
    made = page.versions(*(runs or {}).values())
    return page.write(path, page.document(title, [head, *parts], Charts(), made, *atlas.extras()))


def _headline(title: str, citation: str, rows: Sequence[Mapping[str, Any]]) -> Markup:
    counts = Counter(row["status"] for row in rows)
    printed = len(rows) - counts["not printed"]
    told = ", ".join(f"{counts[s]} {s}" for s in _STATUS[:3] if counts[s])
    return tag(
        "header",
        tag("p", title, class_="title"),
        tag("h1", f"{printed} printed values: {told}"),
        tag("p", citation, class_="subject") if citation else "",
    )


def _section(name: str, rows: Sequence[Mapping[str, Any]]) -> Markup:
    title = f"Table {name}" if name[:1].isdigit() else name.capitalize()
    made = table(_HEAD, [_cells(row) for row in rows], title, numeric=(2, 3, 4), wide=True)
    good = sum(row["status"] in _GOOD for row in rows)
    printed = sum(row["status"] != "not printed" for row in rows)
    summary = f"{good} of {printed} as printed" if printed else f"{len(rows)} not printed"
    key = "".join(c if c.isalnum() else "-" for c in name)
    return page.section(title, page.details(summary, made), id=f"table-{key}")


def _cells(row: Mapping[str, Any]) -> tuple[object, ...]:
    status = row["status"]
    tone = "passed" if status in _GOOD else "failed" if status == "differs" else None
    published, computed = (_value(row[key]) for key in ("published", "computed"))
    tolerance = _value(row["tolerance"] or None)
    note = join(row["note"])
    shown = tag("span", status, class_=tone)
    return row["row"], row["column"], published, computed, tolerance, row["parameters"], shown, note


def _value(value: Any) -> str:
    return value if isinstance(value, str) else number(value, 5)
