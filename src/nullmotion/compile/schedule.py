"""Order a program's operations so that long chains start early and few values wait."""

from __future__ import annotations

import heapq
from bisect import insort

from nullmotion.compile.program import Program, ordered

# rough latencies in cycles of what the operations become; 4 for all others
_LATENCY = {
    "div": 16, "sqrt": 20, "select": 2, "neg": 1, "fabs": 1, "copysign": 1, "and": 1, "or": 1,
    "not": 1, "flip": 2, "rsqrt_guess": 2, "bit": 6, "raw_bit": 3, "less": 3, "less_equal": 3,
    "equal": 3, "constant": 0, "input": 0,
}  # fmt: skip
_PASSIVE = ("constant", "input")
_REGISTERS = 24  # of 32; the rest holds constants and what is about to be used
_CANDIDATES = 24  # of the operations that are ready, when registers are short


def scheduled(program: Program, registers: int = _REGISTERS) -> Program:
    """Return the same program in another order of operations.

    List scheduling: of the operations whose operands are ready, the one with the longest
    way to the end comes first; when too many values are alive, the one that frees most.
    """
    order = _Scheduler(program, registers).order()
    return ordered(program.nodes, order, program.inputs, program.outputs, program.guards)


class _Scheduler:
    """The state of one list scheduling."""

    def __init__(self, program: Program, registers: int) -> None:
        nodes = program.nodes
        self.nodes, self.registers = nodes, registers
        self.latency = [_LATENCY.get(n.op, 4) for n in nodes]
        self.active = [n.op not in _PASSIVE for n in nodes]
        self.operands = [[a for a in set(n.args) if nodes[a].op != "constant"] for n in nodes]
        self.users: list[list[int]] = [[] for _ in nodes]
        for i, operands in enumerate(self.operands):
            for a in operands:
                self.users[a].append(i)
        self.height = list(self.latency)
        for i in range(len(nodes) - 1, -1, -1):
            if self.users[i]:
                self.height[i] += max(self.height[u] for u in self.users[i])
        roots = {*program.outputs, *program.guards.values()}
        self.left = [len(u) + (i in roots) for i, u in enumerate(self.users)]  # uses to come
        self.waiting = [sum(self.active[a] for a in operands) for operands in self.operands]
        self.ready: list[tuple[int, int]] = []  # (-height, operation), the most urgent first
        self.alive = 0

    def order(self) -> list[int]:
        """Return the order of all nodes."""
        order = [i for i, active in enumerate(self.active) if not active]
        for i, active in enumerate(self.active):
            if active and self.waiting[i] == 0:
                insort(self.ready, (-self.height[i], i))
        future: list[tuple[int, int]] = []  # (cycle, operation) whose operands are under way
        ready_at = [0] * len(self.nodes)
        now = 0
        while self.ready or future:
            while future and (future[0][0] <= now or not self.ready):
                cycle, i = heapq.heappop(future)
                now = max(now, cycle)
                insort(self.ready, (-self.height[i], i))
            i = self._take()
            order.append(i)
            self._free(i)
            done = now + self.latency[i]
            for u in self.users[i]:
                ready_at[u] = max(ready_at[u], done)
                self.waiting[u] -= 1
                if self.waiting[u] == 0:
                    heapq.heappush(future, (ready_at[u], u))
            now += 1
        return order

    def _take(self) -> int:
        """Remove and return the operation that comes next."""
        best = 0
        if self.alive > self.registers:
            most = -1
            for position, (_, i) in enumerate(self.ready[:_CANDIDATES]):
                freed = 0
                for a in self.operands[i]:
                    freed += self.left[a] == 1
                if freed > most:
                    best, most = position, freed
        return self.ready.pop(best)[1]

    def _free(self, i: int) -> None:
        """Count what lives after an operation."""
        self.alive += self.left[i] > 0
        for a in self.operands[i]:
            self.left[a] -= 1
            if self.left[a] == 0 and self.active[a]:
                self.alive -= 1
