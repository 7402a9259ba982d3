"""Recorded source as a list of steps, for number types that are no floats.

Source y = f(x) is recorded once. What remains of the tape are the steps that y needs, with
elementary functions as single steps (not what they are made of) and the patterns named that
an enclosure must know: x x is a square, `where(a < b, a, b)` is a minimum. Meaning is that of
real numbers: constants are the doubles on the tape, every step is exact.

    input, constant; add, sub, mul, square, div, neg, sqrt, abs, minimum, maximum;
    sin, cos, exp, log, acos, atan2; rint, copysign, select;
    less, less_equal, equal, and, or, not
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from nullmotion import tree
from nullmotion.compile.places import tracing
from nullmotion.compile.tape import Symbol, Tape
from nullmotion.errors import TraceError

_SAME = frozenset({"input", "constant", "add", "sub", "mul", "div", "neg", "sqrt", "rint"}) | {
    "copysign", "select", "less", "less_equal", "equal", "and", "or", "not",
    "sin", "cos", "exp", "log", "acos", "atan2",
}  # fmt: skip


@dataclass(frozen=True)
class Step:
    """One step: its name, the steps it takes, the value of a constant."""

    name: str
    args: tuple[int, ...] = ()
    value: float | bool | None = None


@dataclass(frozen=True)
class Steps:
    """Source as steps; operands come first.

    Attributes:
        steps: All of them; those named ``input`` are x in order.
        inputs: Position of each x.
        outputs: Position of each component of y.
    """

    steps: tuple[Step, ...]
    inputs: tuple[int, ...]
    outputs: tuple[int, ...]

    def __iter__(self) -> Iterator[tuple[int, Step]]:
        """Go through the steps with their positions."""
        return iter(enumerate(self.steps))


def record(function: Callable[[Any], Any], size: int) -> Steps:
    """Return the steps of y = f(x).

    Args:
        function: Source without data-dependent branches; takes an array (size,), returns
            numbers or records of them (see `nullmotion.tree`).
        size: Number of components of x.

    Raises:
        TraceError: When the source decides by a value, or uses what is no real function.
    """
    tape = Tape()
    inputs = tape.inputs("x", size)
    with tracing():
        leaves = tree.flatten(function(inputs))
    roots = [v.node if isinstance(v, Symbol) else tape.constant(v) for v in leaves]
    if any(tape.nodes[root].kind == "bool" for root in roots):
        raise TraceError("a condition is no number: return numbers")
    writer = _Writer(tape)
    at = [writer.position(symbol.node) for symbol in inputs]
    found = [writer.position(root) for root in roots]
    return Steps(tuple(writer.steps), tuple(at), tuple(found))


class _Writer:
    """Writes what nodes of a tape need, each once."""

    def __init__(self, tape: Tape) -> None:
        self._tape = tape
        self.steps: list[Step] = []
        self._known: dict[int | Step, int] = {}  # a node or a step: its position

    def position(self, root: int) -> int:
        """Return the position of a node's step, written now with all that it needs."""
        stack = [root]
        while stack:
            i = stack[-1]
            missing = [a for a in self._needs(i)[1] if a not in self._known]
            if missing and i not in self._known:
                stack += missing
            else:
                stack.pop()
                if i not in self._known:
                    self._known[i] = self._write(i)
        return self._known[root]

    def _needs(self, i: int) -> tuple[str, tuple[int, ...]]:
        """Return a node's operation or function, and its operands."""
        node = self._tape.nodes[i]
        if node.op == "select":
            condition, a, b = node.args
            test = self._tape.nodes[condition]
            if test.op in ("less", "less_equal") and set(test.args) == {a, b}:
                return "minimum" if test.args == (a, b) else "maximum", (a, b)
        if node.args:
            return self._tape.functions.get(i, (node.op, node.args))
        return node.op, ()

    def _write(self, i: int) -> int:
        name, operands = self._needs(i)
        args = tuple(self._known[a] for a in operands)
        if name in ("mul", "product"):
            return self._add("square", args[0]) if args[0] == args[1] else self._add("mul", *args)
        if name == "fma":
            return self._add("add", self._add("mul", *args[:2]), args[2])
        if name == "rsqrt":
            return self._add("div", self._add("constant", value=1.0), self._add("sqrt", *args))
        name = "abs" if name == "fabs" else name
        if name not in _SAME | {"abs", "minimum", "maximum"}:
            raise TraceError(f"operation {name!r} is no real function: it has no enclosure")
        value = self._tape.nodes[i].value if name == "constant" else None
        # two inputs are never one step, so an input's position is its value
        return self._add(name, *args, value=float(len(self.steps)) if name == "input" else value)

    def _add(self, name: str, *args: int, value: Any = None) -> int:
        step = Step(name, args, value)
        key: Any = (step, repr(value))  # 0.0, -0.0 and False are not one constant
        if key not in self._known:
            self.steps.append(step)
            self._known[key] = len(self.steps) - 1
        return self._known[key]


def dependent(steps: Steps) -> np.ndarray:
    """Return for each step which components of x it depends on, (steps, size)."""
    found = np.zeros((len(steps.steps), len(steps.inputs)), bool)
    found[list(steps.inputs), range(len(steps.inputs))] = True
    for i, step in steps:
        for a in step.args:
            found[i] |= found[a]
    return found


def pivotal(steps: Steps) -> set[int]:
    """Return the steps of which something other than a sum is made, and the outputs."""
    found = set(steps.outputs)
    for _, step in steps:
        if step.name not in ("add", "sub", "neg"):
            found.update(step.args)
    return found


def released(steps: Steps) -> list[list[int]]:
    """Return for each step which others are not needed after it."""
    last = {a: i for i, step in steps for a in step.args if a not in steps.outputs}
    found: list[list[int]] = [[] for _ in steps.steps]
    for a, i in last.items():
        found[i].append(a)
    return found
