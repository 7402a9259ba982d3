"""A law compiled for one array, called from Python in about a microsecond."""

from __future__ import annotations

from typing import Any

import numpy as np

from nullmotion import tree
from nullmotion.array.model import CmgArray
from nullmotion.compile import llvm
from nullmotion.compile.function import call_source
from nullmotion.compile.program import trace
from nullmotion.errors import UnsupportedArrayError
from nullmotion.law import Law, Observation


class PreparedLaw:
    """A steering law as machine code with its own buffers and carried state.

        prepared = nm.prepare(law, array, period=0.01)
        rates = prepared(delta, hdot, t)

    A call copies its arguments into fixed buffers, runs, and returns the rates' buffer,
    which the next call overwrites: copy it to keep it. The law's state is carried from
    call to call; `reset` starts it anew.

    Attributes:
        delta: Buffer of measured gimbal angles [rad], (n,).
        hdot: Buffer of the wanted rate of momentum [N m], (m,).
        rates: Buffer of gimbal rates [rad/s], (n,).
        wheel_speed: Buffer of wheel speeds for a law of variable-speed CMGs [rad/s], (n,): the
            design speeds until set; empty for other laws.
        accelerations: Buffer of such a law's wheel accelerations [rad/s^2], (n,).
        operations: Number of tape operations.
    """

    def __init__(self, law: Law, array: CmgArray, period: float, limited: bool) -> None:
        """Trace and compile the law."""
        n, m = array.n, array.m
        self.law, self.array = law, array
        self._like = law.init(array, np.zeros(n))

        spins = n if law.turns_wheels else 0

        def step(delta: Any, hdot: Any, t: Any, spin: Any, state: Any) -> tuple[Any, ...]:
            seen = Observation(delta, hdot, t, period, wheel_speed=spin if spins else None)
            asked, after = law.step(array, seen, state)
            rates, accelerations = asked if spins else (asked, ())
            return (array.limited(rates) if limited else rates), accelerations, after

        examples = (np.zeros(n), np.zeros(m), 0.0, np.zeros(spins), self._like)
        program, _ = trace(step, *examples, fuse=llvm.host().fma)
        self.operations = program.operations
        self._flags = list(program.guards)
        carried = len(tree.flatten(self._like))
        inputs = n + m + 1 + spins + carried
        self._io = np.zeros(inputs + n + spins + len(self._flags))
        self.delta, self.hdot = self._io[:n], self._io[n : n + m]
        self.wheel_speed = self._io[n + m + 1 : n + m + 1 + spins]
        if spins:
            self.wheel_speed[:] = array.design_speed
        self._state = self._io[n + m + 1 + spins : inputs]
        self.rates, rest = self._io[inputs : inputs + n], self._io[inputs + n :]
        self.accelerations, self._raised = rest[:spins], rest[spins:]
        source = call_source(program, carried, self._io.ctypes.data)
        run = llvm.Machine(source, 2).function("call", brief=True)  # the address is its own
        self._bound = (self.delta, self.hdot, self._io[n + m : n + m + 1], run, self.rates)
        self.reset()

    def reset(self, delta: Any = None) -> None:
        """Start the law's state anew, at gimbal angles ``delta`` (zeros by default)."""
        start = np.zeros(self.array.n) if delta is None else np.asarray(delta, float)
        self._state[:] = tree.flatten(self.law.init(self.array, start))

    def __call__(self, delta: Any, hdot: Any, t: float = 0.0) -> np.ndarray:
        """Return gimbal rates [rad/s] for measured angles, wanted hdot and time."""
        angles, wanted, clock, step, rates = self._bound
        angles[...] = delta
        wanted[...] = hdot
        clock[0] = t
        step()
        return rates

    @property
    def status(self) -> list[str]:
        """Flags raised by the last call; empty if all is well."""
        return [flag for flag, raised in zip(self._flags, self._raised, strict=True) if raised]


def prepare(
    law: Law, array: CmgArray, *, period: float = 0.01, limited: bool = True
) -> PreparedLaw:
    """Compile a law for an array.

    Args:
        law: The steering law.
        array: The array it steers; its values become constants.
        period: Time between two calls that the law may count on [s].
        limited: Apply the array's rate limit.

    Raises:
        UnsupportedArrayError: When the law cannot steer the array.
        TraceError: When the law decides by a value.
    """
    reason = law.supports(array)
    if reason:
        raise UnsupportedArrayError(law.name, reason)
    return PreparedLaw(law, array, period, limited)
