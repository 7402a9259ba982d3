"""Write a traced loop as LLVM IR: the state of one vector of runs stays in registers."""

from __future__ import annotations

from collections.abc import Sequence

from nullmotion import tree
from nullmotion.compile import llvm
from nullmotion.compile.function import load, store
from nullmotion.compile.loop import Loop
from nullmotion.compile.loop_trace import LoopTrace, Piece, cut
from nullmotion.compile.program import Program
from nullmotion.compile.schedule import scheduled


class LoopWriter:
    """Writes the kernel of a traced loop."""

    def __init__(self, loop: Loop, traced: LoopTrace, width: int) -> None:
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
            cut(self.traced.start, range(self.parameters), self.traced.live), names, "b"
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
        self, index: int, piece: Piece, current: list[str], row: list[str], base: int
    ) -> list[str]:
        live = self.traced.live
        others = range(self.size, self.size + self.parameters + 1 + self.loop.row + self.extra)
        outputs = [*live, *range(self.size, self.size + piece.records + self.extra)]
        program = scheduled(cut(piece.program, [*live, *others], outputs))
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
        return self._body(cut(program, inputs, range(len(program.outputs))), names, prefix)[0]

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
