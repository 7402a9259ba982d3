"""Sizing: from what a spacecraft has to do to the CMG array that does it.

`size` takes a requirement (inertia, slew, settling, disturbance, failure, margins) and
returns, for each layout, the smallest array that meets it when flown through the closed loop,
and where a constraint function exists the array that is proven to.
"""

from __future__ import annotations

from nullmotion.sizing.load import library_names, load_requirement
from nullmotion.sizing.requirement import Requirement
from nullmotion.sizing.result import Certified, Row, Sizing
from nullmotion.sizing.size import size

__all__ = [
    "Certified",
    "Requirement",
    "Row",
    "Sizing",
    "library_names",
    "load_requirement",
    "size",
]
