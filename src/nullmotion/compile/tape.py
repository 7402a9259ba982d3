"""Symbols that record what is done to them, and the tape they record on.

Plain source over NumPy object arrays of `Symbol` runs once and leaves a flat
list of operations. Equal expressions are recorded once, constants are folded
as they appear, and `Tape.program` drops what no output needs.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from nullmotion.compile.folding import RULES
from nullmotion.compile.operations import OPERATIONS, Kind
from nullmotion.compile.places import user_frame
from nullmotion.errors import TraceError


@dataclass(frozen=True)
class Node:
    """One recorded operation; ``value`` is set for constants and input names."""

    op: str
    args: tuple[int, ...] = ()
    value: float | str | None = None

    @property
    def kind(self) -> str:
        """Kind of the node's value, ``real`` or ``bool``."""
        if self.op == "constant":
            return "bool" if isinstance(self.value, bool) else "real"
        return "real" if self.op == "input" else OPERATIONS[self.op].result


@dataclass
class Tape:
    """A growing list of operations; every `Symbol` belongs to one.

    Attributes:
        nodes: The operations; operands come first.
        guards: For each status flag, the conditions that must hold.
        functions: For the result of an elementary function, its name and its arguments.
    """

    nodes: list[Node] = field(default_factory=list)
    guards: dict[str, list[int]] = field(default_factory=dict)
    functions: dict[int, tuple[str, tuple[int, ...]]] = field(default_factory=dict)
    _index: dict[tuple[Any, ...], int] = field(default_factory=dict)

    def input(self, name: str) -> Symbol:
        """Record a new input."""
        self.nodes.append(Node("input", value=name))
        return Symbol(self, len(self.nodes) - 1)

    def inputs(self, name: str, count: int) -> np.ndarray:
        """Record ``count`` inputs as an object array."""
        out = np.empty(count, dtype=object)
        out[:] = [self.input(f"{name}[{i}]") for i in range(count)]
        return out

    def constant(self, value: float | bool | np.number | np.bool_) -> int:
        """Return the node of a constant; equal bits share one node."""
        plain = bool(value) if isinstance(value, (bool, np.bool_)) else float(value)
        key = ("constant", type(plain), repr(plain))
        if key not in self._index:
            self.nodes.append(Node("constant", value=plain))
            self._index[key] = len(self.nodes) - 1
        return self._index[key]

    def record(self, op: str, *args: int) -> int:
        """Return the node of ``op(args)``, recorded once and simplified."""
        operands = OPERATIONS[op].operands
        args = tuple(self._as(kind, a) for kind, a in zip(operands, args, strict=True))
        folded = self._fold(op, args)
        if folded is not None:
            return folded
        if OPERATIONS[op].commutative and args[0] > args[1]:
            args = (args[1], args[0])
        key = (op, *args)
        if key not in self._index:
            self.nodes.append(Node(op, args))
            self._index[key] = len(self.nodes) - 1
        return self._index[key]

    def _as(self, kind: Kind, node: int) -> int:
        """Return a node of the kind that an operation takes: a truth counts as 1 or 0."""
        if self.nodes[node].kind == kind:
            return node
        if kind == "real":
            return self.record("select", node, self.constant(1.0), self.constant(0.0))
        raise TraceError("this line takes a number for a condition; compare it", *user_frame())

    def _fold(self, op: str, args: tuple[int, ...]) -> int | None:
        nodes = [self.nodes[i] for i in args]
        if all(n.op == "constant" for n in nodes):
            with np.errstate(all="ignore"):
                value: Any = OPERATIONS[op].evaluate(*[n.value for n in nodes])
            return self.constant(np.asarray(value).item())
        rule = RULES.get(op)
        known = [n.value if n.op == "constant" else None for n in nodes]
        return rule(self, args, known) if rule else None

    def guard(self, flag: str, condition: int) -> None:
        """Remember that ``condition`` must hold, or the status ``flag`` is raised."""
        known = self.guards.setdefault(flag, [])
        if condition not in known:
            known.append(condition)

    def remember(self, function: str, args: tuple[int, ...], result: int) -> None:
        """Keep in mind that a node is an elementary function of others: its derivative is known."""
        if all(a < result for a in args):
            self.functions.setdefault(result, (function, args))


class Symbol:
    """A real or boolean value that is not known yet."""

    __slots__ = ("node", "tape")

    def __init__(self, tape: Tape, node: int) -> None:
        """Refer to ``node`` of ``tape``."""
        self.tape, self.node = tape, node

    @property
    def kind(self) -> str:
        """``real`` or ``bool``."""
        return self.tape.nodes[self.node].kind

    def _apply(self, op: str, *others: Any) -> Any:
        args = [self.node]
        for other in others:
            if isinstance(other, Symbol):
                args.append(other.node)
            elif isinstance(other, (float, int, bool, np.number, np.bool_)):
                args.append(self.tape.constant(other))
            else:
                return NotImplemented
        return Symbol(self.tape, self.tape.record(op, *args))

    def _reflected(self, op: str, other: Any) -> Any:
        if isinstance(other, (float, int, np.number)):
            return Symbol(self.tape, self.tape.record(op, self.tape.constant(other), self.node))
        return NotImplemented

    def __add__(self, other: Any) -> Any:
        return self._apply("add", other)

    __radd__ = __add__

    def __sub__(self, other: Any) -> Any:
        return self._apply("sub", other)

    def __rsub__(self, other: Any) -> Any:
        return self._reflected("sub", other)

    def __mul__(self, other: Any) -> Any:
        return self._apply("mul", other)

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> Any:
        return self._apply("div", other)

    def __rtruediv__(self, other: Any) -> Any:
        return self._reflected("div", other)

    def __neg__(self) -> Symbol:
        return self._apply("neg")

    def __pos__(self) -> Symbol:
        return self

    def __abs__(self) -> Symbol:
        return self._apply("fabs")

    def __pow__(self, power: Any) -> Any:
        return integer_power(self, power)

    def __eq__(self, other: object) -> Any:
        return self._apply("equal", other)

    def __ne__(self, other: object) -> Any:
        same = self._apply("equal", other)
        return same if same is NotImplemented else ~same

    __hash__ = object.__hash__

    def __lt__(self, other: Any) -> Any:
        return self._apply("less", other)

    def __le__(self, other: Any) -> Any:
        return self._apply("less_equal", other)

    def __gt__(self, other: Any) -> Any:
        return self._reflected_compare("less", other)

    def __ge__(self, other: Any) -> Any:
        return self._reflected_compare("less_equal", other)

    def _reflected_compare(self, op: str, other: Any) -> Any:
        if isinstance(other, Symbol):
            return other._apply(op, self)
        return self._reflected(op, other)

    def __and__(self, other: Any) -> Any:
        return self._apply("and", other)

    __rand__ = __and__

    def __or__(self, other: Any) -> Any:
        return self._apply("or", other)

    __ror__ = __or__

    def __invert__(self) -> Symbol:
        return self._apply("not")

    def __bool__(self) -> bool:
        file, line = user_frame()
        raise TraceError(
            "this line decides by a value that is not known while the source is traced; "
            "use nullmotion.ops.where, minimum, maximum, clip or sign "
            "instead of if, and, or, min, max",
            file,
            line,
        )

    def __float__(self) -> float:
        node = self.tape.nodes[self.node]
        if node.op == "constant":
            return float(node.value)  # type: ignore[arg-type]
        file, line = user_frame()
        raise TraceError(
            "this line needs the number behind a value that is still a symbol", file, line
        )

    def __repr__(self) -> str:
        node = self.tape.nodes[self.node]
        return f"Symbol({node.op}{node.value if node.value is not None else list(node.args)})"

    # NumPy calls these on the elements of object arrays: np.sin(x) -> x.sin()
    def sqrt(self) -> Symbol:
        return self._apply("sqrt")

    def rint(self) -> Symbol:
        return self._apply("rint")

    def sin(self) -> Symbol:
        return _elementary("sin", self)

    def cos(self) -> Symbol:
        return _elementary("cos", self)

    def exp(self) -> Symbol:
        return _elementary("exp", self)

    def log(self) -> Symbol:
        return _elementary("log", self)

    def arccos(self) -> Symbol:
        return _elementary("acos", self)

    def arctan2(self, other: Any) -> Symbol:
        return _elementary("atan2", self, other)


def _elementary(name: str, *args: Any) -> Symbol:
    from nullmotion.compile import elementary

    return getattr(elementary, name)(*args)


def integer_power(x: Any, power: Any) -> Any:
    """Return x**power by repeated squaring; x**0.5 is the square root."""
    if power == 0.5:
        return x.sqrt()
    if power != int(power):
        raise TraceError(f"power {power}: use nullmotion.ops.power for powers that are not whole")
    if power < 0:
        return 1.0 / integer_power(x, -power)
    result, base, n = None, x, int(power)
    while n:
        if n & 1:
            result = base if result is None else result * base
        n >>= 1
        base = base * base if n else base
    return 1.0 if result is None else result


def apply(op: str, *args: Any) -> Any:
    """Record ``op`` on the tape of its symbolic operands, or evaluate it on floats."""
    tape = next((a.tape for a in args if isinstance(a, Symbol)), None)
    if tape is None:
        return OPERATIONS[op].evaluate(*args)
    ids = [a.node if isinstance(a, Symbol) else tape.constant(a) for a in args]
    return Symbol(tape, tape.record(op, *ids))


def fma(a: Any, b: Any, c: Any) -> Any:
    """Return a*b + c, rounded once."""
    return apply("fma", a, b, c)


def product(a: Any, b: Any) -> Any:
    """Return a*b, rounded: never fused with a sum that uses it."""
    return apply("product", a, b)


def sqrt(a: Any) -> Any:
    """Return the square root."""
    return apply("sqrt", a)


def rint(a: Any) -> Any:
    """Return the nearest whole number, ties to even."""
    return apply("rint", a)


def copysign(a: Any, b: Any) -> Any:
    """Return |a| with the sign of b."""
    return apply("copysign", a, b)


def equal(a: Any, b: Any) -> Any:
    """Return a == b as a boolean."""
    return apply("equal", a, b)


def select(condition: Any, a: Any, b: Any) -> Any:
    """Return a where the condition holds, else b (reals or booleans)."""
    if _is_boolean(a) and _is_boolean(b):
        return apply("or", apply("and", condition, a), apply("and", apply("not", condition), b))
    return apply("select", condition, a, b)


def _is_boolean(value: Any) -> bool:
    return isinstance(value, (bool, np.bool_)) or getattr(value, "kind", None) == "bool"


def minimum(a: Any, b: Any) -> Any:
    """Return a if a < b else b (b when either is NaN)."""
    return select(apply("less", a, b), a, b)


def maximum(a: Any, b: Any) -> Any:
    """Return a if a > b else b (b when either is NaN)."""
    return select(apply("less", b, a), a, b)


def exponent(a: Any) -> Any:
    """Return floor(log2 |a|) of a normal number."""
    return apply("exponent", a)


def significand(a: Any) -> Any:
    """Return a scaled by a power of two into [1, 2) in magnitude."""
    return apply("significand", a)


def power_of_two(k: Any) -> Any:
    """Return 2.0**k for whole k in [-1022, 1023]."""
    return apply("power_of_two", k)


def bit(k: Any, j: int) -> Any:
    """Return bit j of the two's complement of a whole number |k| < 2**31."""
    return apply("bit", k, float(j))


def raw_bit(a: Any, j: int) -> Any:
    """Return bit j of a double's 64 bits."""
    return apply("raw_bit", a, float(j))


def flip(a: Any, b: Any, j: int) -> Any:
    """Return a with its sign flipped where bit j of b's 64 bits is set."""
    return apply("flip", a, b, float(j))


def rsqrt_guess(a: Any) -> Any:
    """Return 1/sqrt(a) within 3.5 %, from the bits of a normal positive number."""
    return apply("rsqrt_guess", a)


def is_odd(k: Any) -> Any:
    """Return whether a whole number is odd."""
    return bit(k, 0)


_guarding = [True]


@contextmanager
def unguarded() -> Iterator[None]:
    """Record no guards inside, where arguments are known to lie between guarded ones."""
    before, _guarding[0] = _guarding[0], False
    try:
        yield
    finally:
        _guarding[0] = before


def guard(flag: str, condition: Any) -> None:
    """Ask that ``condition`` holds wherever it is evaluated; a kernel reports ``flag`` if not."""
    if _guarding[0] and isinstance(condition, Symbol):
        condition.tape.guard(flag, condition.node)
