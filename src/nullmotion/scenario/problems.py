"""What is wrong with a scenario, told so that it can be put right."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from nullmotion.errors import InputError
from nullmotion.scenario.toml import value_text

MISSING = object()
_LONGEST = 120


@dataclass(frozen=True)
class Problem:
    """One thing that is wrong.

    Attributes:
        key: Dotted key as in the file.
        value: What stands there; `MISSING` when nothing does.
        allowed: What would have been accepted.
        where: ``file:line``.
    """

    key: str
    value: Any
    allowed: str
    where: str = ""

    def __str__(self) -> str:
        """Return the problem on one line."""
        place = f"{self.where}: " if self.where else ""
        if self.value is MISSING:
            return f"{place}{self.key}: {self.allowed}"
        return f"{place}{self.key} = {shortened(self.value)}: {self.allowed}"


def shortened(value: Any) -> str:
    """Return a value as in a TOML file, its middle left out if it is long."""
    text = value_text(value)
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - 20]} ... {text[-15:]}"


class ScenarioError(InputError):
    """A scenario that cannot be used, with everything that is wrong with it.

    Args:
        problems: At least one.
    """

    def __init__(self, problems: Sequence[Problem]) -> None:
        """Keep the problems; the first one gives key, value, allowed and where."""
        first = problems[0]
        super().__init__(
            first.key, None if first.value is MISSING else first.value, first.allowed, first.where
        )
        self.problems = tuple(problems)
        self.args = ("\n".join(str(p) for p in problems),)
