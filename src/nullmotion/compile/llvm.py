"""Write programs as LLVM IR and turn IR into machine code for this CPU."""

from __future__ import annotations

import ctypes
import re
import struct
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from nullmotion.compile.operations import OPERATIONS
from nullmotion.compile.program import Program


@dataclass(frozen=True)
class Host:
    """What this machine's CPU offers.

    Attributes:
        cpu: LLVM's name of the CPU.
        features: LLVM's feature string.
        instruction_set: ``AVX-512``, ``AVX2``, ``SSE2``, ``NEON`` or ``scalar``.
        lanes: Doubles in one vector register.
        fma: Whether multiply-add in one rounding is an instruction.
    """

    cpu: str
    features: str
    instruction_set: str
    lanes: int
    fma: bool

    @property
    def batch_lanes(self) -> int:
        """Runs that advance together in a large batch: two vectors hide each other's latency."""
        return 2 * self.lanes if self.lanes > 1 else 1


@lru_cache(maxsize=1)
def host() -> Host:
    """Return what this machine's CPU offers."""
    import llvmlite.binding as llvm

    _initialize()
    flags = llvm.get_host_cpu_features()
    triple = llvm.get_default_triple()
    cpu, features = llvm.get_host_cpu_name(), flags.flatten()
    if triple.startswith(("aarch64", "arm64")):
        return Host(cpu, features, "NEON", 2, True)
    if flags.get("avx512f") and flags.get("avx512dq") and flags.get("avx512vl"):
        return Host(cpu, features, "AVX-512", 8, True)
    if flags.get("avx2"):
        return Host(cpu, features, "AVX2", 4, bool(flags.get("fma")))
    if triple.startswith("x86_64"):
        return Host(cpu, features, "SSE2", 2, bool(flags.get("fma")))
    return Host(cpu, features, "scalar", 1, False)


@lru_cache(maxsize=1)
def _initialize() -> None:
    import llvmlite.binding as llvm

    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    # the order of operations is ours (schedule.py); LLVM's own scheduler undoes it
    llvm.set_option("nullmotion", "-enable-misched=false")


def _target_machine(level: int) -> Any:
    """Return a new target machine (an engine takes it over and frees it)."""
    import llvmlite.binding as llvm

    target = llvm.Target.from_default_triple()
    machine = host()
    return target.create_target_machine(
        cpu=machine.cpu, features=machine.features, opt=level, jit=True
    )


def hexadecimal(value: float) -> str:
    """Return a double as LLVM writes it exactly."""
    return f"0x{struct.unpack('<Q', struct.pack('<d', value))[0]:016X}"


@dataclass(frozen=True)
class Shape:
    """The vector types of one instruction stream of ``width`` lanes."""

    width: int

    @property
    def real(self) -> str:
        """Type of a value."""
        return f"<{self.width} x double>"

    @property
    def integer(self) -> str:
        """Type of a value's bits."""
        return f"<{self.width} x i64>"

    @property
    def boolean(self) -> str:
        """Type of a comparison."""
        return f"<{self.width} x i1>"

    def splat(self, kind: str, text: str) -> str:
        """Return a constant vector of equal elements."""
        return "<" + ", ".join([f"{kind} {text}"] * self.width) + ">"

    def constant(self, value: float | bool) -> str:
        """Return a constant operand."""
        if isinstance(value, bool):
            return self.splat("i1", "true" if value else "false")
        return self.splat("double", hexadecimal(value))


_PLACEHOLDER = re.compile(r"\{(bits|real|mask|shift):([^}]+)\}")


@dataclass
class Body:
    """A program written as IR.

    Attributes:
        lines: Instructions, in order.
        early: Those among them that depend on early inputs alone; to be placed ahead.
        outputs: Name of each output.
        guards: Name of each flag's condition.
    """

    lines: list[str]
    early: list[str]
    outputs: list[str]
    guards: dict[str, str]


def body(
    program: Program, inputs: Sequence[str], shape: Shape, prefix: str, early: Collection[int] = ()
) -> Body:
    """Write a program as IR.

    Args:
        program: What to write.
        inputs: Name of each input.
        shape: Vector types.
        prefix: Begins the name of every value.
        early: Positions of inputs that are known before a loop; what follows from them alone
            is written apart, to be computed once.
    """
    names: dict[int, str] = dict(zip(program.inputs, inputs, strict=True))
    ahead = {program.inputs[i] for i in early}
    lines: list[str] = []
    before: list[str] = []
    for i, node in enumerate(program.nodes):
        if node.op == "constant":
            names[i] = shape.constant(node.value)  # type: ignore[arg-type]
            if early:
                ahead.add(i)
        elif node.op != "input":
            names[i] = f"%{prefix}{i}"
            known = bool(early) and all(a in ahead for a in node.args)
            if known:
                ahead.add(i)
            (before if known else lines).extend(_instruction(program, i, names, shape, prefix))
    guards = {flag: names[g] for flag, g in program.guards.items()}
    return Body(lines, before, [names[o] for o in program.outputs], guards)


def _instruction(
    program: Program, i: int, names: dict[int, str], shape: Shape, prefix: str
) -> list[str]:
    node = program.nodes[i]
    operands = dict(zip("abc", node.args, strict=False))

    def special(match: re.Match[str]) -> str:
        kind, text = match.groups()
        if kind == "shift":
            return shape.splat("i64", str(63 - int(program.nodes[operands[text]].value)))  # type: ignore[arg-type]
        if kind == "mask":
            return shape.splat("i64", str(1 << int(program.nodes[operands[text]].value)))  # type: ignore[arg-type]
        return (
            shape.splat("double", hexadecimal(float(text)))
            if kind == "real"
            else shape.splat("i64", text)
        )

    text = _PLACEHOLDER.sub(special, OPERATIONS[node.op].llvm)
    fields = {k: names[v] for k, v in operands.items()}
    temporaries = {f"t{j}": f"%{prefix}{i}.{j}" for j in range(6)}
    types = {
        "V": shape.real,
        "I": shape.integer,
        "B": shape.boolean,
        "true": shape.splat("i1", "true"),
    }
    return text.format(
        r=names[i], sfx=f"v{shape.width}f64", **fields, **temporaries, **types
    ).splitlines()


def declarations(shape: Shape) -> list[str]:
    """Return the intrinsics that programs of this shape may call."""
    v, suffix = shape.real, f"v{shape.width}f64"
    arity = {"sqrt": 1, "fabs": 1, "rint": 1, "copysign": 2, "fma": 3}
    return [f"declare {v} @llvm.{name}.{suffix}({', '.join([v] * n)})" for name, n in arity.items()]


ATTRIBUTES = (
    "attributes #0 = { nounwind alignstack=64 "
    '"prefer-vector-width"="512" "min-legal-vector-width"="512" }'
)


@lru_cache(maxsize=64)
def machine(source: str, level: int = 2) -> Machine:
    """Return the machine code of a module; the same text is compiled once."""
    return Machine(source, level)


class Machine:
    """Machine code made from an IR module; keeps it alive."""

    def __init__(self, source: str, level: int = 2) -> None:
        """Compile a module's text at the given code generation level."""
        import llvmlite.binding as llvm

        _initialize()
        target = _target_machine(level)
        module = llvm.parse_assembly(source)
        module.triple = llvm.get_default_triple()
        module.data_layout = str(target.target_data)
        self._engine = llvm.create_mcjit_compiler(module, target)
        self._engine.finalize_object()
        self._target, self._module = target, module

    def function(self, name: str, *argument_types: Any, brief: bool = False) -> Any:
        """Return a compiled function, callable from Python.

        It releases the GIL, unless it is so brief that this would cost more than it gives.
        """
        address = self._engine.get_function_address(name)
        kind: Any = ctypes.PYFUNCTYPE if brief else ctypes.CFUNCTYPE
        function: Any = kind(None, *argument_types)(address)
        function.owner = self  # the code must outlive the function
        return function

    def assembly(self) -> str:
        """Return the machine code as text."""
        return str(self._target.emit_assembly(self._module))
