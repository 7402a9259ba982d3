"""The numbers of an analysis: a table to read, and to take away."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from nullmotion.report import page
from nullmotion.report.markup import Markup, join, tag
from nullmotion.report.tables import table
from nullmotion.report.wording import number

_HEAD = ("Quantity", "Lower bound", "Upper bound", "Unit", "Over mean h0", "What it is")
TABLE = "atlas-table"
_DIGITS = 6


class Number(NamedTuple):
    """A number of an analysis, with its bounds.

    Attributes:
        name: What it is called.
        lower: Lower bound; None where there is none.
        upper: Upper bound; the lower one if it is exact.
        unit: Its unit.
        scale: What it is divided by to be told in units of one CMG's momentum.
        note: What it means.
    """

    name: str
    lower: float | None
    upper: float | None
    unit: str
    scale: float
    note: str

    def cells(self) -> tuple[object, ...]:
        """Return the cells of its row; numbers keep all their digits for whoever copies them."""
        middle = None if self.lower is None or self.upper is None else self.lower + self.upper
        share = None if middle is None else 0.5 * middle / self.scale
        low, high = _exact(self.lower, _DIGITS), _exact(self.upper, _DIGITS)
        return self.name, low, high, self.unit, _exact(share, 4), self.note


def _exact(value: float | None, digits: int) -> Markup:
    return tag(
        "span", number(value, digits), data_value="" if value is None else repr(float(value))
    )


def number_table(rows: Sequence[Number], caption: str) -> Markup:
    """Return the table and the button that copies it."""
    said = f"{TABLE}-copied"
    button = tag("button", "Copy table", type="button", data_copy=TABLE)
    bar = tag("div", button, tag("span", "", id=said, role="status", class_="note"), class_="copy")
    made = table(_HEAD, [row.cells() for row in rows], caption, numeric=(1, 2, 4), wide=True)
    return join(tag("div", made, id=TABLE, class_="numbers"), bar)


def extras() -> tuple[str, str]:
    """Return style sheet and script of tables that can be copied, for `page.document`."""
    return page.asset("numbers.css"), f'<script>"use strict";\n{page.asset("copy.js")}</script>'
