"""Machine code of a whole time loop over a batch of runs."""

from __future__ import annotations

import ctypes

import numpy as np

from nullmotion.compile import llvm
from nullmotion.compile.loop import Loop
from nullmotion.compile.loop_ir import LoopWriter
from nullmotion.compile.loop_trace import cut, trace_loop

_WIDE = 2500  # operations of a step; above, two vectors spill: design/vector_width.py
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
        traced = trace_loop(loop, recording, machine.fma)
        self.traced = traced
        self.operations = sum(
            cut(p.program, range(len(p.program.inputs)), traced.live).operations
            for p in traced.pieces
        )
        wide = machine.batch_lanes if self.operations <= _WIDE else machine.lanes
        self.width = width or wide
        writer = LoopWriter(loop, traced, self.width)
        self.source = writer.source()
        self._machine = llvm.machine(self.source, level)
        self._run = self._machine.function("loop", *LOOP_TYPES)
        self.carried = writer.carried
        self.flags = traced.flags
        self.outputs = len(traced.outputs.outputs)
        self.records = sum(p.records for p in traced.pieces)

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
