"""The blocks of an allocation, and the nearest singular line, as machine code.

Built in NumPy they would take most of a sample's time. The source is compiled once for each
shape, unless that is large; numbers are inputs.
"""

from __future__ import annotations

import threading
from typing import Any, NamedTuple

import numpy as np

from nullmotion import singular_lines, tree
from nullmotion.allocation.blocks import Blocks, blocks
from nullmotion.array.model import CmgArray
from nullmotion.compile import llvm
from nullmotion.compile.function import call_source
from nullmotion.compile.program import trace

_LARGEST = 1500  # N n^2 m from which compiling takes seconds and NumPy's overhead is small
_kernels = threading.local()  # a kernel's buffers serve one thread


class Shape(NamedTuple):
    """What a kernel is made for: CMGs, torque dimensions, moves, and whether lines are exact."""

    n: int
    m: int
    N: int
    midpoint: bool
    lines: bool


def evaluate(
    array: CmgArray, delta: Any, plan: Any, wanted: Any, weight: Any, period: float, midpoint: bool
) -> tuple[Blocks, Any]:
    """Return the blocks, and the square of the distance and delta - delta_s of the nearest line.

    Args:
        array: The array.
        delta: Gimbal angles [rad], (n,).
        plan: Rates planned before [rad/s], (N, n).
        wanted: hdot_c [N m], (N, m).
        weight: Diagonal of H, one number or (m,).
        period: Length of a move [s].
        midpoint: See `blocks`.

    Returns:
        Both as views of buffers that the next call overwrites; None instead of the line where it
        was not looked for.
    """
    shape = Shape(array.n, array.m, len(plan), midpoint, singular_lines.lies_in_a_plane(array))
    if shape.N * shape.n**2 * shape.m > _LARGEST:
        weights = np.broadcast_to(np.asarray(weight, float), array.m)
        spin, transverse = _axes(array)
        over = wanted / array.mean_momentum
        return blocks(spin, transverse, delta, plan, over, weights, period, midpoint), None
    known: dict[Shape, _Kernel] = _kernels.__dict__.setdefault("by_shape", {})
    kernel = known.get(shape)
    if kernel is None:
        kernel = known[shape] = _Kernel(shape)
    return kernel(array, delta, plan, wanted, weight, period)


class _Kernel:
    """One compiled shape with its buffers."""

    def __init__(self, shape: Shape) -> None:
        self._shape = shape
        self._array: CmgArray | None = None
        n, m, N = shape.n, shape.m, shape.N
        sizes = ((n, m), (n, m), (n,), (n,), (n,), (N, n), (N, m), (m,), ())
        examples = [np.zeros(size) if size else 0.0 for size in sizes]
        program, result = trace(self._source, *examples, fuse=llvm.host().fma)
        ends = np.cumsum([0, *(int(np.prod(size)) for size in sizes)]).tolist()
        count, flags = len(tree.flatten(result)), len(program.guards)
        io = np.zeros(ends[-1] + count + flags)
        self._in = [io[a:b].reshape(s) for a, b, s in zip(ends, ends[1:], sizes, strict=False)]
        self._out = _views(result, io[ends[-1] : ends[-1] + count])
        self._raised = io[ends[-1] + count :]
        machine = llvm.Machine(call_source(program, 0, io.ctypes.data), 1)
        self._run = machine.function("call", brief=True)

    def __call__(
        self, array: CmgArray, delta: Any, plan: Any, wanted: Any, weight: Any, period: float
    ) -> tuple[Blocks, Any]:
        if array is not self._array:
            self._take(array)
        values = delta, plan, wanted * self._scale, weight, period
        for place, value in zip(self._in[4:], values, strict=True):
            place[...] = value
        self._run()
        return self._source(*self._in) if self._raised.any() else self._out  # angles too large

    def _source(self, *values: Any) -> Any:
        spin, transverse, phase, sense, delta, plan, wanted, weight, period = values
        middle = self._shape.midpoint
        found = blocks(spin, transverse, delta, plan, wanted, weight, period, middle)
        if not self._shape.lines:
            return found, None
        square, vector = singular_lines.offset(phase + sense * delta)
        return found, (square, sense * vector)

    def _take(self, array: CmgArray) -> None:
        self._in[0][...], self._in[1][...] = _axes(array)
        if self._shape.lines:
            self._in[2][...], self._in[3][...] = singular_lines.frame(array)
        self._array, self._scale = array, 1.0 / float(array.mean_momentum)


def _axes(array: CmgArray) -> tuple[np.ndarray, np.ndarray]:
    """Return rotor momenta and columns of A at delta = 0 over the mean momentum, (n, m) each."""
    zero = np.zeros(array.n)
    return array.rotor_momenta(zero) / array.mean_momentum, array.unit_jacobian(zero).T


def _views(like: Any, flat: np.ndarray) -> Any:
    """Return views of a buffer in the shape of a traced result."""
    at = 0

    def build(item: Any) -> Any:
        nonlocal at
        if isinstance(item, tuple):
            parts = [build(child) for child in item]
            return type(item)(*parts) if hasattr(item, "_fields") else tuple(parts)
        if item is None:
            return None
        at += np.size(item)
        return flat[at - np.size(item) : at].reshape(np.shape(item))

    return build(like)
