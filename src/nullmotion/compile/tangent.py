"""Derivatives of recorded source: tangents that flow beside the values (forward mode).

Source y = f(x) is recorded once, on a tape of its own. Replayed with values and tangents,
it gives y and the directional derivative y' = (df/dx) x', operation by operation:

    y = a b  ->  y' = a' b + a b',      y = sin a  ->  y' = a' cos a,      ...

The elementary functions, straight-line code on the tape, are differentiated as what they
are and not through their bits. `loop_tangent.differentiated` does this to a time loop.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from nullmotion import tree
from nullmotion.compile.derivatives import FLAT, RULES, Tangent, Value
from nullmotion.compile.places import tracing
from nullmotion.compile.tape import Symbol, Tape, apply
from nullmotion.errors import TraceError


def jvp(
    function: Callable[..., Any], arguments: Sequence[Any], tangents: Sequence[Any]
) -> tuple[Any, Any]:
    """Return f(x) and (df/dx) x', on floats or symbols.

    Args:
        function: Source without data-dependent branches.
        arguments: Its arguments x, records of numbers (see `nullmotion.tree`).
        tangents: For each argument a record x' shaped like it; None if it does not change.

    Raises:
        TraceError: When the source decides by a value, or has no derivative.
    """
    values: list[Value] = []
    changes: list[Tangent] = []
    for argument, tangent in zip(arguments, tangents, strict=True):
        leaves = tree.flatten(argument)
        values += leaves
        changes += [None] * len(leaves) if tangent is None else tree.flatten(tangent)
    varies = [t is not None or isinstance(v, Symbol) for v, t in zip(values, changes, strict=True)]
    recorded = Recorded(function, arguments, varies)
    results, slopes = recorded.push(values, changes)
    filled = [0.0 if t is None else t for t in slopes]
    return tree.unflatten(recorded.like, results), tree.unflatten(recorded.like, filled)


class Recorded:
    """Source on a tape, to be replayed with tangents.

    Attributes:
        tape: Where it is recorded.
        inputs: Node of each leaf of the arguments; None where it is a constant.
        outputs: Node of each leaf of the result.
        like: The result: shows its shape.
    """

    def __init__(
        self, function: Callable[..., Any], arguments: Sequence[Any], varies: Sequence[bool]
    ) -> None:
        """Record a function of records; leaves that do not vary are constants."""
        self.tape = tape = Tape()
        leaves = tree.flatten(list(arguments))
        given = [
            tape.input(f"x{i}") if flag else leaf
            for i, (leaf, flag) in enumerate(zip(leaves, varies, strict=True))
        ]
        with tracing():
            self.like = function(*tree.unflatten(list(arguments), given))
        self.inputs = [v.node if isinstance(v, Symbol) else None for v in given]
        results = tree.flatten(self.like)
        self.outputs = [v.node if isinstance(v, Symbol) else tape.constant(v) for v in results]
        guards = [c for conditions in tape.guards.values() for c in conditions]
        self._moving = self._reach(self.outputs, inside=False)
        self._live = sorted(self._reach([*self.outputs, *guards], inside=True))

    def _kind(self, i: int) -> tuple[str, tuple[int, ...]]:
        """Return what a node is to differentiation: operation or function, and its operands."""
        node = self.tape.nodes[i]
        return (node.op, ()) if not node.args else self.tape.functions.get(i, (node.op, node.args))

    def _reach(self, roots: Sequence[int], inside: bool) -> set[int]:
        """Return what roots are made of, with or without the insides of elementary functions."""
        found: set[int] = set()
        stack = list(roots)
        while stack:
            i = stack.pop()
            if i not in found:
                found.add(i)
                stack.extend(self._kind(i)[1])
                stack.extend(self.tape.nodes[i].args if inside else ())
        return found

    def push(
        self, values: Sequence[Value], tangents: Sequence[Tangent]
    ) -> tuple[list[Value], list[Tangent]]:
        """Return values and tangents of the result for those of the arguments' leaves."""
        value: dict[int, Value] = {}
        change: dict[int, Tangent] = {}
        for i, v, t in zip(self.inputs, values, tangents, strict=True):
            if i is not None:
                value[i], change[i] = v, t
        with np.errstate(all="ignore"):  # floats go through branches that are not taken, too
            for i in self._live:
                node = self.tape.nodes[i]
                if node.op != "input":
                    operands = [value[a] for a in node.args]
                    value[i] = apply(node.op, *operands) if operands else node.value
                if i in self._moving and i not in change:
                    change[i] = self._slope(i, value, change)
        self._pass_on(value)
        return [value[i] for i in self.outputs], [change[i] for i in self.outputs]

    def _slope(self, i: int, value: dict[int, Value], change: dict[int, Tangent]) -> Tangent:
        name, operands = self._kind(i)
        tangents = [change[a] for a in operands]
        if name in FLAT or all(t is None for t in tangents):
            return None
        if name not in RULES:
            raise TraceError(f"operation {name!r} has no derivative")
        return RULES[name](value[i], [value[a] for a in operands], tangents)

    def _pass_on(self, value: dict[int, Value]) -> None:
        """Tell the tape of the values what this one knows: guards and elementary functions."""
        for flag, conditions in self.tape.guards.items():
            for condition in (value[c] for c in conditions):
                if isinstance(condition, Symbol):
                    condition.tape.guard(flag, condition.node)
        for i, (name, args) in self.tape.functions.items():
            if isinstance(result := value.get(i), Symbol):
                tape, reals = result.tape, [value[a] for a in args]
                ids = [v.node if isinstance(v, Symbol) else tape.constant(v) for v in reals]
                tape.remember(name, tuple(ids), result.node)

    def depends(self, changing: Sequence[bool]) -> list[bool]:
        """Return which leaves of the result change with those of the arguments marked."""
        on = {i for i, flag in zip(self.inputs, changing, strict=True) if flag and i is not None}
        for i in sorted(self._moving):
            name, operands = self._kind(i)
            if name not in FLAT and any(a in on for a in operands):
                on.add(i)
        return [i in on for i in self.outputs]
