"""Compiled source over any number of lanes, in pieces that stay in the cache."""

from __future__ import annotations

import threading
from collections.abc import Callable
from functools import lru_cache
from typing import Any

import numpy as np

from nullmotion.compile import CompiledFunction, compile_function
from nullmotion.compile.function import Bound

_LANES = (64, 1024)
Shape = tuple[int, ...]
Source = Callable[..., Any]


@lru_cache(maxsize=64)
def _compiled(source: Source, shapes: tuple[Shape, ...]) -> CompiledFunction:
    return compile_function(source, *[np.zeros(s) if s else 0.0 for s in shapes])


@lru_cache(maxsize=128)
def _bound(source: Source, shapes: tuple[Shape, ...], lanes: int, thread: int) -> Bound:
    """Return the function on buffers of this thread's own."""
    return _compiled(source, shapes).bound(lanes)


class Lanes:
    """A function of constants, the same in all lanes, and of batches.

    It is compiled once for each set of shapes and may be fed its own results.
    """

    def __init__(
        self, source: Source, constants: tuple[np.ndarray, ...], shapes: tuple[Shape, ...]
    ) -> None:
        """Compile the source.

        Args:
            source: Plain source of the constants and then the batches.
            constants: What is the same in all lanes.
            shapes: Of the batches, without the batch axis.
        """
        self._source, self._constants = source, constants
        self._shapes = tuple(np.shape(c) for c in constants) + shapes

    def __call__(self, *batches: np.ndarray, rounds: int = 1, back: int = 0) -> Any:
        """Return the results with the batch axis first: an array or a tuple of them.

        Args:
            *batches: Arrays with a leading batch axis.
            rounds: How often the function is applied.
            back: How many of its results, the first ones, take the place of the first batches
                from one round to the next.
        """
        count = len(batches[0])
        lanes = _LANES[count > _LANES[0]]
        bound = _bound(self._source, self._shapes, lanes, threading.get_ident())
        several = isinstance(bound.result, tuple)
        rows = bound.result if several else (bound.result,)
        for buffer, value in zip(bound.arguments, self._constants, strict=False):
            buffer[...] = value[..., None]
        buffers = bound.arguments[len(self._constants) :]
        found = [np.empty((count, *r.shape[:-1])) for r in rows]
        for first in range(0, count, lanes):
            part = slice(first, min(first + lanes, count))
            size = part.stop - first
            for buffer, batch in zip(buffers, batches, strict=True):
                buffer[..., :size] = np.moveaxis(batch[part], 0, -1)
            for k in range(rounds):
                for r in range(back if k else 0):
                    buffers[r][...] = rows[r]
                bound()
            for value, row in zip(found, rows, strict=True):
                value[part] = np.moveaxis(row[..., :size], -1, 0)
        return tuple(found) if several else found[0]
