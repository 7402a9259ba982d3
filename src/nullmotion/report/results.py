"""The table of a comparison: cases x metrics."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Literal, NamedTuple

from nullmotion.plot.events import stuck
from nullmotion.plot.quantities import of_attitude, turns_wheels
from nullmotion.plot.view import Case
from nullmotion.report.markup import Markup, join, tag
from nullmotion.report.ranking import (
    ATTITUDE_COLUMNS,
    COLUMNS,
    WHEEL_COLUMNS,
    Column,
    best,
    cell,
)
from nullmotion.report.requirements import of_case, tally
from nullmotion.report.tables import table
from nullmotion.report.verdict import status_words, verdict
from nullmotion.report.wording import plain

MOST_ROWS = 500  # of a varied comparison in its page
KINDS = {
    "defaults": "defaults",
    "published": "as published",
    "given": "given",
    "published, given": "as published, some given",
}
MARKING = (
    "★ and a frame mark the best value of a column among the cases that did their job "
    "(not stuck, no failure). Torque figures are shares of the command; sigma_min is for A "
    "divided by the mean momentum of the working CMGs."
)

MARKING_ATTITUDE = (
    "★ and a frame mark the best value of a column among the cases that settled. sigma_min is for "
    "A divided by the mean momentum of the working CMGs."
)
STUCK = " A stuck CMG does not count."
_BASIS = ("Parameters", "Information used", "Status")


class Outcome(NamedTuple):
    """How a case went: a `verdict`, or why it could not run."""

    words: str
    tone: Literal["done", "stopped", "trouble", "refused"]


def outcome(case: Any) -> Outcome:
    """Return how a case went."""
    if case.trajectory is None:
        return Outcome(f"Could not run: {case.reason}", "refused")
    return Outcome(*verdict(case.trajectory))


def result_table(cases: Sequence[Case]) -> Markup:
    """Return the table with its best values marked."""
    outcomes = [outcome(case) for case in cases]
    eligible = [o.tone in ("done", "stopped") for o in outcomes]
    columns = []
    for column in _columns(cases):
        values = [case.metrics.get(column.key) for case in cases]
        won = best(column, values, eligible)
        columns.append([cell(column.written(v), w) for v, w in zip(values, won, strict=True)])
    if _required(cases):
        columns.append([_passed(case) for case in cases])
    rows = [
        (_name(case), _result(said), *numbers, *_basis(case))
        for case, said, *numbers in zip(cases, outcomes, *columns, strict=True)
    ]
    head = ("Case", "Result", *_heads(cases), *_BASIS)
    numeric = range(2, 2 + len(columns))
    made = table(head, rows, "Cases and their results", numeric=numeric, wide=True)
    words = MARKING_ATTITUDE if attitudes(cases) else MARKING
    if any(stuck(case.trajectory) for case in cases if case.trajectory is not None):
        words += STUCK
    return join(made, tag("p", words, class_="note"))


def varied_table(cases: Sequence[Any], key: str) -> Markup:
    """Return the table of a comparison over the values of a key, nothing marked."""
    shown = cases[:MOST_ROWS]
    required = _required(cases)
    rows = []
    for case in shown:
        numbers = [column.written(case.metrics.get(column.key)) for column in _columns(cases)]
        numbers += [_passed(case)] if required else []
        said = _result(outcome(case))
        rows.append((_name(case), said, str(case.value), *numbers, *_basis(case)))
    head = ("Case", "Result", key, *_heads(cases), *_BASIS)
    numeric = range(2, len(head) - len(_BASIS))
    made = table(head, rows, "Cases at each value", numeric=numeric, wide=True)
    left = len(cases) - len(shown)
    return join(
        made, tag("p", f"{left} more cases are not shown here.", class_="note") if left else ""
    )


def attitudes(cases: Sequence[Any]) -> bool:
    """Return whether a comparison turns a spacecraft."""
    return any(of_attitude(case.trajectory) for case in cases)


def _columns(cases: Sequence[Any]) -> tuple[Column, ...]:
    if attitudes(cases) and any(turns_wheels(case.trajectory) for case in cases):
        return WHEEL_COLUMNS
    return ATTITUDE_COLUMNS if attitudes(cases) else COLUMNS


def _heads(cases: Sequence[Any]) -> list[str]:
    titles = [column.title for column in _columns(cases)]
    return [*titles, "Requirements passed"] if _required(cases) else titles


def _required(cases: Sequence[Any]) -> bool:
    return any(of_case(case) for case in cases)


def _passed(case: Any) -> str:
    results = of_case(case)
    return tally(results) if results else "–"


def _basis(case: Any) -> tuple[str, str, str]:
    return _kind(case), _information(case), _status(case)


def _name(case: Any) -> Markup:
    same = case.label.lower() == case.law.lower()
    return join(case.label, "" if same else tag("small", case.law, class_="more"))


def _result(said: Outcome) -> Markup | str:
    if said.tone in ("trouble", "refused"):
        return tag("span", said.words, class_="trouble")
    return said.words


def _kind(case: Any) -> str:
    return KINDS.get(case.parameters_kind, plain(str(case.parameters_kind)))


def _information(case: Any) -> str:
    return ", ".join(case.information) or "angles and command only"


def _status(case: Any) -> str:
    if case.trajectory is None:
        return "–"
    return ", ".join(status_words(case.trajectory)) or "ok"
