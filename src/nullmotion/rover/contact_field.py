"""The contact simulation's right-hand side as machine code, with its exact Jacobian.

    x' = f(x, w),  w = sum_i w_i(x)          J = df/dx + df/dw sum_i dw_i/dx

w_i is force and torque of spike i: `contact_compiled` has f under a law, w_i and their derivatives.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from nullmotion import tree
from nullmotion.compile import CompiledFunction
from nullmotion.rover.contact_command import Law
from nullmotion.rover.contact_compiled import PUSH, Shape, body_functions, spike_functions
from nullmotion.rover.contact_signals import Setting, Signals
from nullmotion.rover.contact_state import STATES


class Field:
    """Right-hand side, Jacobian and signals of one simulation, on buffers of their own.

    Args:
        law: Control law; a function of a module, so that what is compiled is found again.
        reference: What the law is told at a time [s]: as many numbers each time.
        setting: Rover, ground and law in numbers.
        spikes: Tips about the mass centre in body axes [m], (V, 3).
        carrying: Which spikes carry at first, (V,).
    """

    def __init__(
        self,
        law: Law,
        reference: Callable[[float], Any],
        setting: Setting,
        spikes: np.ndarray,
        carrying: np.ndarray,
    ) -> None:
        """Compile, or find what was compiled before."""
        self.reference, self.setting = reference, setting
        numbers = np.array(tree.flatten(setting))
        body = body_functions(law, len(reference(0.0)), Shape(setting))
        self._change, self._slopes, self._signals = (_Call(f, 1, numbers) for f in body)
        ground = np.repeat(np.array(setting.ground)[:, None], len(spikes), axis=1)
        self._push, self._push_slopes = (
            _Call(f, len(spikes), np.vstack([spikes.T, carrying, ground]))
            for f in spike_functions()
        )
        self.carry(carrying)

    def carry(self, carrying: np.ndarray) -> None:
        """Say which spikes carry from now on."""
        self.carrying = np.array(carrying, bool)
        for call in (self._push, self._push_slopes):
            call.numbers[3] = carrying

    def change(self, t: float, x: np.ndarray) -> np.ndarray:
        """Return dx/dt, (15,)."""
        push = self._push(x)[:PUSH].sum(axis=1)
        return self._change(x, self.reference(t), push)[:, 0].copy()

    def slopes(self, t: float, x: np.ndarray) -> np.ndarray:
        """Return the Jacobian d(dx/dt)/dx, (15, 15)."""
        push = self._push(x)[:PUSH].sum(axis=1)
        by_state = self._push_slopes(x).sum(axis=1).reshape(PUSH, STATES)
        found = self._slopes(x, self.reference(t), push).reshape(STATES, STATES + PUSH)
        total: np.ndarray = found[:, :STATES] + found[:, STATES:] @ by_state
        return total

    def row(self, t: float, x: np.ndarray) -> np.ndarray:
        """Return all signals in a row; `Signals.split` names them."""
        ground = self._push(x)
        body = self._signals(x, self.reference(t), ground[:PUSH].sum(axis=1))
        return Signals.row(body[:, 0], ground)


class _Call:
    """A compiled function of columns of inputs, the last of which stay as they are."""

    def __init__(self, function: CompiledFunction, count: int, numbers: np.ndarray) -> None:
        """Make buffers that hold the numbers, (n, count) or (n,)."""
        self._run = function.bound(count)
        *self._inputs, self.numbers = self._run.arguments
        self.numbers[:] = numbers.reshape(len(numbers), -1)
        self._result: np.ndarray = self._run.result

    def __call__(self, *inputs: Any) -> np.ndarray:
        """Return the result, (m, count); the next call overwrites it."""
        for buffer, values in zip(self._inputs, inputs, strict=True):
            buffer.T[:] = values
        self._run()
        return self._result
