"""A finished tape: only what the outputs need, with multiply-adds fused."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from nullmotion import tree
from nullmotion.compile.operations import OPERATIONS
from nullmotion.compile.places import tracing
from nullmotion.compile.tape import Node, Symbol, Tape


@dataclass(frozen=True)
class Program:
    """Straight-line code from named inputs to outputs.

    Attributes:
        nodes: Operations in an order in which operands come first.
        inputs: Node of each input.
        outputs: Node of each output.
        guards: For each status flag, the node of a boolean that must hold.
    """

    nodes: tuple[Node, ...]
    inputs: tuple[int, ...]
    outputs: tuple[int, ...]
    guards: dict[str, int] = field(default_factory=dict)

    @property
    def operations(self) -> int:
        """Number of operations (inputs and constants are none)."""
        return sum(n.op not in ("input", "constant") for n in self.nodes)

    def count(self) -> Counter[str]:
        """Return how often each operation occurs."""
        return Counter(n.op for n in self.nodes)


def trace(function: Callable[..., Any], *examples: Any, fuse: bool = True) -> tuple[Program, Any]:
    """Run ``function`` on symbols shaped like ``examples``.

    Args:
        function: Source without data-dependent branches; takes and returns records
            (floats, arrays, tuples, dataclasses: see `nullmotion.tree`).
        *examples: Records that show the shape of each argument.
        fuse: Fuse products with the sums that use them.

    Returns:
        The program and the traced result, whose leaves are symbols (its shape).

    Raises:
        TraceError: When the source decides by a value; names file and line.
    """
    tape = Tape()
    arguments: list[Any] = []
    inputs: list[Symbol] = []
    for i, example in enumerate(examples):
        symbols = tape.inputs(f"x{i}", len(tree.flatten(example)))
        inputs.extend(symbols)
        arguments.append(tree.unflatten(example, list(symbols)))
    with tracing():
        result = function(*arguments)
    return finish(tape, inputs, tree.flatten(result), fuse), result


def finish(
    tape: Tape,
    inputs: Sequence[Symbol],
    outputs: Sequence[Any],
    fuse: bool = True,
    replace: dict[int, int] | None = None,
) -> Program:
    """Turn a tape into a program: drop dead code, fuse, number anew.

    Args:
        tape: What was recorded.
        inputs: Inputs of the program.
        outputs: Symbols or numbers to compute.
        fuse: Fuse products with the sums that use them.
        replace: Nodes to be read from other nodes (inputs) wherever they are used.
    """
    ids = [o.node if isinstance(o, Symbol) else tape.constant(o) for o in outputs]
    guards = {flag: _all(tape, conditions) for flag, conditions in tape.guards.items()}
    guards = {flag: g for flag, g in guards.items() if tape.nodes[g].op != "constant"}
    nodes = list(tape.nodes)
    if replace:
        nodes = [Node(n.op, tuple(replace.get(a, a) for a in n.args), n.value) for n in nodes]
    roots = [*ids, *guards.values()]
    if fuse:
        _fuse(nodes, reachable(nodes, roots), set(roots))
    keep = reachable(nodes, [*roots, *[s.node for s in inputs]])
    # fusing appends: order by depth-first need keeps operands ahead of users
    order = [i for i in _topological(nodes, roots, [s.node for s in inputs]) if i in keep]
    return ordered(nodes, order, [s.node for s in inputs], ids, guards)


def ordered(
    nodes: Sequence[Node],
    order: Sequence[int],
    inputs: Sequence[int],
    outputs: Sequence[int],
    guards: Mapping[str, int],
) -> Program:
    """Return the program of the nodes named in ``order``, numbered anew."""
    number = {old: new for new, old in enumerate(order)}
    return Program(
        tuple(
            Node(nodes[i].op, tuple(number[a] for a in nodes[i].args), nodes[i].value)
            for i in order
        ),
        tuple(number[i] for i in inputs),
        tuple(number[i] for i in outputs),
        {flag: number[g] for flag, g in guards.items()},
    )


def _all(tape: Tape, conditions: Sequence[int]) -> int:
    result = tape.constant(True)
    for condition in conditions:
        result = tape.record("and", result, condition)
    return result


def reachable(nodes: Sequence[Node], roots: Iterable[int]) -> set[int]:
    """Return the roots and all that they are computed from."""
    live: set[int] = set()
    stack = list(roots)
    while stack:
        i = stack.pop()
        if i not in live:
            live.add(i)
            stack.extend(nodes[i].args)
    return live


def _topological(nodes: Sequence[Node], roots: Sequence[int], inputs: Sequence[int]) -> list[int]:
    order: list[int] = list(inputs)
    done = set(inputs)
    for root in sorted(set(roots)):
        stack = [(root, False)]
        while stack:
            i, expanded = stack.pop()
            if i in done:
                continue
            if expanded:
                done.add(i)
                order.append(i)
            else:
                stack.append((i, True))
                stack.extend((a, False) for a in reversed(nodes[i].args) if a not in done)
    return order


def _fuse(nodes: list[Node], live: set[int], roots: set[int]) -> None:
    """Replace a*b + c by fma where that makes the product itself needless."""
    users: dict[int, list[int]] = {}
    for i in live:
        for a in nodes[i].args:
            users.setdefault(a, []).append(i)
    sums = {"add", "sub"}
    was = [node.op for node in nodes]  # a user fused before still needs no product

    def fusible(i: int) -> bool:
        return was[i] == "mul" and i not in roots and all(was[u] in sums for u in users[i])

    negated: dict[int, int] = {}

    def negative(i: int) -> int:
        if i not in negated:
            nodes.append(Node("neg", (i,)))
            negated[i] = len(nodes) - 1
        return negated[i]

    for i in sorted(live):
        op, args = nodes[i].op, nodes[i].args
        if op not in sums or args[0] == args[1]:
            continue
        left, right = args
        if fusible(left):
            a, b = nodes[left].args
            nodes[i] = Node("fma", (a, b, right if op == "add" else negative(right)))
        elif fusible(right):
            a, b = nodes[right].args
            nodes[i] = Node("fma", (a if op == "add" else negative(a), b, left))


def interpret(program: Program, inputs: Sequence[Any]) -> list[Any]:
    """Evaluate a program with NumPy, operation by operation (slow; for tests and debugging)."""
    values: dict[int, Any] = dict(zip(program.inputs, inputs, strict=True))
    with np.errstate(all="ignore"):
        for i, node in enumerate(program.nodes):
            if node.op == "constant":
                values[i] = node.value
            elif node.op != "input":
                values[i] = OPERATIONS[node.op].evaluate(*[values[a] for a in node.args])
    return [values[i] for i in program.outputs]
