"""Recorded source replayed with intervals.

For every box X with the centre c each number y of the source has a range R, a value C at c and
slopes S (see `interval_slopes`):

    y(X) in R,    y(X) in C + S (X - c)

R is cut down to both at every step of which more than a sum is made, so that what follows
starts from less.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from nullmotion.compile.interval import Interval, Truth, Value, above, greater, lesser, point
from nullmotion.compile.interval_ball import ONE, ZERO
from nullmotion.compile.interval_rules import RANGES
from nullmotion.compile.interval_slopes import SLOPES, Held
from nullmotion.compile.steps import Step, Steps, dependent, pivotal, released
from nullmotion.compile.tape import product


class Enclosure(NamedTuple):
    """What is known of y = f(x), (B, k), over B boxes.

    Attributes:
        lower: No value in the box is less.
        upper: No value in the box is greater.
        at_least: The value at the centre is not less.
        at_most: The value at the centre is not greater.
        slope: Middle of the slopes from the centre along each axis, (B, k, size).
        spread: Their distance from it; y(x) is in [at_least, at_most] + (slope +- spread) (x - c).
    """

    lower: Value
    upper: Value
    at_least: Value
    at_most: Value
    slope: Value
    spread: Value


class Replay:
    """Steps, to be run with intervals of floats, arrays or symbols."""

    def __init__(self, steps: Steps) -> None:
        self._steps = steps
        self._depends, self._released = dependent(steps), released(steps)
        self._pivotal = pivotal(steps)

    def plain(self, x: Sequence[Interval]) -> Enclosure:
        """Return natural ranges; what is known at the centre is no more."""
        known: dict[int, Any] = {}

        def take(i: int, step: Step, operands: Sequence[Any]) -> Any:
            return RANGES[step.name](*operands)

        for i, v in zip(self._steps.inputs, x, strict=True):
            known[i] = v
        found = self._run(known, take, lambda v: v)
        ends = [[v.lo for v in found], [v.hi for v in found]] * 2
        slopes = [[[end] * len(x)] * len(found) for end in (0.0, np.inf)]
        return Enclosure(*(_array(v) for v in (*ends, *slopes)))

    def with_slopes(self, x: Sequence[Interval]) -> Enclosure:
        """Return ranges cut down by centres and slopes."""
        middles = [product(v.lo, 0.5) + product(v.hi, 0.5) for v in x]
        centres = [greater(lesser(c, v.hi), v.lo) for v, c in zip(x, middles, strict=True)]
        radii = [above(greater(v.hi - c, c - v.lo)) for v, c in zip(x, centres, strict=True)]
        none = [None] * len(x)
        known: dict[int, Any] = {}
        for j, i in enumerate(self._steps.inputs):
            known[i] = Held(point(centres[j]), x[j], [*none[:j], ONE, *none[j + 1 :]])

        def take(i: int, step: Step, operands: Sequence[Any]) -> Any:
            return self._held(i, step, operands, radii)

        found: list[Held] = self._run(known, take, lambda v: Held(v, v, none))
        ends = [[v.range.lo for v in found], [v.range.hi for v in found]]
        centre = [[v.centre.lo for v in found], [v.centre.hi for v in found]]
        balls = [[ZERO if s is None else s for s in v.slopes] for v in found]
        slopes = [[[s.mid for s in row] for row in balls], [[s.rad for s in row] for row in balls]]
        return Enclosure(*(_array(v) for v in (*ends, *centre, *slopes)))

    def _run(
        self,
        known: dict[int, Any],
        take: Callable[[int, Step, Sequence[Any]], Any],
        constant: Callable[[Interval], Any],
    ) -> list[Any]:
        """Return the outputs, from what is known of the inputs."""
        for i, step in self._steps:
            if step.name == "constant" and isinstance(step.value, bool):
                known[i] = Truth(step.value, not step.value, True)
            elif step.name == "constant":
                known[i] = constant(point(step.value))
            elif step.name != "input":
                known[i] = take(i, step, [known[a] for a in step.args])
            for a in self._released[i]:
                del known[a]
        return [known[i] for i in self._steps.outputs]

    def _held(self, i: int, step: Step, operands: Sequence[Any], radii: Sequence[Value]) -> Any:
        """Return what is known of a step's result from what is known of its operands."""
        rule = RANGES[step.name]
        whole = rule(*(v.range if isinstance(v, Held) else v for v in operands))
        if isinstance(whole, Truth):
            return whole
        # a truth is that of the whole box: the centre takes the choice that holds everywhere
        centre = rule(*(v.centre if isinstance(v, Held) else v for v in operands))
        slope = SLOPES[step.name](Held(centre, whole, []), *operands)
        slopes: list[Any] = [None] * len(radii)
        for j in np.flatnonzero(self._depends[i]).tolist():
            slopes[j] = slope(*(v.slopes[j] if isinstance(v, Held) else None for v in operands))
        held = Held(centre, whole, slopes)
        cut = i in self._pivotal and self._depends[i].any()
        return Held(centre, held.within(radii), slopes) if cut else held


def _array(values: Sequence[Any]) -> np.ndarray:
    """Return numbers, arrays or symbols as the elements of an object array."""
    rows = [v if isinstance(v, list) else [v] for v in values]
    out = np.empty((len(rows), len(rows[0])), dtype=object)
    for i, row in enumerate(rows):
        for j, v in enumerate(row):
            out[i, j] = v
    return out if isinstance(values[0], list) else out[:, 0]
