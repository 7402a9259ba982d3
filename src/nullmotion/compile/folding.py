"""What simplifies while it is recorded: x + 0, x * 1, --x and the like."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from nullmotion.compile.tape import Tape


def _negated(tape: Tape, i: int) -> int | None:
    node = tape.nodes[i]
    return node.args[0] if node.op == "neg" else None


def _add(t: Tape, a: tuple[int, ...], c: Sequence[Any]) -> int | None:
    if c[0] == 0.0:
        return a[1]
    if c[1] == 0.0:
        return a[0]
    if (n := _negated(t, a[1])) is not None:
        return t.record("sub", a[0], n)
    if (n := _negated(t, a[0])) is not None:
        return t.record("sub", a[1], n)
    return None


def _sub(t: Tape, a: tuple[int, ...], c: Sequence[Any]) -> int | None:
    if c[1] == 0.0:
        return a[0]
    if c[0] == 0.0:
        return t.record("neg", a[1])
    if a[0] == a[1]:
        return t.constant(0.0)
    if (n := _negated(t, a[1])) is not None:
        return t.record("add", a[0], n)
    return None


def _mul(t: Tape, a: tuple[int, ...], c: Sequence[Any]) -> int | None:
    for value, other in ((c[0], a[1]), (c[1], a[0])):
        if value == 0.0:
            return t.constant(0.0)
        if value == 1.0:
            return other
        if value == -1.0:
            return t.record("neg", other)
    for i, other in ((a[0], a[1]), (a[1], a[0])):
        if (n := _negated(t, i)) is not None:
            return t.record("neg", t.record("mul", n, other))
    return None


def _div(t: Tape, a: tuple[int, ...], c: Sequence[Any]) -> int | None:
    if c[1] is None or c[1] == 0.0:
        return None
    if math.isinf(c[1]):
        return t.constant(0.0)
    exact = abs(math.frexp(c[1])[0]) == 0.5 and abs(math.frexp(c[1])[1]) < 1000
    return t.record("mul", a[0], t.constant(1.0 / c[1])) if exact else None


def _neg(t: Tape, a: tuple[int, ...], c: Sequence[Any]) -> int | None:
    return _negated(t, a[0])


def _select(t: Tape, a: tuple[int, ...], c: Sequence[Any]) -> int | None:
    if c[0] is not None:
        return a[1] if c[0] else a[2]
    return a[1] if a[1] == a[2] else None


def _logic(keep: bool) -> Callable[[Tape, tuple[int, ...], Sequence[Any]], int | None]:
    def rule(t: Tape, a: tuple[int, ...], c: Sequence[Any]) -> int | None:
        for value, other in ((c[0], a[1]), (c[1], a[0])):
            if value is not None:
                return other if bool(value) is keep else t.constant(not keep)
        return a[0] if a[0] == a[1] else None

    return rule


# x*0, x-x and x/inf -> 0 drop a NaN or infinity in x, x+0 -> x and 0-x -> -x the sign of a zero;
# the zeros of the axes make it worth it
RULES: dict[str, Callable[[Tape, tuple[int, ...], Sequence[Any]], int | None]] = {
    "add": _add,
    "sub": _sub,
    "mul": _mul,
    "div": _div,
    "neg": _neg,
    "select": _select,
    "and": _logic(True),
    "or": _logic(False),
}
