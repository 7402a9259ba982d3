"""Compiled source over any number of lanes, in pieces that stay in the cache."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import Any

import numpy as np

from nullmotion.compile import CompiledFunction, compile_function

_LANES = 1024
Shape = tuple[int, ...]


@lru_cache(maxsize=64)
def _compiled(source: Callable[..., Any], shapes: tuple[Shape, ...]) -> CompiledFunction:
    return compile_function(source, *[np.zeros(s) if s else 0.0 for s in shapes])


class Lanes:
    """A function of constants, the same in all lanes, and of batches.

    It is compiled once for each set of shapes and may be fed its own results.
    """

    def __init__(
        self, source: Callable[..., Any], constants: tuple[np.ndarray, ...], shapes: tuple[Shape, ...]
    ) -> None:
        """Compile the source.

        Args:
            source: Plain source of the constants and then the batches.
            constants: What is the same in all lanes.
            shapes: Of the batches, without the batch axis.
        """
        every = tuple(np.shape(c) for c in constants) + shapes
        self._bound = _compiled(source, every).bound(_LANES)
        for buffer, value in zip(self._bound.arguments, constants, strict=False):
            buffer[...] = np.expand_dims(value, -1)
        self._batches = self._bound.arguments[len(constants) :]

    def __call__(self, *batches: np.ndarray, rounds: int = 1, back: int = 0) -> Any:
        """Return the results with the batch axis first: an array or a tuple of them.

        Args:
            *batches: Arrays with a leading batch axis.
            rounds: How often the function is applied.
            back: With how many of its results, the first ones, the first batches are replaced
                from one round to the next.
        """
        count = len(batches[0])
        results = self._bound.result
        several = isinstance(results, tuple)
        rows = results if several else (results,)
        found = [np.empty((count, *r.shape[:-1])) for r in rows]
        for first in range(0, count, _LANES):
            part = slice(first, min(first + _LANES, count))
            for buffer, batch in zip(self._batches, batches, strict=True):
                buffer[..., : part.stop - first] = np.moveaxis(batch[part], 0, -1)
            for k in range(rounds):
                self._bound()
                for r in range(back if k < rounds - 1 else 0):
                    self._batches[r][...] = rows[r]
            for value, row in zip(found, rows, strict=True):
                value[part] = np.moveaxis(row[..., : part.stop - first], -1, 0)
        return tuple(found) if several else found[0]
