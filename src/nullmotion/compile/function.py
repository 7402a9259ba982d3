"""Compile straight-line source to a function over batches of inputs."""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from typing import Any

import numpy as np

from nullmotion import tree
from nullmotion.compile import llvm
from nullmotion.compile.program import Program, trace
from nullmotion.compile.schedule import scheduled


def map_source(program: Program, width: int) -> str:
    """Return IR of ``map(in, out, stride, lane0, lane1)``: lanes side by side, values apart.

    Value v of lane l stands at ``in[v*stride + l]``; outputs alike, the status
    (0 or 1 for each guard, in the order of the program's guards) behind them.
    """
    shape = llvm.Shape(width)
    arguments = "ptr noalias %in, ptr noalias %out, i64 %stride, i64 %lane0, i64 %lane1"
    lines = [f"define void @map({arguments}) #0 {{", "entry:", "  br label %lane", "lane:"]
    lines += ["  %l = phi i64 [%lane0, %entry], [%next, %lane]"]
    code, outputs, flags = _evaluation(program, shape, "%in", "%stride", "%l")
    lines += code
    for v, name in enumerate([*outputs, *flags]):
        lines += store(shape, "%out", f"{v}", "%stride", "%l", name, f"%out{v}")
    lines += [f"  %next = add i64 %l, {width}", "  %more = icmp slt i64 %next, %lane1"]
    lines += ["  br i1 %more, label %lane, label %end", "end:", "  ret void", "}"]
    return "\n".join([*llvm.declarations(shape), *lines, llvm.ATTRIBUTES])


def _evaluation(
    program: Program, shape: llvm.Shape, base: str, stride: str, lane: str
) -> tuple[list[str], list[str], list[str]]:
    """Return IR that evaluates a program, the names of its outputs and of its status flags."""
    lines, names = [], [f"%in{v}" for v in range(len(program.inputs))]
    for v, name in enumerate(names):
        lines += load(shape, base, f"{v}", stride, lane, name)
    code = llvm.body(scheduled(program), names, shape, "v")
    lines += [f"  {line}" for line in code.lines]
    good, raised = (f"{shape.real} {shape.constant(value)}" for value in (0.0, 1.0))
    flags = []
    for j, condition in enumerate(code.guards.values()):
        flags.append(f"%guard{j}")
        lines.append(f"  {flags[j]} = select {shape.boolean} {condition}, {good}, {raised}")
    return lines, code.outputs, flags


def load(shape: llvm.Shape, base: str, row: str, stride: str, lane: str, name: str) -> list[str]:
    """Return IR that loads lanes ``lane...`` of row ``row``."""
    return [
        *_address(base, row, stride, lane, name),
        f"  {name} = load {shape.real}, ptr {name}.p, align 8",
    ]


def store(
    shape: llvm.Shape, base: str, row: str, stride: str, lane: str, value: str, name: str
) -> list[str]:
    """Return IR that stores lanes ``lane...`` of row ``row``."""
    return [
        *_address(base, row, stride, lane, name),
        f"  store {shape.real} {value}, ptr {name}.p, align 8",
    ]


def _address(base: str, row: str, stride: str, lane: str, name: str) -> list[str]:
    return [
        f"  {name}.r = mul i64 {stride}, {row}",
        f"  {name}.i = add i64 {name}.r, {lane}",
        f"  {name}.p = getelementptr double, ptr {base}, i64 {name}.i",
    ]


def call_source(program: Program, carried: int, buffer: int) -> str:
    """Return IR of ``call()``: one evaluation on the buffer at an address.

    No argument is the least to hand over from Python. The buffer holds the inputs, then the
    outputs and a status for each guard. The last ``carried`` outputs go back to the last
    ``carried`` inputs: a state that is carried on.
    """
    shape = llvm.Shape(1)
    count = len(program.inputs)
    code, outputs, flags = _evaluation(program, shape, "%io", "1", "0")
    lines = ["define void @call() #0 {", f"  %io = inttoptr i64 {buffer} to ptr", *code]
    fresh = len(outputs) - carried
    values = [*outputs[:fresh], *flags, *outputs[fresh:]]
    rows = [*range(count, count + fresh + len(flags)), *range(count - carried, count)]
    for row, name in zip(rows, values, strict=True):
        lines += store(shape, "%io", f"{row}", "1", "0", name, f"%out{row}")
    return "\n".join([*llvm.declarations(shape), *lines, "  ret void", "}", llvm.ATTRIBUTES])


MAP_TYPES = (ctypes.c_void_p, ctypes.c_void_p, ctypes.c_int64, ctypes.c_int64, ctypes.c_int64)


class CompiledFunction:
    """A compiled function of records; every argument carries a leading batch axis."""

    def __init__(
        self, program: Program, result: Any, width: int, examples: tuple[Any, ...] = ()
    ) -> None:
        """Compile ``program``; ``result`` shows the shape of what it returns."""
        self.program, self.width = program, width
        self._result, self._examples = result, examples
        self._machine = llvm.machine(map_source(program, width), 2)
        self._map = self._machine.function("map", *MAP_TYPES)
        self.status: np.ndarray = np.zeros(0)

    def __call__(self, *arguments: Any) -> Any:
        """Evaluate on batched records; scalars are given as arrays over the batch."""
        rows = np.concatenate([_rows(a) for a in arguments])
        count = rows.shape[1]
        stride = -(-count // self.width) * self.width
        inputs = np.empty((rows.shape[0], stride))
        inputs[:, :count] = rows
        inputs[:, count:] = rows[:, -1:]
        flags = len(self.program.guards)
        outputs = np.empty((len(self.program.outputs) + flags, stride))
        self._map(inputs.ctypes.data, outputs.ctypes.data, stride, 0, stride)
        self.status = outputs[len(self.program.outputs) :, :count].astype(bool)
        return _unrows(self._result, iter(outputs[: len(self.program.outputs), :count]), count)

    def bound(self, count: int) -> Bound:
        """Return the function on fixed buffers for ``count`` records."""
        return Bound(self, count)


class Bound:
    """A compiled function on buffers of its own: a call from Python takes a microsecond.

    Fill `arguments`, call, read `result`: views of the buffers, with the batch axis last.

    Attributes:
        arguments: One view for each argument, shaped (*its shape, count).
        result: Views in the form of what the function returns.
        values: All of `result` as a flat buffer, in the order of `numbered`.
    """

    def __init__(self, function: CompiledFunction, count: int) -> None:
        """Make the buffers."""
        self._count = count
        program, stride = function.program, -(-count // function.width) * function.width
        self._in = np.zeros((len(program.inputs), stride))
        self._out = np.zeros((len(program.outputs) + len(program.guards), stride))
        self.arguments = _views(function._examples, self._in[:, :count])
        self.result = _views(function._result, self._out[:, :count])
        self.values = self._out.ravel()
        self._function = function  # keeps the machine code
        self._map = function._map
        self._call = (self._in.ctypes.data, self._out.ctypes.data, stride, 0, stride)

    def __call__(self) -> Any:
        """Evaluate and return `result`."""
        self._map(*self._call)
        return self.result

    def numbered(self) -> Any:
        """Return a record like `result` whose entries are their own places in `values`."""
        places = np.arange(self._out.size).reshape(self._out.shape)[:, : self._count]
        return _views(self._function._result, places)


def _views(like: Any, block: np.ndarray) -> Any:
    """Return a record of views of a buffer's rows, the lanes last."""
    at = 0

    def build(item: Any) -> Any:
        nonlocal at
        if isinstance(item, tuple):
            parts = [build(child) for child in item]
            return type(item)(*parts) if hasattr(item, "_fields") else tuple(parts)
        first, shape = at, np.shape(item)
        at += int(np.prod(shape))
        return block[first:at].reshape(*shape, block.shape[1]) if shape else block[first]

    return build(like)


def _rows(record: Any) -> np.ndarray:
    """Return a record of batched arrays as rows (value, run)."""
    if isinstance(record, (tuple, list)):
        parts = [_rows(r) for r in record]
        return np.concatenate(parts) if parts else np.empty((0, 0))
    array = np.asarray(record, float)
    return array.reshape(len(array), -1).T


def _unrows(like: Any, rows: Any, count: int) -> Any:
    if isinstance(like, tuple):
        parts = [_unrows(child, rows, count) for child in like]
        return type(like)(*parts) if hasattr(like, "_fields") else tuple(parts)
    values = [next(rows) for _ in tree.flatten(like)]
    if not isinstance(like, np.ndarray):
        return values[0]
    return (
        np.stack(values, axis=-1).reshape(count, *like.shape)
        if values
        else np.empty((count, *like.shape))
    )


def compile_function(
    function: Callable[..., Any], *examples: Any, width: int | None = None, fuse: bool | None = None
) -> CompiledFunction:
    """Trace and compile ``function``.

    Args:
        function: Source without data-dependent branches.
        *examples: Floats, arrays or tuples of them: the shape of each argument without batch axis.
        width: Lanes of a vector; the host's by default.
        fuse: Fuse multiply-adds; by default where the CPU has the instruction.

    Raises:
        TraceError: When the source decides by a value.
    """
    machine = llvm.host()
    program, result = trace(function, *examples, fuse=machine.fma if fuse is None else fuse)
    return CompiledFunction(program, result, width or machine.lanes, examples)
