"""The checker of proofs: walks a tree, box by box, in ball arithmetic.

It shares nothing with `guarantee.proof` but the recorded source and the meaning of the tree's
letters: boxes are rebuilt in plain Python, and a claim is what python-flint's `arb` bounds say
(`guarantee.arb_bounds`). A box whose bounds are too wide may be halved further before it is
given up: the claim is about the box, not about how it is shown.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from nullmotion.compile.steps import record
from nullmotion.guarantee.region import Ball, Region

Corners = tuple[tuple[float, ...], tuple[float, ...]]  # of a box: lower and upper

_MORE_CUTS = 9  # halvings of a leaf before it is refused: three along each axis


@dataclass(frozen=True)
class Check:
    """What the checker found.

    Attributes:
        ok: Whether the tree proves function(h) <= 0 over the region.
        boxes: Number of leaves that hold, up to the first that does not.
        failed: Lower and upper corner of the first box that does not hold.
        reason: What is wrong.
    """

    ok: bool
    boxes: int
    failed: Corners | None = None
    reason: str = ""


def check(
    function: Callable[[Any], Any],
    region: Region,
    tree: str,
    *,
    progress: Callable[[float], None] | None = None,
) -> Check:
    """Check a proof's tree.

    Args:
        function: Source whose components are claimed to be <= 0.
        region: Where.
        tree: How the region is cut (`guarantee.proof`).
        progress: Told the part of the tree that was read, now and then.

    Raises:
        TraceError: When the source decides by a value, or uses what is no real function.
    """
    from flint import ctx

    from nullmotion.guarantee.arb_bounds import PRECISION, bounding
    from nullmotion.guarantee.arb_rules import in_ball

    with ctx.workprec(PRECISION):
        bounded = bounding(record(function, region.m))
        part = in_ball(region.radius) if isinstance(region, Ball) else lambda *_: False
        return _walk(lambda box: bounded(*box, part), region, tree, progress)


def _walk(
    bounded: Callable[[Corners], bool],
    region: Region,
    tree: str,
    progress: Callable[[float], None] | None,
) -> Check:
    stack = [_root(region)]
    leaves = 0
    for place, letter in enumerate(tree):
        if not stack:
            return Check(False, leaves, None, f"the tree goes on after its end, at {place}")
        box = stack.pop()
        if letter in "012"[: region.m]:
            halves = _halves(box, int(letter))
            if halves is None:
                return Check(False, leaves, box, "there is nothing between the ends of its side")
            stack += [halves[1], halves[0]]
            continue
        reason = _refused(letter, box, region, bounded)
        if reason:
            return Check(False, leaves, box, reason)
        leaves += 1
        if progress and leaves % 256 == 0:
            progress(place / len(tree))
    if stack:
        return Check(False, leaves, stack[-1], "the tree ends before this box")
    return Check(True, leaves)


def _root(region: Region) -> Corners:
    """Return the box that covers a region."""
    if isinstance(region, Ball):
        return (-region.radius,) * region.m, (region.radius,) * region.m
    return region.lower, region.upper


def _refused(letter: str, box: Corners, region: Region, bounded: Callable[[Corners], bool]) -> str:
    """Return what is wrong with a leaf, or nothing."""
    if letter == "o":
        return "" if _outside(box, region) else "a box called outside is not"
    if letter == "p":
        return "" if _holds(box, region, bounded, _MORE_CUTS) else "the claim is not confirmed here"
    return f"{letter!r} is no letter of a tree"


def _holds(box: Corners, region: Region, bounded: Callable[[Corners], bool], cuts: int) -> bool:
    """Return whether the claim holds in a box, halved further if need be."""
    if bounded(box) or _outside(box, region):
        return True
    widths = [high - low for low, high in zip(*box, strict=True)]
    halves = _halves(box, widths.index(max(widths))) if cuts else None
    return halves is not None and all(_holds(h, region, bounded, cuts - 1) for h in halves)


def _outside(box: Corners, region: Region) -> bool:
    """Return whether a box certainly has no point in the region."""
    from flint import arb

    if not isinstance(region, Ball):
        return False
    nearest = [max(low, -high, 0.0) for low, high in zip(*box, strict=True)]
    squares = [arb(v) * arb(v) for v in nearest]
    return bool(sum(squares[1:], squares[0]) > arb(region.radius) * arb(region.radius))


def _halves(box: Corners, axis: int) -> tuple[Corners, Corners] | None:
    """Return the halves along an axis; None if there is no number between its ends."""
    lower, upper = box
    cut = 0.5 * lower[axis] + 0.5 * upper[axis]
    if not lower[axis] < cut < upper[axis]:
        return None
    inner = (*upper[:axis], cut, *upper[axis + 1 :]), (*lower[:axis], cut, *lower[axis + 1 :])
    return (lower, inner[0]), (inner[1], upper)
