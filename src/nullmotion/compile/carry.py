"""Find values that one step of a loop computes twice: at its end, and the next at its start.

If a step computes sin(x') of its new state x' and the next begins with sin(x), the
value can be carried over instead. Only values that come out with the same bits
wherever they are computed qualify: no product in them may be fused with a sum.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from nullmotion.compile.operations import OPERATIONS
from nullmotion.compile.program import reachable
from nullmotion.compile.tape import Tape


@dataclass(frozen=True)
class Carried:
    """Values to carry.

    Attributes:
        nodes: What the step computes from its old state.
        updates: The nodes that hold the same functions of its new state.
    """

    nodes: list[int]
    updates: list[int]


def find(
    tape: Tape, state: Sequence[int], parameters: Sequence[int], outputs: Sequence[int]
) -> Carried:
    """Return the values that a step can hand to the next.

    Args:
        tape: Where the step was recorded.
        state: Nodes of the old state.
        parameters: Nodes that stay the same from step to step.
        outputs: Nodes of the new state and of everything else the step gives.
    """
    needed = reachable(tape.nodes, outputs)
    moved = {node: _advance(tape, node, outputs[i]) for i, node in enumerate(state)}
    images: dict[int, int] = {p: p for p in parameters}
    held: dict[int, int | None] = dict.fromkeys(
        parameters
    )  # the condition under which a run goes on
    images.update({node: target for node, (target, _) in moved.items()})
    held.update({node: condition for node, (_, condition) in moved.items()})
    pure = set(parameters) | set(state)
    candidates: dict[int, int] = {}
    for i in sorted(needed):
        node = tape.nodes[i]
        if node.op == "constant":
            images[i], held[i] = i, None
            pure.add(i)
        elif node.args and all(a in images and a in pure for a in node.args) and _bitwise(tape, i):
            conditions = {held[a] for a in node.args if images[a] != a or a in moved}
            target = _lookup(tape, node.op, [images[a] for a in node.args])
            if target is not None and len(conditions) == 1:
                images[i], held[i] = target, conditions.pop()
                pure.add(i)
                if target in needed and i not in outputs:
                    candidates[i] = target
    return _frontier(tape, needed, candidates, held, outputs)


def _frontier(
    tape: Tape,
    needed: set[int],
    candidates: dict[int, int],
    held: dict[int, int | None],
    outputs: Sequence[int],
) -> Carried:
    """Keep the candidates that something else than a candidate uses."""
    used = {a for i in needed if i not in candidates for a in tape.nodes[i].args}
    nodes = [
        i for i in candidates if i in used and tape.nodes[i].kind == "real" and candidates[i] != i
    ]
    updates = []
    for i in nodes:
        condition = held[i]
        updates.append(
            candidates[i]
            if condition is None
            else tape.record("select", condition, candidates[i], i)
        )
    return Carried(nodes, updates)


def _advance(tape: Tape, old: int, new: int) -> tuple[int, int | None]:
    """Return what a state value becomes, and under which condition if it may stay."""
    node = tape.nodes[new]
    if node.op == "select" and node.args[2] == old:
        return node.args[1], node.args[0]
    return new, None


def _bitwise(tape: Tape, i: int) -> bool:
    """Return whether no product can be fused into this sum."""
    node = tape.nodes[i]
    return node.op not in ("add", "sub") or all(tape.nodes[a].op != "mul" for a in node.args)


def _lookup(tape: Tape, op: str, args: list[int]) -> int | None:
    if OPERATIONS[op].commutative and args[0] > args[1]:
        args = [args[1], args[0]]
    return tape._index.get((op, *args))
