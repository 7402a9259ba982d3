"""Loader of the hand-written C reference: compiles reference.c with the system's C compiler.

``run(law, q, omega, delta, steps, width)`` with width 8 (AVX-512), 4 (AVX2) or 1 (the scalar
build of the same source: auto-vectorisation off). Libraries are cached in the temporary folder
under a name that holds a digest of source, flags and CPU.
"""

from __future__ import annotations

import ctypes
import functools
import hashlib
import os
import platform
import shutil
import subprocess
import tempfile
from pathlib import Path

import numpy as np
from workload import Array, Batch

HERE = Path(__file__).parent
SYMBOL = {"sr": "reference_sr", "sr+gradient": "reference_gradient", "svd": "reference_svd"}
TILE = {  # vectors that advance together: the fastest measured, per width and law
    8: {"sr": 1, "sr+gradient": 1, "svd": 3},
    4: {"sr": 2, "sr+gradient": 2, "svd": 3},
    1: {"sr": 3, "sr+gradient": 2, "svd": 3},
}
EXACT = ("-DEXACT_RSQRT",)  # IEEE square root and division where v_rsqrt, v_reciprocal are used
FLAGS = ("-O3", "-march=native", "-fno-math-errno", "-ffp-contract=fast", "-shared", "-fPIC")
SCHEDULING = ("-fschedule-insns", "-fsched-pressure")  # GCC only: +15 % for the sr laws
SCALAR = ("-fno-tree-vectorize", "-fno-tree-slp-vectorize")
DOUBLES = ctypes.POINTER(ctypes.c_double)


class NoCompilerError(RuntimeError):
    """No C compiler, or none that takes the source."""


def cpu_flags() -> frozenset[str]:
    """Instruction sets of this CPU, as Linux names them."""
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        return frozenset()
    return frozenset(next((x.split() for x in lines if x.startswith("flags")), []))


def native_width() -> int:
    """Doubles per vector that this CPU can do: 8, 4 or 1."""
    flags = cpu_flags()
    if {"avx512f", "avx512dq"} <= flags:
        return 8
    return 4 if {"avx2", "fma"} <= flags else 1


def compiler() -> str:
    """The C compiler: $CC, gcc or cc."""
    for name in (os.environ.get("CC"), "gcc", "cc"):
        if name and shutil.which(name):
            return name
    raise NoCompilerError("no C compiler found (looked for $CC, gcc, cc)")


def command(width: int, tile: int, extra: tuple[str, ...] = ()) -> list[str]:
    """The compiler's command line, less the output."""
    flags = [*FLAGS, *(SCALAR if width == 1 else SCHEDULING), *extra]
    return [compiler(), *flags, f"-DW={width}", f"-DTILE={tile}", str(HERE / "reference.c")]


@functools.cache
def library(width: int, tile: int, extra: tuple[str, ...] = ()) -> ctypes.CDLL:
    """Compile (once) and load."""
    parts = command(width, tile, extra)
    text = b"".join(p.read_bytes() for p in sorted(HERE.glob("*.[ch]")))
    identity = " ".join([*parts, platform.processor(), *sorted(cpu_flags())]).encode()
    digest = hashlib.sha256(text + identity).hexdigest()[:16]
    cache = Path(tempfile.gettempdir()) / "nullmotion-closed-loop"
    cache.mkdir(exist_ok=True)
    path = cache / f"reference-{digest}.so"
    if not path.exists():
        partial = path.with_suffix(f".{os.getpid()}")
        done = subprocess.run(
            [*parts, "-o", str(partial), "-lm"], capture_output=True, text=True, check=False
        )
        if done.returncode:
            raise NoCompilerError(done.stderr)
        partial.rename(path)
    return ctypes.CDLL(str(path))


def padded(rows: Array, lanes: int) -> Array:
    """A contiguous copy whose run axis is a multiple of ``lanes`` (the last run repeated)."""
    missing = -rows.shape[1] % lanes
    return np.ascontiguousarray(np.pad(rows, ((0, 0), (0, missing)), mode="edge"))


def run(
    law: str,
    q: Array,
    omega: Array,
    delta: Array,
    steps: int,
    width: int = 0,
    extra: tuple[str, ...] = (),
) -> Batch:
    """Final states after ``steps`` steps; width 0 is the CPU's own, ``extra`` compiler flags."""
    width = width or native_width()
    tile = TILE[width][law]
    lib, n = library(width, tile, extra), q.shape[1]
    state = [padded(x, tile * width) for x in (q, omega, delta)]
    pointers = [x.ctypes.data_as(DOUBLES) for x in state]
    size = ctypes.c_long(state[0].shape[1])
    getattr(lib, SYMBOL[law])(*pointers, size, ctypes.c_long(steps))
    return Batch(*(x[:, :n] for x in state))


def elementary(name: str, x: Array, width: int = 0) -> tuple[Array, ...]:
    """``sincos`` or ``exp`` of the reference, for accuracy checks."""
    width = width or native_width()
    lib = library(width, 1)
    flat = padded(x.reshape(1, -1), width)
    out = [np.empty_like(flat) for _ in range(2 if name == "sincos" else 1)]
    pointers = [a.ctypes.data_as(DOUBLES) for a in (flat, *out)]
    getattr(lib, f"reference_{name}")(*pointers, ctypes.c_long(flat.size))
    return tuple(a[0, : x.size].reshape(x.shape) for a in out)
