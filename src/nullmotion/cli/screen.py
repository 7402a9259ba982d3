"""What commands put on the screen: tables and a progress bar."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

NOT_SETTLED = "not settled"
_SILENT = 2.0  # seconds of work before a progress bar appears
_NOISE = 1e-9
_ROUNDING = 1e-12  # of the largest component
_WIDE = 140  # columns where the output is not a terminal


def console() -> Any:
    """Return a rich console on standard output."""
    from rich.console import Console

    return Console(highlight=False, width=None if sys.stdout.isatty() else _WIDE)


def table(
    title: str, columns: Sequence[str], rows: Sequence[Sequence[str]], numeric: Sequence[int] = ()
) -> Any:
    """Return a rich table; numeric columns stand to the right."""
    from rich import box
    from rich.table import Table
    from rich.text import Text

    made = Table(title=Text(title), title_justify="left", box=box.SIMPLE_HEAD, pad_edge=False)
    for i, name in enumerate(columns):
        longest = max(map(len, name.split()), default=0)  # no word of a head is cut
        side: Any = "right" if i in numeric else "left"
        made.add_column(Text(name), justify=side, overflow="fold", min_width=longest)
    for row in rows:
        made.add_row(*(Text(cell) for cell in row))
    return made


@contextmanager
def progress(what: str) -> Iterator[Callable[[float], None]]:
    """Give a function of the finished share that shows a bar once the work takes long."""
    start, bar = time.monotonic(), _Bar(what)

    def report(share: float) -> None:
        if sys.stderr.isatty() and time.monotonic() - start > _SILENT:
            bar.show(share)

    try:
        yield report
    finally:
        bar.close()


class _Bar:
    def __init__(self, what: str) -> None:
        self.what = what
        self.shown: Any = None

    def show(self, share: float) -> None:
        if self.shown is None:
            from rich.console import Console
            from rich.progress import Progress

            self.shown = Progress(console=Console(stderr=True), transient=True)
            self.task = self.shown.add_task(self.what, total=1.0)
            self.shown.start()
        self.shown.update(self.task, completed=share)

    def close(self) -> None:
        if self.shown is not None:
            self.shown.stop()


def number(value: Any) -> str:
    """Return a number with four digits; a dash where there is none."""
    if value is None or value != value:
        return "-"
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def settling(value: Any) -> str:
    """Return a settling time; in words that there is none."""
    return NOT_SETTLED if value is not None and value != value else number(value)


def vector(values: Sequence[float]) -> str:
    """Return numbers with four digits; what is rounding noise beside the largest is 0."""
    largest = max((abs(v) for v in values), default=0.0)
    return " ".join("0" if abs(v) < _ROUNDING * largest else f"{v:.4g}" for v in values)


def percent(value: Any) -> str:
    """Return a fraction in percent; rounding noise is 0."""
    if value is None or value != value:
        return "-"
    return "0" if abs(value) < _NOISE else f"{100 * value:.3g}"
