"""The one table of tape operations.

Each entry knows an operation whole: what it takes and gives, what it means on
NumPy floats, and how it is written for each target. A new target adds a field
here; a new operation adds a row.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Literal

import numpy as np

Kind = Literal["real", "bool"]

_MAGIC = 1.5 * 2.0**52  # adding it leaves an integer's two's complement in the low bits
_BIAS = 1023.0


@dataclass(frozen=True)
class Operation:
    """One tape operation.

    Attributes:
        name: Key on the tape.
        operands: Kinds of the operands.
        result: Kind of the result.
        evaluate: Meaning on NumPy float64/bool values; defines the operation.
        llvm: Lines of LLVM IR. ``{r}`` result, ``{a} {b} {c}`` operands,
            ``{V} {I} {B}`` the vector types, ``{t0}``... temporaries,
            ``{sfx}`` the intrinsic suffix, ``{bits:N}`` an integer splat.
        c: C99 expression with the same operands.
        commutative: Operands may be swapped without changing the result.
    """

    name: str
    operands: tuple[Kind, ...]
    result: Kind
    evaluate: Callable[..., Any]
    llvm: str
    c: str
    commutative: bool = False


def exact_fma(a: Any, b: Any, c: Any) -> Any:
    """Return a*b + c rounded once (exact rational arithmetic; for folding and tests)."""
    if np.ndim(a) or np.ndim(b) or np.ndim(c):
        return np.vectorize(exact_fma, otypes=[float])(a, b, c)
    if not (np.isfinite(a) and np.isfinite(b)):
        return np.float64(a) * np.float64(b) + np.float64(c)
    if not np.isfinite(c):
        return np.float64(c)  # a*b itself may overflow: it must not cancel an infinite c
    exact = Fraction(float(a)) * Fraction(float(b)) + Fraction(float(c))
    if exact == 0:
        return np.float64(a) * np.float64(b) + np.float64(c)
    try:
        return np.float64(float(exact))
    except OverflowError:
        return np.float64(np.inf if exact > 0 else -np.inf)


def _exponent(a: Any) -> Any:
    raw = np.asarray(a, float).view(np.int64)
    return np.float64(1.0) * (((raw >> 52) & 2047) - 1023)


def _significand(a: Any) -> Any:
    raw = np.asarray(a, float).view(np.uint64)
    kept = (raw & np.uint64(0x800FFFFFFFFFFFFF)) | np.uint64(0x3FF0000000000000)
    return kept.view(np.float64)[()]


def _power_of_two(a: Any) -> Any:
    raw = (np.asarray(a, float) + (2.0**52 + _BIAS)).view(np.uint64)
    return (raw << np.uint64(52)).view(np.float64)[()]


def _bit(a: Any, j: Any) -> Any:
    raw = (np.asarray(a, float) + _MAGIC).view(np.int64)
    return ((raw >> np.asarray(j, float).astype(np.int64)) & 1).astype(bool)[()]


def _raw_bit(a: Any, j: Any) -> Any:
    return ((np.asarray(a, float).view(np.int64) >> np.int64(j)) & 1).astype(bool)[()]


def _flip(a: Any, b: Any, j: Any) -> Any:
    sign = np.asarray(b, float).view(np.uint64) << np.uint64(63 - int(j)) & np.uint64(1 << 63)
    return (np.asarray(a, float).view(np.uint64) ^ sign).view(np.float64)[()]


_RSQRT_MAGIC = 0x5FE6EB50C7B537A9  # halves the exponent: within 3.5 % of 1/sqrt


def _rsqrt_guess(a: Any) -> Any:
    raw = np.asarray(a, float).view(np.uint64)
    return (np.uint64(_RSQRT_MAGIC) - (raw >> np.uint64(1))).view(np.float64)[()]


def _binary(
    name: str, evaluate: Callable[..., Any], llvm: str, c: str, commutative: bool = False
) -> Operation:
    return Operation(
        name,
        ("real", "real"),
        "real",
        evaluate,
        f"{{r}} = {llvm} {{V}} {{a}}, {{b}}",
        c,
        commutative,
    )


def _compare(name: str, evaluate: Callable[..., Any], predicate: str, c: str) -> Operation:
    line = f"{{r}} = fcmp {predicate} {{V}} {{a}}, {{b}}"
    return Operation(name, ("real", "real"), "bool", evaluate, line, c, name == "equal")


def _logic(name: str, evaluate: Callable[..., Any], llvm: str, c: str) -> Operation:
    return Operation(
        name, ("bool", "bool"), "bool", evaluate, f"{{r}} = {llvm} {{B}} {{a}}, {{b}}", c, True
    )


def _unary(name: str, evaluate: Callable[..., Any], llvm: str, c: str) -> Operation:
    return Operation(name, ("real",), "real", evaluate, llvm, c)


def _intrinsic(name: str, evaluate: Callable[..., Any], c: str, arity: int = 1) -> Operation:
    args = ", ".join(f"{{V}} {{{x}}}" for x in "abc"[:arity])
    llvm = f"{{r}} = call {{V}} @llvm.{name}.{{sfx}}({args})"
    real: Kind = "real"
    return Operation(name, (real,) * arity, real, evaluate, llvm, c)


_TABLE = (
    _binary("add", np.add, "fadd", "({a} + {b})", commutative=True),
    _binary("sub", np.subtract, "fsub", "({a} - {b})"),
    _binary("mul", np.multiply, "fmul", "({a} * {b})", commutative=True),
    # a product that must be rounded before it is used: error-free transformations need it
    _binary("product", np.multiply, "fmul", "({a} * {b})", commutative=True),
    _binary("div", np.divide, "fdiv", "({a} / {b})"),
    _unary("neg", np.negative, "{r} = fneg {V} {a}", "(-{a})"),
    _intrinsic("sqrt", np.sqrt, "sqrt({a})"),
    _intrinsic("fabs", np.abs, "fabs({a})"),
    _intrinsic("rint", np.rint, "rint({a})"),
    _intrinsic("copysign", np.copysign, "copysign({a}, {b})", 2),
    _intrinsic("fma", exact_fma, "fma({a}, {b}, {c})", 3),
    _compare("less", np.less, "olt", "({a} < {b})"),
    _compare("less_equal", np.less_equal, "ole", "({a} <= {b})"),
    _compare("equal", np.equal, "oeq", "({a} == {b})"),
    _logic("and", np.logical_and, "and", "({a} && {b})"),
    _logic("or", np.logical_or, "or", "({a} || {b})"),
    Operation("not", ("bool",), "bool", np.logical_not, "{r} = xor {B} {a}, {true}", "(!{a})"),
    Operation(
        "select",
        ("bool", "real", "real"),
        "real",
        np.where,
        "{r} = select {B} {a}, {V} {b}, {V} {c}",
        "({a} ? {b} : {c})",
    ),
    _unary(
        "exponent",
        _exponent,
        "{t0} = bitcast {V} {a} to {I}\n"
        "{t1} = lshr {I} {t0}, {bits:52}\n"
        "{t2} = and {I} {t1}, {bits:2047}\n"
        f"{{t3}} = or {{I}} {{t2}}, {{bits:{0x4330000000000000}}}\n"
        "{t4} = bitcast {I} {t3} to {V}\n"
        f"{{r}} = fsub {{V}} {{t4}}, {{real:{2.0**52 + _BIAS!r}}}",
        "nm_exponent({a})",
    ),
    _unary(
        "significand",
        _significand,
        "{t0} = bitcast {V} {a} to {I}\n"
        f"{{t1}} = and {{I}} {{t0}}, {{bits:{0x800FFFFFFFFFFFFF}}}\n"
        f"{{t2}} = or {{I}} {{t1}}, {{bits:{0x3FF0000000000000}}}\n"
        "{r} = bitcast {I} {t2} to {V}",
        "nm_significand({a})",
    ),
    _unary(
        "power_of_two",
        _power_of_two,
        f"{{t0}} = fadd {{V}} {{a}}, {{real:{2.0**52 + _BIAS!r}}}\n"
        "{t1} = bitcast {V} {t0} to {I}\n"
        "{t2} = shl {I} {t1}, {bits:52}\n"
        "{r} = bitcast {I} {t2} to {V}",
        "nm_power_of_two({a})",
    ),
    Operation(
        "bit",
        ("real", "real"),
        "bool",
        _bit,
        f"{{t0}} = fadd {{V}} {{a}}, {{real:{_MAGIC!r}}}\n"
        "{t1} = bitcast {V} {t0} to {I}\n"
        "{t2} = and {I} {t1}, {mask:b}\n"
        "{r} = icmp ne {I} {t2}, {bits:0}",
        "nm_bit({a}, {b})",
    ),
    Operation(
        "raw_bit",
        ("real", "real"),
        "bool",
        _raw_bit,
        "{t0} = bitcast {V} {a} to {I}\n"
        "{t1} = and {I} {t0}, {mask:b}\n"
        "{r} = icmp ne {I} {t1}, {bits:0}",
        "nm_raw_bit({a}, {b})",
    ),
    Operation(
        "flip",
        ("real", "real", "real"),
        "real",
        _flip,
        "{t0} = bitcast {V} {b} to {I}\n"
        "{t1} = shl {I} {t0}, {shift:c}\n"
        f"{{t2}} = and {{I}} {{t1}}, {{bits:{1 << 63}}}\n"
        "{t3} = bitcast {V} {a} to {I}\n"
        "{t4} = xor {I} {t3}, {t2}\n"
        "{r} = bitcast {I} {t4} to {V}",
        "nm_flip({a}, {b}, {c})",
    ),
    _unary(
        "rsqrt_guess",
        _rsqrt_guess,
        "{t0} = bitcast {V} {a} to {I}\n"
        "{t1} = lshr {I} {t0}, {bits:1}\n"
        f"{{t2}} = sub {{I}} {{bits:{_RSQRT_MAGIC}}}, {{t1}}\n"
        "{r} = bitcast {I} {t2} to {V}",
        "nm_rsqrt_guess({a})",
    ),
)

OPERATIONS: dict[str, Operation] = {entry.name: entry for entry in _TABLE}
