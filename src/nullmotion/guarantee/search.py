"""Branch and bound: which boxes of a region are decided, level by level."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any, Literal, NamedTuple

import numpy as np

from nullmotion.compile.enclosing import Enclosing
from nullmotion.compile.interval_replay import Enclosure
from nullmotion.compile.steps import record
from nullmotion.guarantee.region import Region, middle, reach_of

Reason = Literal["", "counterexample", "box limit", "time limit", "interrupted"]

_BATCH = 4096
_COMPILE_AFTER = 60_000  # boxes: NumPy has taken as long by then as the compiler will


class Counterexample(NamedTuple):
    """A point of the region where a component is above 0.

    Attributes:
        point: Where, (m,).
        component: Which.
        value: A number that the component is not less than there.
    """

    point: tuple[float, ...]
    component: int
    value: float


@dataclass
class Search:
    """One search, level by level."""

    function: Callable[[Any], Any]
    region: Region
    progress: Callable[[float], None]
    limit_boxes: int
    limit_seconds: float
    levels: list[str] = field(default_factory=list)
    leaves: int = 0
    looked_at: int = 0
    decided: float = 0.0
    counterexample: Counterexample | None = None

    def __post_init__(self) -> None:
        self.started = time.monotonic()
        self._enclosing = Enclosing(record(self.function, self.region.m), compiled=False)

    def run(self) -> Reason:
        """Search; return why it ended without a proof, or nothing."""
        boxes = self.region.root()[None]
        while len(boxes):
            codes, halves = [], [boxes[:0]]
            self.levels.append("")
            for batch in self._batches(boxes):
                if self.looked_at >= self.limit_boxes:
                    return "box limit"
                if time.monotonic() - self.started > self.limit_seconds:
                    return "time limit"
                code, parts = self._look(batch)
                if self.counterexample:
                    return "counterexample"
                codes.append(code)
                halves.append(parts)
            self.levels[-1] = "".join(codes)
            boxes = np.concatenate(halves)
        return ""

    def tree(self) -> str:
        """Return the levels, each from left to right, as one text in preorder."""
        below: list[str] = []
        for level in reversed(self.levels):
            subtrees = iter(below)
            below = [c if c in "po" else c + next(subtrees) + next(subtrees) for c in level]
        return below[0]

    def _batches(self, boxes: np.ndarray) -> Iterator[np.ndarray]:
        return (boxes[i : i + _BATCH] for i in range(0, len(boxes), _BATCH))

    def _look(self, boxes: np.ndarray) -> tuple[str, np.ndarray]:
        """Return one letter for each box, and the halves of those to be cut, in order."""
        codes = np.full(len(boxes), ord("o"), np.uint8)
        near = np.flatnonzero(~self.region.outside(boxes))
        cut = near[:0]
        if len(near):
            found = self._bounds(boxes[near])
            self._refute(boxes[near], found)
            open_ = np.flatnonzero(~(found.upper <= 0.0).all(axis=1))
            rest = Enclosure(*(field[open_] for field in found))
            bad = ~(self.region.greatest(boxes[near[open_]], rest) <= 0.0)
            kept = bad.any(axis=1)
            cut = near[open_[kept]]
            codes[near] = ord("p")
            codes[cut] = _axes(boxes[cut], Enclosure(*(f[kept] for f in rest)), bad[kept])
        self._count(len(boxes), len(boxes) - len(cut))
        return codes.tobytes().decode(), halved(boxes[cut], codes[cut] - ord("0"))

    def _bounds(self, boxes: np.ndarray) -> Enclosure:
        if self.looked_at > _COMPILE_AFTER and not self._enclosing.compiled:
            self._enclosing = Enclosing(self._enclosing.steps)
        return self._enclosing.enclosure(boxes)

    def _refute(self, boxes: np.ndarray, found: Enclosure) -> None:
        """Keep the middle of a box where a component is certainly above 0."""
        points = middle(boxes)
        above = np.where(self.region.holds(points)[:, None], found.at_least, -math.inf)
        box, component = np.unravel_index(np.argmax(above), above.shape)
        if above[box, component] > 0.0:
            point = tuple(points[box].tolist())
            self.counterexample = Counterexample(
                point, int(component), float(above[box, component])
            )

    def _count(self, boxes: int, leaves: int) -> None:
        self.looked_at += boxes
        self.leaves += leaves
        self.decided += leaves * 0.5 ** (len(self.levels) - 1)
        self.progress(self.decided)


def _axes(boxes: np.ndarray, found: Enclosure, bad: np.ndarray) -> np.ndarray:
    """Return the letter of the axis to cut: where the bad components move most; else the widest."""
    reach = reach_of(boxes)
    moves = (np.abs(found.slope) + found.spread) * reach[:, None]
    total = np.where(bad[:, :, None], moves, 0.0).sum(axis=1)
    known = np.isfinite(total).all(axis=1) & (total > 0.0).any(axis=1)
    axis = np.where(known[:, None], total, reach).argmax(axis=1)
    return (axis + ord("0")).astype(np.uint8)


def halved(boxes: np.ndarray, axes: np.ndarray) -> np.ndarray:
    """Return the halves of boxes (B, 2, m) along an axis each, lower before upper, (2B, 2, m)."""
    rows = np.arange(len(boxes))
    halves = np.repeat(boxes[:, None], 2, axis=1)
    halves[rows, 0, 1, axes] = halves[rows, 1, 0, axes] = middle(boxes)[rows, axes]
    return halves.reshape(-1, *boxes.shape[1:])
