"""Tables over time in CSV files; torque profiles, with the header ``t_s,x,y,z``."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from nullmotion.scenario.source import Source

AXES = ("x", "y", "z")


class ProfileError(ValueError):
    """A profile that cannot be read; the message says what and in which line."""


@dataclass(frozen=True)
class Profile:
    """A command over time, linear between its rows and held beyond its ends.

    Attributes:
        t: Times [s], increasing, (k,).
        hdot: Commanded rate of momentum [N m], (k, m).
    """

    t: np.ndarray
    hdot: np.ndarray

    def at(self, times: np.ndarray) -> np.ndarray:
        """Return the command at given times, (len(times), m)."""
        return np.stack([np.interp(times, self.t, column) for column in self.hdot.T], axis=1)


def load(source: Source, name: str, m: int) -> Profile:
    """Return the profile in a file named by a scenario, with m torque dimensions.

    Raises:
        ProfileError: For a file that is missing or not such a table.
    """
    found, _ = table(source, name, [["t_s", *AXES[:m]]])
    return Profile(found[:, 0], found[:, 1:])


def table(
    source: Source, name: str, headers: Sequence[Sequence[str]]
) -> tuple[np.ndarray, list[int]]:
    """Return the numbers of a CSV file with one of the headers, and the line of each row.

    The first column is time and increases.

    Raises:
        ProfileError: For a file that is missing or not such a table.
    """
    try:
        text = source.read(name)
    except UnicodeDecodeError:
        raise ProfileError("a CSV file in UTF-8") from None
    except OSError:
        raise ProfileError(f"an existing CSV file (looked for beside {source.name})") from None
    rows = [
        (i, row)
        for i, row in enumerate(csv.reader(text.splitlines()), 1)
        if any(c.strip() for c in row)
    ]
    header = [c.strip() for c in rows[0][1]] if rows else []
    if header not in [list(h) for h in headers]:
        raise ProfileError(f"a CSV whose first line is {' or '.join(map(','.join, headers))}")
    lines = [line for line, _ in rows[1:]]
    if not lines:
        raise ProfileError(f"a CSV with at least one row below {','.join(header)}")
    found = np.array([_numbers(name, line, row, len(header)) for line, row in rows[1:]])
    _check_times(name, lines, found[:, 0])
    return found, lines


def _numbers(name: str, line: int, row: list[str], count: int) -> list[float]:
    try:
        numbers = [float(cell) for cell in row]
    except ValueError:
        numbers = []
    if len(numbers) != count or not np.isfinite(numbers).all():
        raise ProfileError(
            f"{count} finite numbers in every row ({name}:{line} is {','.join(row)!r})"
        )
    return numbers


def _check_times(name: str, lines: list[int], t: np.ndarray) -> None:
    late = np.flatnonzero(np.diff(t) <= 0)
    if len(late):
        i = int(late[0]) + 1
        raise ProfileError(
            f"times that increase ({name}:{lines[i]} has {t[i]:g} s after {t[i - 1]:g} s)"
        )
