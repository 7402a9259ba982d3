"""Trace the stages of a loop, and find which of its state its outputs need."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

from nullmotion import tree
from nullmotion.compile import carry
from nullmotion.compile.loop import Loop, Stage
from nullmotion.compile.places import tracing
from nullmotion.compile.program import Program, finish, ordered, reachable
from nullmotion.compile.tape import Symbol, Tape
from nullmotion.errors import TraceError


@dataclass(frozen=True)
class Piece:
    """A traced part of a step.

    ``program`` goes from (state, parameters, k, row, carried values) to (state, record,
    carried values), ``prime`` from (state, parameters) to the carried values.
    """

    program: Program
    period: int
    phase: int
    records: int = 0
    prime: Program | None = None

    @property
    def extra(self) -> int:
        """Number of values carried beside the state."""
        return len(self.prime.outputs) if self.prime else 0


@dataclass
class LoopTrace:
    """All programs of a loop with its state pruned to what is needed."""

    start: Program
    pieces: list[Piece]
    outputs: Program
    active: Program | None
    live: list[int]
    flags: list[str]
    output_like: Any = None
    record_like: Any = None
    state_like: Any = None


def _symbolic(tape: Tape, like: Any, name: str) -> tuple[Any, list[Symbol]]:
    symbols = list(tape.inputs(name, len(tree.flatten(like))))
    return tree.unflatten(like, symbols), symbols


def _parameters(tape: Tape, loop: Loop) -> tuple[Any, list[Symbol]]:
    leaves = tree.flatten(loop.parameters)
    symbols: list[Symbol] = []
    for i, varies in enumerate(loop.varying):
        if varies:
            symbols.append(tape.input(f"p{i}"))
            leaves[i] = symbols[-1]
    return tree.unflatten(loop.parameters, leaves), symbols


def _trace_start(loop: Loop, fuse: bool) -> tuple[Program, Any]:
    tape = Tape()
    parameters, inputs = _parameters(tape, loop)
    with tracing():
        state = loop.start(parameters)
    return finish(tape, inputs, tree.flatten(state), fuse), state


def _trace_stages(
    loop: Loop,
    stages: Sequence[tuple[int, Stage]],
    like: Any,
    recording: bool,
    fuse: bool,
    whole: bool,
) -> tuple[Piece, Any]:
    """Trace consecutive stages as one program; return it and the record.

    With ``whole``, the stages are all of a step: values that a step can hand to the next
    become further inputs and outputs.
    """
    tape = Tape()
    state, state_in = _symbolic(tape, like, "s")
    parameters, parameter_in = _parameters(tape, loop)
    k = tape.input("k")
    row = tape.inputs("row", loop.row)
    record: Any = ()
    with tracing():
        for index, stage in stages:
            if recording and loop.record is not None and index == loop.recorded_after:
                record = loop.record(state)
            state = stage.function(k, row, state, parameters)
    if tree.structure(state) != tree.structure(like):
        raise TraceError("the loop's state changes its shape within a step")
    kept = tree.flatten(record)
    outputs = [*tree.flatten(state), *kept]
    inputs = [*state_in, *parameter_in, k, *row]
    period, phase = stages[0][1].period, stages[0][1].phase
    if not whole:
        return Piece(finish(tape, inputs, outputs, fuse), period, phase, len(kept)), record
    ids = [o.node if isinstance(o, Symbol) else tape.constant(o) for o in outputs]
    found = carry.find(tape, [s.node for s in state_in], [p.node for p in parameter_in], ids)
    handed = [Symbol(tape, i) for i in found.nodes]
    prime = finish(tape, [*state_in, *parameter_in], handed, fuse)
    prime = replace(prime, guards={})  # the step's own guards look at the same angles
    extra = [tape.input(f"c{i}") for i in range(len(found.nodes))]
    outputs += [Symbol(tape, i) for i in found.updates]
    instead = dict(zip(found.nodes, (e.node for e in extra), strict=True))
    program = finish(tape, [*inputs, *extra], outputs, fuse, instead)
    return Piece(program, period, phase, len(kept), prime), record


def _trace_view(
    loop: Loop, function: Callable[[Any, Any], Any], like: Any, fuse: bool
) -> tuple[Program, Any]:
    tape = Tape()
    state, inputs = _symbolic(tape, like, "s")
    parameters, more = _parameters(tape, loop)
    result = function(state, parameters)
    return finish(tape, [*inputs, *more], tree.flatten(result), fuse), result


def trace_loop(loop: Loop, recording: bool, fuse: bool) -> LoopTrace:
    """Trace every part of a loop and find the state that its outputs need.

    Raises:
        TraceError: When a stage decides by a value.
    """
    start, like = _trace_start(loop, fuse)
    groups = _groups(loop)
    pieces, record_like = [], ()
    for group in groups:
        piece, record = _trace_stages(loop, group, like, recording, fuse, len(groups) == 1)
        record_like = record if piece.records else record_like
        pieces.append(piece)
    outputs, output_like = _trace_view(loop, loop.outputs, like, fuse)
    going = loop.active
    active = _trace_view(loop, lambda s, _: going(s), like, fuse)[0] if going else None
    size = len(tree.flatten(like))
    views = [outputs, *([active] if active else [])]
    live = _live_state(size, pieces, views)
    flags = sorted({flag for p in [start, *[q.program for q in pieces]] for flag in p.guards})
    return LoopTrace(start, pieces, outputs, active, live, flags, output_like, record_like, like)


def _groups(loop: Loop) -> list[list[tuple[int, Stage]]]:
    groups: list[list[tuple[int, Stage]]] = []
    for item in enumerate(loop.stages):
        same = groups and (groups[-1][-1][1].period, groups[-1][-1][1].phase) == (
            item[1].period,
            item[1].phase,
        )
        groups[-1].append(item) if same else groups.append([item])
    return groups


def _dependence(program: Program) -> list[int]:
    """Return for each node the inputs that it depends on, as a bit mask."""
    masks = [0] * len(program.nodes)
    for bit, i in enumerate(program.inputs):
        masks[i] = 1 << bit
    for i, node in enumerate(program.nodes):
        for a in node.args:
            masks[i] |= masks[a]
    return masks


def _live_state(size: int, pieces: Sequence[Piece], views: Sequence[Program]) -> list[int]:
    """Return the indices of state values that some output depends on, over any number of steps."""
    every = (1 << size) - 1
    live = 0
    masks = [(p, _dependence(p.program)) for p in pieces]
    for view in views:
        mask = _dependence(view)
        for node in [*view.outputs, *view.guards.values()]:
            live |= mask[node] & every
    for piece, mask in masks:
        for node in [*piece.program.outputs[size:], *piece.program.guards.values()]:
            live |= mask[node] & every
        if piece.prime:
            prime = _dependence(piece.prime)
            for node in piece.prime.outputs:
                live |= prime[node] & every
    while True:
        grown = live
        for piece, mask in masks:
            for i in range(size):
                if live >> i & 1:
                    grown |= mask[piece.program.outputs[i]] & every
        if grown == live:
            return [i for i in range(size) if live >> i & 1]
        live = grown


def cut(program: Program, keep_inputs: Sequence[int], keep_outputs: Sequence[int]) -> Program:
    """Return the program with only some outputs; inputs not kept must be unused then."""
    outputs = [program.outputs[i] for i in keep_outputs]
    inputs = [program.inputs[i] for i in keep_inputs]
    needed = reachable(program.nodes, [*outputs, *program.guards.values()]).union(inputs)
    return ordered(program.nodes, sorted(needed), inputs, outputs, program.guards)
