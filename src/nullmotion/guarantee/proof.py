"""Proofs that a function stays at or below 0 over a whole region, by branch and bound.

The root box of the region is cut into halves until every part is either certainly outside the
region or has an enclosure of every component at or below 0 (`compile.enclosing`), rounding
included. What remains is a tree, written in preorder:

    '0', '1', '2'   cut at the middle of that axis; the lower half follows, then the upper
    'p'             proven: every component is at most 0 in the whole box
    'o'             outside: no point of the region in it

A tree can be checked by anyone who can bound the function: `guarantee.check` does it apart
from all that is used here.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from nullmotion.guarantee.region import Region
from nullmotion.guarantee.search import Counterexample, Reason, Search


@dataclass(frozen=True)
class Proof:
    """What came of an attempt to prove function(h) <= 0 for all h in a region.

    Attributes:
        proven: Whether it holds, with certainty.
        region: Where.
        boxes: Number of leaf boxes that were decided.
        tree: How the region was cut (see the module); empty if not proven.
        depth: Greatest number of cuts above a box.
        seconds: Time taken.
        counterexample: Where it does not hold, if that was found.
        reason: Why it is not proven.
        decided: Part of the root box's volume that was decided.
    """

    proven: bool
    region: Region
    boxes: int
    tree: str
    depth: int
    seconds: float
    counterexample: Counterexample | None = None
    reason: Reason = ""
    decided: float = 1.0


def prove(
    function: Callable[[Any], Any],
    region: Region,
    *,
    progress: Callable[[float], None] | None = None,
    limit_boxes: int = 5_000_000,
    limit_seconds: float = math.inf,
) -> Proof:
    """Prove that every component of function(h) is <= 0 for all h in the region.

    Args:
        function: Source without data-dependent branches (`nullmotion.ops`); takes h (m,) and
            returns numbers.
        region: Where it is to hold.
        progress: Told the part of the volume that is decided, after every batch.
        limit_boxes: Most boxes to look at.
        limit_seconds: Longest time to try.

    Returns:
        The proof; or why there is none: a counterexample, a limit, or a keyboard interrupt.

    Raises:
        TraceError: When the source decides by a value, or uses what is no real function.
    """
    search = Search(function, region, progress or (lambda _: None), limit_boxes, limit_seconds)
    try:
        reason = search.run()
    except KeyboardInterrupt:
        reason = "interrupted"
    seconds = time.monotonic() - search.started
    return Proof(
        proven=not reason,
        region=region,
        boxes=search.leaves,
        tree="" if reason else search.tree(),
        depth=len(search.levels) - 1,
        seconds=seconds,
        counterexample=search.counterexample,
        reason=reason,
        decided=search.decided,
    )
