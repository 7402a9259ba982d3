"""Equations of motion under a law and the ground's push on a spike, compiled with derivatives.

The sources (`contact_dynamics`, `contact_forces`) are recorded once; rover, ground, site and gains
are inputs and spikes are lanes of a vector, so that one compiled function serves every rover and
step. Derivatives are those of the recorded source, operation by operation (`compile.tangent`).
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import Any

import numpy as np

from nullmotion import tree
from nullmotion.compile import CompiledFunction, compile_function
from nullmotion.compile.tangent import Recorded
from nullmotion.rover.contact_command import Law
from nullmotion.rover.contact_dynamics import motion
from nullmotion.rover.contact_forces import GroundNumbers, touch
from nullmotion.rover.contact_signals import Setting, body_signals, measured
from nullmotion.rover.contact_state import STATES, State

PUSH = 6  # force and torque of the ground
Source = Callable[..., np.ndarray]


class Shape:
    """A setting that is equal to every other of the same structure."""

    def __init__(self, setting: Setting) -> None:
        """Keep one as an example."""
        self.like, self._key = setting, tree.structure(setting)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Shape) and self._key == other._key

    def __hash__(self) -> int:
        return hash(self._key)


@lru_cache(maxsize=16)
def body_functions(law: Law, told: int, shape: Shape) -> tuple[CompiledFunction, ...]:
    """Return dx/dt, its Jacobian by state and push (15, 21), and the body's signals."""

    def change(x: Any, given: Any, push: Any, numbers: Any) -> np.ndarray:
        state, setting = State.of(x), tree.unflatten(shape.like, list(numbers))
        delta_ddot = law(given, setting.numbers, measured(state, setting)[0])
        return _row(motion(state, delta_ddot, setting.machine, push).change)

    def slopes(x: Any, given: Any, push: Any, numbers: Any) -> np.ndarray:
        directions = [*range(STATES), *range(STATES + told, STATES + told + PUSH)]
        return jacobian(change, (x, given, push, numbers), directions)

    def signals(x: Any, given: Any, push: Any, numbers: Any) -> np.ndarray:
        setting = tree.unflatten(shape.like, list(numbers))
        return _row(body_signals(State.of(x), given, setting, push, law))

    constants = np.array(tree.flatten(shape.like))
    examples = (np.zeros(STATES), np.zeros(told), np.zeros(PUSH), constants)
    return tuple(compile_function(f, *examples, width=1) for f in (change, slopes, signals))


@lru_cache(maxsize=1)
def spike_functions() -> tuple[CompiledFunction, ...]:
    """Return `Touch` of a spike, (11,), and the Jacobian of its push by the state, (6, 15)."""

    def pushed(x: Any, numbers: Any) -> np.ndarray:
        spike, carries, ground = numbers[:3], numbers[3], GroundNumbers(*numbers[4:])
        return _row(touch(State.of(x), spike, carries, ground))

    def slopes(x: Any, numbers: Any) -> np.ndarray:
        def push(*arguments: Any) -> np.ndarray:
            return pushed(*arguments)[:PUSH]

        return jacobian(push, (x, numbers), range(STATES))

    examples = (np.zeros(STATES), np.zeros(4 + len(GroundNumbers._fields)))
    return tuple(compile_function(f, *examples) for f in (pushed, slopes))


def jacobian(function: Source, arguments: tuple[Any, ...], directions: Any) -> np.ndarray:
    """Return the derivatives of a row by some of its arguments' leaves, row by row, (m n,)."""
    values = tree.flatten(list(arguments))
    recorded = Recorded(function, arguments, [True] * len(values))
    columns = []
    for j in directions:
        _, column = recorded.push(values, [1.0 if i == j else None for i in range(len(values))])
        columns.append([0.0 if v is None else v for v in column])
    return np.array(columns, dtype=object).T.ravel()


def _row(record: Any) -> np.ndarray:
    return np.array(tree.flatten(record), dtype=object)
