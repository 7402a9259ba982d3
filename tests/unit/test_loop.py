"""Kernels of loops: what is carried from step to step, what is computed once, time slices."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
import pytest

from nullmotion import ops
from nullmotion.compile import carry
from nullmotion.compile.kernel import LoopKernel
from nullmotion.compile.loop import Loop, Stage, run_on_host
from nullmotion.compile.tape import Symbol, Tape

STEPS = 60


class State(NamedTuple):
    """An angle and a sum over the angles reached."""

    x: Any
    total: Any


def step(k: Any, row: Any, s: State, p: Any) -> State:
    """Move by the sine of the old angle, add the sine of the new one."""
    x = s.x + 0.05 * ops.sin(s.x)
    return State(x, s.total + ops.sin(x))


def step_twice(k: Any, row: Any, s: State, p: Any) -> State:
    """Do the same to an angle that the next step does not start from."""
    x = s.x + 0.05 * ops.sin(s.x)
    return State(0.5 * x, s.total + ops.sin(x))


def until_done(k: Any, row: Any, s: State, p: Any) -> State:
    """Move while the sum is small."""
    new, going = step(k, row, s, p), ops.less(s.total, 5.0)
    return State(*[ops.where(going, a, b) for a, b in zip(new, s, strict=True)])


def factored(k: Any, row: Any, s: State, p: Any) -> State:
    """Use a root of a parameter, the same at every step."""
    return State(s.x + 0.01 * ops.sqrt(abs(p)) * s.total, s.total - 0.01 * s.x)


def loop(function: Any) -> Loop:
    return Loop(
        start=lambda p: State(p, 0.25),
        stages=(Stage(function),),
        outputs=lambda s, p: (s.x, s.total),
        parameters=0.7,
        varying=(True,),
    )


def kernel_of(function: Any) -> LoopKernel:
    return LoopKernel(loop(function), width=4)


def flown(kernel: LoopKernel, starts: np.ndarray, cuts: tuple[int, ...] = ()) -> np.ndarray:
    """Return outputs (2, runs) of a kernel that is left and entered again at some steps."""
    lanes, none = len(starts), np.zeros((1, 0))
    assert lanes % kernel.width == 0
    state, out = np.zeros((kernel.carried, lanes)), np.zeros((2 + len(kernel.flags), lanes))
    for k0, k1 in pairwise((0, *cuts, STEPS)):
        last = k1 == STEPS
        kernel.run(state, starts[None], none, none, out, 0, lanes, k0, k1, last)
    return out[:2]


@pytest.fixture
def starts(rng: np.random.Generator) -> np.ndarray:
    return rng.uniform(-3, 3, 8)


def on_host(function: Any, starts: np.ndarray) -> np.ndarray:
    loops = [replace(loop(function), parameters=float(start)) for start in starts]
    return np.array([run_on_host(one, STEPS, np.zeros((1, 0)))[0] for one in loops]).T


def sines(kernel: LoopKernel) -> int:
    """Return how many reductions of an angle one step has."""
    (piece,) = kernel.traced.pieces
    return piece.program.count()["raw_bit"]


def test_a_sine_of_the_new_state_is_carried_to_the_next_step() -> None:
    carrying, not_carrying = kernel_of(step), kernel_of(step_twice)
    assert (sines(carrying), sines(not_carrying)) == (1, 2)
    assert carrying.operations < 0.6 * not_carrying.operations


@pytest.mark.parametrize("function", [step, step_twice, until_done, factored])
def test_slices_change_no_bit_and_the_host_agrees(function: Any, starts: np.ndarray) -> None:
    kernel = kernel_of(function)
    whole = flown(kernel, starts)
    np.testing.assert_array_equal(flown(kernel, starts, cuts=(1, 2, 30, 59)), whole)
    np.testing.assert_allclose(whole, on_host(function, starts), rtol=0, atol=1e-12)


def test_a_run_that_has_ended_keeps_what_it_carries(starts: np.ndarray) -> None:
    kernel = kernel_of(until_done)
    assert sines(kernel) == 1
    totals = flown(kernel, starts)[1]
    assert (totals[totals > 5.0] < 6.0).all() and (totals > 5.0).any()


def test_what_follows_from_parameters_is_computed_before_the_loop() -> None:
    before, _, after = kernel_of(factored).source.partition("\nstep:")
    called = "call <"
    assert before.count(called) > 0
    assert not any(called in line and "sqrt" in line for line in after.splitlines())
    assert any(called in line and "sqrt" in line for line in before.splitlines())


def test_values_that_rounding_may_tell_apart_are_not_carried() -> None:
    """A product inside a sum may be fused in one place and not in the other: only it is carried."""
    tape = Tape()
    x = tape.input("x")
    new = x * 0.5
    found = carry.find(tape, [x.node], [], [new.node, _sum(x).node, _sum(new).node])
    assert [tape.nodes[i].op for i in found.nodes] == ["mul"]
    root, new_root = ops.sqrt(x), ops.sqrt(new)
    outputs = [new.node, (root + 1.0).node, new_root.node]
    found = carry.find(tape, [x.node], [], outputs)
    assert found.nodes == [root.node] and found.updates == [new_root.node]


def _sum(x: Symbol) -> Symbol:
    return ops.sqrt(x * x + 1.0) - 2.0
