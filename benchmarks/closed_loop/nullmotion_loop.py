"""PLACE TO FILL: the closed loop through nullmotion's own compiled kernel.

The runner calls ``build(law, lanes)`` once per law ("sr", "sr+gradient", "svd"; see workload.py
for the model and its constants) and times what it returns. ``lanes`` is a hint, 0 for the CPU's
own width. As long as ``build`` raises NotImplementedError its row reads 'not built'.
"""

from __future__ import annotations

from collections.abc import Callable

from workload import Array, Batch

Loop = Callable[[Array, Array, Array, int], Batch]


def build(law: str, lanes: int = 0) -> Loop:
    """The kernel of ``law``: (q 4 x n, omega 3 x n, delta 4 x n, steps) -> final states."""
    raise NotImplementedError("nullmotion_loop.build is to be filled")
