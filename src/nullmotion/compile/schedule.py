"""Order a program's operations so that long chains start early and few values wait."""

from __future__ import annotations

import heapq
from dataclasses import replace

from nullmotion.compile.program import Program
from nullmotion.compile.tape import Node

# rough latencies in cycles of what the operations become
_LATENCY = {
    "div": 16, "sqrt": 20, "select": 2, "neg": 1, "fabs": 1, "copysign": 1, "and": 1, "or": 1, "not": 1,
    "flip": 2, "rsqrt_guess": 2, "bit": 6, "raw_bit": 3, "less": 3, "less_equal": 3, "equal": 3,
    "constant": 0, "input": 0,
}  # fmt: skip
_REGISTERS = 26  # of 32; some hold constants


def scheduled(program: Program, registers: int = _REGISTERS) -> Program:
    """Return the same program in another order of operations.

    List scheduling: of the operations whose operands are ready, the one with the longest
    way to the end comes first; when too many values are alive, the one that frees most.
    """
    nodes = program.nodes
    users: list[list[int]] = [[] for _ in nodes]
    for i, node in enumerate(nodes):
        for a in set(node.args):
            users[a].append(i)
    height = [0] * len(nodes)
    for i in range(len(nodes) - 1, -1, -1):
        own = _LATENCY.get(nodes[i].op, 4)
        height[i] = own + max((height[u] for u in users[i]), default=0)
    roots = {*program.outputs, *program.guards.values()}
    left = [len(u) + (i in roots) for i, u in enumerate(users)]
    waiting = [sum(nodes[a].op not in ("constant", "input") for a in set(n.args)) for n in nodes]
    passive = [i for i, n in enumerate(nodes) if n.op in ("constant", "input")]
    alive = 0
    ready_at = [0] * len(nodes)
    future: list[tuple[int, int]] = []
    ready: list[tuple[int, int]] = []
    for i, n in enumerate(nodes):
        if n.op not in ("constant", "input") and waiting[i] == 0:
            heapq.heappush(ready, (-height[i], i))
    order = list(passive)
    now = 0
    while ready or future:
        while future and (future[0][0] <= now or not ready):
            time, i = heapq.heappop(future)
            now = max(now, time)
            heapq.heappush(ready, (-height[i], i))
        if alive > registers:
            def freed(item: tuple[int, int]) -> tuple[int, int]:
                i = item[1]
                gone = sum(left[a] == 1 and nodes[a].op not in ("constant",) for a in set(nodes[i].args))
                return (gone, height[i])
            pick = max(heapq.nsmallest(24, ready), key=freed)
            ready.remove(pick)
            heapq.heapify(ready)
        else:
            pick = heapq.heappop(ready)
        i = pick[1]
        order.append(i)
        alive += left[i] > 0
        for a in set(nodes[i].args):
            left[a] -= 1
            if left[a] == 0 and nodes[a].op not in ("constant", "input"):
                alive -= 1
        done = now + _LATENCY.get(nodes[i].op, 4)
        for u in users[i]:
            ready_at[u] = max(ready_at[u], done)
            waiting[u] -= 1
            if waiting[u] == 0:
                heapq.heappush(future, (ready_at[u], u))
        now += 1
    return renumbered(program, order)


def renumbered(program: Program, order: list[int]) -> Program:
    """Return the program with its nodes in the given order."""
    number = {old: new for new, old in enumerate(order)}
    nodes = tuple(
        Node(program.nodes[i].op, tuple(number[a] for a in program.nodes[i].args), program.nodes[i].value) for i in order
    )
    return replace(
        program,
        nodes=nodes,
        inputs=tuple(number[i] for i in program.inputs),
        outputs=tuple(number[i] for i in program.outputs),
        guards={flag: number[g] for flag, g in program.guards.items()},
    )
