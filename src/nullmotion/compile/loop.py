"""A time loop around traced stages: its description, and the kernel made from it.

A loop carries a state record through steps k = 0, 1, ... Each stage is a pure
function that acts at the steps ``k % period == phase``. The kernel keeps the
state of one vector of runs in registers through the whole loop; what no output
needs is never computed.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from nullmotion import tree
from nullmotion.compile import carry, llvm
from nullmotion.compile.function import load, store
from nullmotion.compile.program import Program, finish, ordered, reachable
from nullmotion.compile.schedule import scheduled
from nullmotion.compile.tape import Symbol, Tape, tracing

StageFunction = Callable[[Any, Any, Any, Any], Any]  # (k, row, state, parameters) -> state


@dataclass(frozen=True)
class Stage:
    """One part of a step: ``function(k, row, state, parameters) -> state``."""

    function: StageFunction
    period: int = 1
    phase: int = 0


@dataclass(frozen=True)
class Loop:
    """What is repeated, on floats or symbols alike.

    Attributes:
        start: Makes the state from the parameters.
        stages: What a step does, in order.
        outputs: Makes what is wanted of the state and the parameters at the end.
        record: Picks what a history keeps, after the stages ``recorded_after`` and
            before the rest of the step.
        parameters: Example record; its leaves are constants but for the varying ones.
        varying: For each leaf of ``parameters``, whether it differs between runs.
        row: Length of a row of the schedule, the values that all runs share in a step.
        row_period: Steps for which a row holds.
        active: Tells from the state whether a run goes on; None if all do.
        recorded_after: Number of stages before the record.
    """

    start: Callable[[Any], Any]
    stages: tuple[Stage, ...]
    outputs: Callable[[Any, Any], Any]
    parameters: Any
    varying: tuple[bool, ...]
    row: int = 0
    row_period: int = 1
    active: Callable[[Any], Any] | None = None
    record: Callable[[Any], Any] | None = None
    recorded_after: int = 0


@dataclass(frozen=True)
class _Piece:
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
class _Trace:
    """All programs of a loop with its state pruned to what is needed."""

    start: Program
    pieces: list[_Piece]
    outputs: Program
    active: Program | None
    live: list[int]
    flags: list[str]
    output_like: Any = None
    record_like: Any = None
    state_like: Any = field(default=None)


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
) -> tuple[_Piece, Any]:
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
    kept = tree.flatten(record)
    outputs = [*tree.flatten(state), *kept]
    inputs = [*state_in, *parameter_in, k, *row]
    period, phase = stages[0][1].period, stages[0][1].phase
    if not whole:
        return _Piece(finish(tape, inputs, outputs, fuse), period, phase, len(kept)), record
    ids = [o.node if isinstance(o, Symbol) else tape.constant(o) for o in outputs]
    found = carry.find(tape, [s.node for s in state_in], [p.node for p in parameter_in], ids)
    prime = finish(tape, [*state_in, *parameter_in], [Symbol(tape, i) for i in found.nodes], fuse)
    extra = [tape.input(f"c{i}") for i in range(len(found.nodes))]
    outputs += [Symbol(tape, i) for i in found.updates]
    replace = dict(zip(found.nodes, (e.node for e in extra), strict=True))
    program = finish(tape, [*inputs, *extra], outputs, fuse, replace)
    return _Piece(program, period, phase, len(kept), prime), record


def _trace_view(
    loop: Loop, function: Callable[[Any, Any], Any], like: Any, fuse: bool
) -> tuple[Program, Any]:
    tape = Tape()
    state, inputs = _symbolic(tape, like, "s")
    parameters, more = _parameters(tape, loop)
    result = function(state, parameters)
    return finish(tape, [*inputs, *more], tree.flatten(result), fuse), result


def trace_loop(loop: Loop, recording: bool, fuse: bool) -> _Trace:
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
    return _Trace(start, pieces, outputs, active, live, flags, output_like, record_like, like)


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


def _live_state(size: int, pieces: Sequence[_Piece], views: Sequence[Program]) -> list[int]:
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


def _cut(program: Program, keep_inputs: Sequence[int], keep_outputs: Sequence[int]) -> Program:
    """Return the program with only some outputs; inputs not kept must be unused then."""
    outputs = [program.outputs[i] for i in keep_outputs]
    inputs = [program.inputs[i] for i in keep_inputs]
    needed = reachable(program.nodes, [*outputs, *program.guards.values()]).union(inputs)
    return ordered(program.nodes, sorted(needed), inputs, outputs, program.guards)


class _Writer:
    """Writes the kernel of a traced loop."""

    def __init__(self, loop: Loop, traced: _Trace, width: int) -> None:
        self.loop, self.traced, self.shape = loop, traced, llvm.Shape(width)
        self.size = len(tree.flatten(traced.state_like))
        self.states = len(traced.live)
        self.parameters = sum(loop.varying)
        self.lines: list[str] = []
        self.ahead: list[str] = []  # what follows from the parameters alone: once, before the loop
        self.carried = self.states + len(traced.flags)
        self.extra = traced.pieces[0].extra if len(traced.pieces) == 1 else 0  # not kept in memory

    def source(self) -> str:
        """Return the module's text."""
        pointers = ("state", "parameters", "schedule", "history", "out")
        whole = ("stride", "total", "offset", "lane0", "lane1", "k0", "k1", "last", "every")
        arguments = ", ".join(f"ptr noalias %{name}" for name in pointers)
        numbers = ", ".join(f"i64 %{name}" for name in whole)
        self.lines += [
            f"define void @loop({arguments}, {numbers}) #0 {{",
            "entry:",
            "  br label %lane",
            "lane:",
        ]
        self.lines += [
            "  %l = phi i64 [%lane0, %entry], [%lnext, %lend]",
            "  %lo = add i64 %l, %offset",
        ]
        for j in range(self.parameters):
            self.lines += load(self.shape, "%parameters", str(j), "%total", "%lo", f"%p{j}")
        self._begin()
        entry = len(self.lines) - 1
        current = self._steps()
        self.lines[entry:entry] = self.ahead
        self._end(current)
        self.lines.append("}")
        return "\n".join(
            [*llvm.declarations(self.shape), *self._reductions(), *self.lines, llvm.ATTRIBUTES]
        )

    def _reductions(self) -> list[str]:
        return [f"declare i1 @llvm.vector.reduce.or.v{self.shape.width}i1({self.shape.boolean})"]

    def _body(
        self, program: Program, inputs: Sequence[str], prefix: str, early: Sequence[int] = ()
    ) -> tuple[list[str], dict[str, str]]:
        code = llvm.body(program, inputs, self.shape, prefix, early)
        self.lines += [f"  {line}" for line in code.lines]
        self.ahead += [f"  {line}" for line in code.early]
        return code.outputs, code.guards

    def _raise(self, flags: Sequence[str], guards: dict[str, str], prefix: str) -> list[str]:
        """Return the flag values after guards of one piece."""
        out = list(flags)
        real, one = self.shape.real, self.shape.constant(1.0)
        for j, flag in enumerate(self.traced.flags):
            if flag in guards:
                name = f"%{prefix}flag{j}"
                test = f"{self.shape.boolean} {guards[flag]}"
                self.lines.append(f"  {name} = select {test}, {real} {flags[j]}, {real} {one}")
                out[j] = name
        return out

    def _begin(self) -> None:
        """At k0 = 0 the state comes from the parameters, later from memory."""
        names = [f"%p{j}" for j in range(self.parameters)]
        self.lines += [
            "  %fresh = icmp eq i64 %k0, 0",
            "  br i1 %fresh, label %start, label %resume",
            "start:",
        ]
        outputs, guards = self._body(
            _cut(self.traced.start, range(self.parameters), self.traced.live), names, "b"
        )
        flags = self._raise([self.shape.constant(0.0)] * len(self.traced.flags), guards, "b")
        self.lines += ["  br label %begin", "resume:"]
        for j in range(self.carried):
            self.lines += load(self.shape, "%state", str(j), "%stride", "%l", f"%m{j}")
        self.lines += ["  br label %begin", "begin:"]
        for j, value in enumerate([*outputs, *flags]):
            self.lines.append(
                f"  %i{j} = phi {self.shape.real} [{value}, %start], [%m{j}, %resume]"
            )
        self.first = [f"%i{j}" for j in range(self.carried)]
        if self.extra:
            prime = self.traced.pieces[0].prime
            assert prime is not None
            self.first += self._view(prime, self.first[: self.states], "x")
        self.lines.append("  br label %step")

    def _steps(self) -> list[str]:
        """Write the loop over steps; return the names of the carried values."""
        self.lines += ["step:", "  %k = phi i64 [%k0, %begin], [%knext, %latch]"]
        phis = len(self.lines)
        self.lines += ["  %kd = sitofp i64 %k to double"]
        self.lines += self._splat("%kd", "%kv")
        row = self._row()
        current = [f"%c{j}" for j in range(self.carried + self.extra)]
        base = 0
        for index, piece in enumerate(self.traced.pieces):
            current = self._piece(index, piece, current, row, base)
            base += piece.records
        self.lines += ["  br label %latch", "latch:"]
        # a carried value may be a constant or another's name: the loop's phis are written last
        self.lines += ["  %knext = add i64 %k, 1", "  %more = icmp slt i64 %knext, %k1"]
        going = self._going(current[: self.states])
        self.lines.append(f"  br i1 {going}, label %step, label %done")
        self.lines[phis:phis] = [
            f"  %c{j} = phi {self.shape.real} [{self.first[j]}, %begin], [{name}, %latch]"
            for j, name in enumerate(current)
        ]
        return current

    def _splat(self, scalar: str, name: str) -> list[str]:
        v, w = self.shape.real, self.shape.width
        return [
            f"  {name}.e = insertelement {v} poison, double {scalar}, i32 0",
            f"  {name} = shufflevector {v} {name}.e, {v} poison, <{w} x i32> zeroinitializer",
        ]

    def _row(self) -> list[str]:
        names = []
        if self.loop.row:
            self.lines.append(f"  %rowi = udiv i64 %k, {self.loop.row_period}")
            self.lines.append(f"  %rowb = mul i64 %rowi, {self.loop.row}")
        for j in range(self.loop.row):
            self.lines += [
                f"  %row{j}.i = add i64 %rowb, {j}",
                f"  %row{j}.p = getelementptr double, ptr %schedule, i64 %row{j}.i",
                f"  %row{j}.s = load double, ptr %row{j}.p",
                *self._splat(f"%row{j}.s", f"%row{j}"),
            ]
            names.append(f"%row{j}")
        return names

    def _piece(
        self, index: int, piece: _Piece, current: list[str], row: list[str], base: int
    ) -> list[str]:
        live = self.traced.live
        others = range(self.size, self.size + self.parameters + 1 + self.loop.row + self.extra)
        outputs = [*live, *range(self.size, self.size + piece.records + self.extra)]
        program = scheduled(_cut(piece.program, [*live, *others], outputs))
        inputs = [
            *current[: self.states],
            *[f"%p{j}" for j in range(self.parameters)],
            "%kv",
            *row,
            *current[self.carried :],
        ]
        conditional = piece.period > 1
        if conditional:
            self.lines += [
                f"  %due{index}.r = urem i64 %k, {piece.period}",
                f"  %due{index} = icmp eq i64 %due{index}.r, {piece.phase}",
                f"  br label %pre{index}",
                f"pre{index}:",
                f"  br i1 %due{index}, label %do{index}, label %join{index}",
                f"do{index}:",
            ]
        fixed = range(self.states, self.states + self.parameters)
        results, guards = self._body(program, inputs, f"g{index}_", fixed)
        flags = self._raise(current[self.states : self.carried], guards, f"g{index}_")
        self._history(index, results[self.states : self.states + piece.records], base)
        after = [*results[: self.states], *flags, *results[self.states + piece.records :]]
        if not conditional:
            return after
        self.lines += [f"  br label %join{index}", f"join{index}:"]
        names = [f"%j{index}_{j}" for j in range(self.carried)]
        for name, value, old in zip(names, after, current, strict=True):
            self.lines.append(
                f"  {name} = phi {self.shape.real} [{value}, %do{index}], [{old}, %pre{index}]"
            )
        return names

    def _history(self, index: int, values: Sequence[str], base: int) -> None:
        if not values:
            return
        total = sum(p.records for p in self.traced.pieces)
        self.lines += [
            f"  %kept{index}.r = urem i64 %k, %every",
            f"  %kept{index} = icmp eq i64 %kept{index}.r, 0",
            f"  br i1 %kept{index}, label %keep{index}, label %kept{index}.end",
            f"keep{index}:",
            f"  %kept{index}.q = udiv i64 %k, %every",
            f"  %kept{index}.a = mul i64 %kept{index}.q, {total}",
        ]
        for r, value in enumerate(values):
            tag = f"%h{index}_{r}"
            self.lines.append(f"  {tag}.b = add i64 %kept{index}.a, {base + r}")
            self.lines += store(self.shape, "%history", f"{tag}.b", "%stride", "%l", value, tag)
        self.lines += [f"  br label %kept{index}.end", f"kept{index}.end:"]

    def _going(self, states: list[str]) -> str:
        if self.traced.active is None:
            return "%more"
        outputs = self._view(self.traced.active, states, "a")
        w = self.shape.width
        self.lines.append(
            f"  %any = call i1 @llvm.vector.reduce.or.v{w}i1({self.shape.boolean} {outputs[0]})"
        )
        self.lines.append("  %going = and i1 %any, %more")
        return "%going"

    def _view(self, program: Program, states: list[str], prefix: str) -> list[str]:
        """Write a function of the state and the parameters; return its values."""
        inputs = [*self.traced.live, *range(self.size, self.size + self.parameters)]
        names = [*states, *[f"%p{j}" for j in range(self.parameters)]]
        return self._body(_cut(program, inputs, range(len(program.outputs))), names, prefix)[0]

    def _end(self, current: list[str]) -> None:
        self.lines.append("done:")
        current = current[: self.carried]
        for j, name in enumerate(current):
            self.lines += store(self.shape, "%state", str(j), "%stride", "%l", name, f"%e{j}")
        self.lines += [
            "  %final = icmp eq i64 %last, 1",
            "  br i1 %final, label %write, label %lend",
            "write:",
        ]
        outputs = self._view(self.traced.outputs, current[: self.states], "o")
        for j, name in enumerate([*outputs, *current[self.states :]]):
            self.lines += store(self.shape, "%out", str(j), "%total", "%lo", name, f"%w{j}")
        self.lines += ["  br label %lend", "lend:", f"  %lnext = add i64 %l, {self.shape.width}"]
        self.lines += [
            "  %lmore = icmp slt i64 %lnext, %lane1",
            "  br i1 %lmore, label %lane, label %end",
        ]
        self.lines += ["end:", "  ret void"]


LOOP_TYPES = (ctypes.c_void_p,) * 5 + (ctypes.c_int64,) * 9


class LoopKernel:
    """Machine code of a loop.

    Attributes:
        width: Runs in one vector.
        carried: Rows of state memory.
        outputs: Rows of output, then one for each flag.
        flags: Status flags that guards may raise.
        records: Rows of history in a step (0 without recording).
        operations: Tape operations of one step.
    """

    def __init__(
        self, loop: Loop, *, recording: bool = False, width: int | None = None, level: int = 2
    ) -> None:
        """Trace and compile a loop."""
        machine = llvm.host()
        self.loop = loop
        self.width = width or machine.batch_lanes
        traced = trace_loop(loop, recording, machine.fma)
        self.traced = traced
        writer = _Writer(loop, traced, self.width)
        self.source = writer.source()
        self._machine = llvm.machine(self.source, level)
        self._run = self._machine.function("loop", *LOOP_TYPES)
        self.carried = writer.carried
        self.flags = traced.flags
        self.outputs = len(traced.outputs.outputs)
        self.records = sum(p.records for p in traced.pieces)
        self.operations = sum(
            _cut(p.program, range(len(p.program.inputs)), traced.live).operations
            for p in traced.pieces
        )

    def run(
        self,
        state: np.ndarray,
        parameters: np.ndarray,
        schedule: np.ndarray,
        history: np.ndarray,
        out: np.ndarray,
        offset: int,
        lanes: int,
        k0: int,
        k1: int,
        last: bool,
        every: int = 1,
    ) -> None:
        """Advance ``lanes`` runs through steps k0..k1-1.

        Their parameters and outputs begin at column ``offset``. All arrays are C-contiguous
        doubles: state (carried, lanes), parameters and out (rows, runs), history (samples,
        records, lanes) with a sample ``every`` so many steps. Releases the GIL.
        """
        self._run(
            state.ctypes.data,
            parameters.ctypes.data,
            schedule.ctypes.data,
            history.ctypes.data,
            out.ctypes.data,
            state.shape[1],
            out.shape[1],
            offset,
            0,
            lanes,
            k0,
            k1,
            int(last),
            every,
        )


def run_on_host(
    loop: Loop,
    steps: int,
    schedule: np.ndarray,
    on_step: Callable[[int], None] | None = None,
    recording: bool = False,
) -> tuple[Any, list[Any]]:
    """Run one loop in plain Python, with the floats of ``loop.parameters``.

    Returns:
        The outputs and, when recording, the record of every step.
    """
    parameters, history = loop.parameters, []
    state = loop.start(parameters)
    for k in range(steps):
        row = schedule[k // loop.row_period] if loop.row else np.zeros(0)
        for index, stage in enumerate(loop.stages):
            if recording and loop.record is not None and index == loop.recorded_after:
                history.append(loop.record(state))
            if k % stage.period == stage.phase:
                state = stage.function(float(k), row, state, parameters)
        if on_step is not None:
            on_step(k)
        if loop.active is not None and not loop.active(state):
            break
    return loop.outputs(state, parameters), history
