"""A named array of a run, with its unit."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

# field of the run, dimensions, unit, what it is
Row = tuple[str, tuple[str, ...], str, str]


class Variable(NamedTuple):
    """A named array."""

    name: str
    dims: tuple[str, ...]
    values: np.ndarray
    units: str
    long_name: str
