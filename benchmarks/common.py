"""What every benchmark returns: a measured value beside its target."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass

LAWS = (
    "pseudo-inverse", "sr", "gsr", "odsr", "sda", "nd", "local-gradient", "dsea", "vcbsae",
    "follow-plan",
)  # fmt: skip


@dataclass(frozen=True)
class Row:
    """One measured value; the target may be a floor or a ceiling."""

    what: str
    value: float
    unit: str = ""
    at_least: float | None = None
    at_most: float | None = None
    note: str = ""

    @property
    def met(self) -> bool | None:
        """Whether the target is met; None without one."""
        if self.at_least is None and self.at_most is None:
            return None
        low = self.at_least is None or self.value >= self.at_least
        high = self.at_most is None or self.value <= self.at_most
        return low and high

    @property
    def target(self) -> str:
        """The target in words."""
        if self.at_least is not None:
            return f"at least {self.at_least:g}"
        return "" if self.at_most is None else f"at most {self.at_most:g}"

    def markdown(self) -> str:
        """Return a table row."""
        verdict = {True: "met", False: "MISSED", None: ""}[self.met]
        value = f"{self.value:.4g} {self.unit}"
        return f"| {self.what} | {value} | {self.target} | {verdict} | {self.note} |"


HEAD = "| what | measured | target | | note |\n|---|---|---|---|---|"


def median_time(
    function: Callable[[], object], rounds: int, clock: Callable[[], float] = time.perf_counter
) -> float:
    """Median seconds of a call."""
    times = []
    for _ in range(rounds):
        begin = clock()
        function()
        times.append(clock() - begin)
    return statistics.median(times)
