"""Enclosures of recorded source over boxes, rounding included.

Source y = f(x) is recorded once (`steps`) and replayed with intervals (`interval_replay`), in a
kernel or in NumPy: the same operations, so that both find the same bounds, bit for bit, where
no elementary function is used.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from nullmotion.compile.function import CompiledFunction, compile_function
from nullmotion.compile.interval import Interval
from nullmotion.compile.interval_replay import Enclosure, Replay
from nullmotion.compile.steps import Steps, record

_CHUNK = 2048  # boxes at a time in NumPy: what is known of them stays in the cache


class Enclosing:
    """Recorded source as a function of boxes.

    Attributes:
        steps: The source.
    """

    def __init__(self, steps: Steps, derivatives: bool = True, compiled: bool = True) -> None:
        """Prepare what was recorded; see `enclosing`."""
        self.steps = steps
        self._kernel: CompiledFunction | None = None
        replay = Replay(steps).with_slopes if derivatives else Replay(steps).plain

        def source(boxes: Any) -> Enclosure:
            return replay([Interval(*ends) for ends in zip(*boxes, strict=True)])

        self._source = source
        if compiled:
            self._kernel = compile_function(source, np.zeros((2, len(steps.inputs))))

    @property
    def compiled(self) -> bool:
        """Whether it runs in a kernel; in NumPy otherwise."""
        return self._kernel is not None

    def __call__(self, boxes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return least and greatest values (B, k) over boxes (B, 2, size)."""
        found = self.enclosure(boxes)
        return found.lower, found.upper

    def enclosure(self, boxes: np.ndarray) -> Enclosure:
        """Return all that is known over boxes (B, 2, size): their lower and upper corners."""
        boxes = np.asarray(boxes, float)
        if self._kernel and len(boxes):
            return Enclosure(*self._kernel(boxes))
        parts = [self._chunk(boxes[i : i + _CHUNK]) for i in range(0, max(len(boxes), 1), _CHUNK)]
        return Enclosure(*(np.concatenate(field) for field in zip(*parts, strict=True)))

    def _chunk(self, boxes: np.ndarray) -> Enclosure:
        with np.errstate(all="ignore"):  # where a value may be undefined
            found = self._source(np.moveaxis(boxes, 0, -1))
        fields = []
        for field in found:
            flat = [np.broadcast_to(v, len(boxes)) for v in field.ravel()]
            fields.append(np.stack(flat, axis=-1).reshape(len(boxes), *field.shape))
        return Enclosure(*fields)


def enclosing(
    function: Callable[[Any], Any], size: int, *, derivatives: bool = True, compiled: bool = True
) -> Enclosing:
    """Return source f(x) as a function of boxes that returns bounds of f on them.

    The bounds hold in exact arithmetic, constants being the doubles that they are; they are
    -inf and inf where f may be undefined somewhere in the box.

    Args:
        function: Source without data-dependent branches; takes an array (size,), returns
            numbers.
        size: Number of components of x.
        derivatives: Use slopes as well as plain interval arithmetic.
        compiled: Make a kernel, which takes seconds and is then tens of times as fast as NumPy.

    Raises:
        TraceError: When the source decides by a value, or uses what is no real function.
    """
    return Enclosing(record(function, size), derivatives, compiled)
