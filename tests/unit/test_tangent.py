"""Derivatives from the tape against mpmath, differences and the plain loop."""

from __future__ import annotations

from functools import cache
from typing import Any, NamedTuple

import mpmath
import numpy as np
import pytest

from nullmotion import Observation, laws, layouts, ops, tree
from nullmotion.compile import compile_function, trace
from nullmotion.compile import tape as tp
from nullmotion.compile.kernel import LoopKernel
from nullmotion.compile.loop import Loop, Stage, run_on_host
from nullmotion.compile.loop_tangent import differentiated
from nullmotion.compile.tangent import jvp
from nullmotion.errors import TraceError
from nullmotion.sim import Setup
from nullmotion.sim.stages import loop
from nullmotion.sim.state import parameters

mp = mpmath.mp.clone()
mp.dps = 40

FUNCTIONS = {
    "sin": (ops.sin, mp.sin, -9.0, 9.0),
    "cos": (ops.cos, mp.cos, -9.0, 9.0),
    "exp": (ops.exp, mp.exp, -20.0, 20.0),
    "log": (ops.log, mp.log, 0.01, 50.0),
    "acos": (ops.acos, mp.acos, -0.99, 0.99),
    "sqrt": (ops.sqrt, mp.sqrt, 0.01, 50.0),
    "rsqrt": (ops.rsqrt, lambda x: 1 / mp.sqrt(x), 0.01, 50.0),
    "abs": (ops.absolute, abs, -5.0, 5.0),
    "power": (lambda x: x**5 - x**-3, lambda x: x**5 - x**-3, 0.2, 3.0),
    "real power": (lambda x: ops.power(x, 1.7), lambda x: x ** mp.mpf(1.7), 0.2, 3.0),
    "ratio": (lambda x: x / (1.0 + x * x), lambda x: x / (1 + x * x), -4.0, 4.0),
    "angle": (lambda x: ops.atan2(x, 0.3 - x), lambda x: mp.atan2(x, mp.mpf(0.3) - x), -2.0, 2.0),
    "chosen": (
        lambda x: ops.where(x < 1.0, ops.sin(x), x * x),
        lambda x: mp.sin(x) if x < 1 else x * x,
        -2.0,
        3.0,
    ),
    "limited": (
        lambda x: ops.clip(x * x, 1.0, 4.0) * ops.copysign(x, -1.0),
        lambda x: -min(max(x * x, 1), 4) * abs(x),
        -3.0,
        3.0,
    ),
}


def slope(function: Any) -> Any:
    """Return the derivative of a function of one number."""
    return lambda x: jvp(function, (x,), (1.0,))[1]


@pytest.mark.parametrize("name", FUNCTIONS)
@pytest.mark.sampled(7)
def test_elementary_functions_have_the_derivatives_of_mpmath(name, rng):
    function, exact, low, high = FUNCTIONS[name]
    x = rng.uniform(low, high, 60)
    with mp.workdps(40):
        truth = np.array([float(mp.diff(exact, mp.mpf(v))) for v in x.tolist()])
    size = np.abs(truth) + 1e-3
    assert np.abs(compile_function(slope(function), 1.0)(x) - truth).max() < 1e-14 * size.max()
    assert (np.abs(compile_function(slope(function), 1.0)(x) - truth) / size).max() < 1e-13
    on_floats = np.array([slope(function)(v) for v in x.tolist()])
    assert (np.abs(on_floats - truth) / size).max() < 1e-13


@pytest.mark.parametrize("name", ["sin", "exp", "log", "acos", "rsqrt", "angle"])
def test_derivatives_can_be_differentiated(name, rng):
    function, exact, low, high = FUNCTIONS[name]
    x = rng.uniform(low, high, 20)
    with mp.workdps(40):
        truth = np.array([float(mp.diff(exact, mp.mpf(v), 2)) for v in x.tolist()])
    found = compile_function(slope(slope(function)), 1.0)(x)
    np.testing.assert_allclose(found, truth, rtol=1e-11, atol=1e-13 * np.abs(truth).max())


def test_where_nothing_changes_roots_and_angles_stay_finite():
    def at_zero(v: Any) -> Any:
        root = ops.sqrt(v @ v)
        other = ops.where(v[0] < 1.0, v[0], ops.sqrt(v[0] - 1.0))
        return root, ops.atan2(v[0], v[1]), (v @ v) * ops.rsqrt(v @ v), other, ops.acos(1.0 - v[0])

    _, slopes = jvp(at_zero, (np.zeros(2),), (np.array([1.0, 2.0]),))
    assert slopes == (0.0, 0.0, 0.0, 1.0, 0.0)
    pushed = compile_function(lambda v, t: jvp(at_zero, (v,), (t,))[1], np.zeros(2), np.zeros(2))
    assert [float(s[0]) for s in pushed(np.zeros((1, 2)), np.array([[1.0, 2.0]]))] == [
        0,
        0,
        0,
        1,
        0,
    ]


def test_arguments_without_a_tangent_stay_as_they_are():
    value, change = jvp(lambda a, b: (a * b, b), (2.0, 3.0), (None, 1.0))
    assert value == (6.0, 3.0) and change == (2.0, 1.0)


def test_the_same_symbol_may_have_two_tangents():
    def twice(x: Any) -> Any:
        return jvp(lambda a, b: a * b, (x, x), (1.0, 0.0))[1]

    assert compile_function(twice, 1.0)(np.array([3.0]))[0] == 3.0


def test_guards_and_values_are_those_of_the_source():
    def guarded(x: Any) -> Any:
        tp.guard("small", x < 2.0)
        return ops.sin(x)

    pushed = compile_function(lambda x: jvp(guarded, (x,), (1.0,)), 1.0)
    value, _ = pushed(np.array([1.0, 3.0]))
    assert np.array_equal(value, compile_function(guarded, 1.0)(np.array([1.0, 3.0])))
    assert "small" in pushed.program.guards and pushed.status.any(axis=0).tolist() == [False, True]


def test_what_has_no_derivative_is_refused():
    with pytest.raises(TraceError, match="exponent"):
        jvp(lambda x: tp.exponent(x), (3.0,), (1.0,))
    assert trace(lambda x: jvp(lambda y: ops.rint(y) * y, (x,), (1.0,))[1], 1.0)[0].operations == 1


@cache
def array_of(layout: str) -> Any:
    return layouts.create(layout, h0=1.0, rate_limit=np.pi)


def steered() -> list[Any]:
    return [
        pytest.param(law, layout, marks=[pytest.mark.slow] if layout == "roof6" else [])
        for law in laws.names()
        for layout in ("pyramid", "planar", "roof6")
        if laws.create(law).traceable and not laws.create(law).supports(array_of(layout))
    ]


def extrapolated(f: Any, step: float) -> tuple[np.ndarray, np.ndarray]:
    """Return a derivative by central differences of order eight, and how sure it is."""

    def order(n: int) -> np.ndarray:
        squares = 1.0 / np.arange(1, n + 1) ** 2.0
        total = 0.0
        for i in range(n):
            others = np.delete(squares, i)
            weight = np.prod(others / (others - squares[i]))
            h = step / (i + 1)
            total = total + weight * (f(h) - f(-h)) / (2.0 * h)
        return total

    return order(4), np.abs(order(4) - order(3))


@pytest.mark.parametrize(("name", "layout"), steered())
@pytest.mark.sampled(4)
def test_laws_have_the_derivatives_of_differences(name, layout, rng):
    law, array = laws.create(name), array_of(layout)
    n, m, count = array.n, array.m, 120
    start = law.init(array, np.zeros(n))

    def rates(d: Any, h: Any) -> Any:
        return law.step(array, Observation(d, h, 0.3, 0.01, np.zeros(n), np.zeros(3)), start)[0]

    def pushed(d: Any, h: Any, dd: Any, dh: Any) -> Any:
        return jvp(rates, (d, h), (dd, dh))

    d, dd = rng.uniform(-np.pi, np.pi, (count, n)), rng.normal(size=(count, n))
    h, dh = rng.normal(size=(2, count, m))
    plain = compile_function(rates, np.zeros(n), np.zeros(m))
    both = compile_function(pushed, np.zeros(n), np.zeros(m), np.zeros(n), np.zeros(m))
    value, change = both(d, h, dd, dh)
    assert np.array_equal(value, plain(d, h))
    truth, doubt = extrapolated(lambda e: plain(d + e * dd, h + e * dh), 2e-3)
    size = np.abs(truth).max(axis=1)
    smooth = doubt.max(axis=1) < 1e-7 * size  # the others stand at a switch of the law
    assert smooth.mean() > 0.75
    assert (np.abs(change - truth).max(axis=1)[smooth] < 1e-7 * size[smooth]).all()


class State(NamedTuple):
    x: Any
    count: Any
    held: Any


def moving(k: Any, row: Any, s: State, p: Any) -> State:
    return s._replace(x=s.x + 0.1 * ops.sin(p[0] * s.x + row[0]) + p[1], count=s.count + 1.0)


def holding(k: Any, row: Any, s: State, p: Any) -> State:
    return s._replace(held=s.x * s.x)


def example() -> Loop:
    return Loop(
        start=lambda p: State(p[1] * p[1], 0.0, 0.0),
        stages=(Stage(holding, 3, 1), Stage(moving)),
        outputs=lambda s, p: (s.x * s.held, s.count, p[2] * s.x),
        parameters=np.array([0.7, 0.3, 2.0]),
        varying=(True, True, False),
        row=1,
        active=lambda s: ops.less(s.count, 40.0),
        record=lambda s: s.x,
        recorded_after=1,
    )


def test_a_loop_carries_tangents_of_what_changes_alone(rng):
    source = example()
    what = differentiated(source, [True, True, False])
    rows = rng.uniform(-1, 1, (50, 1))

    def plainly(p: np.ndarray) -> list[float]:
        given = Loop(**{**vars(source), "parameters": p})
        return list(run_on_host(given, 50, rows)[0])

    kernel = LoopKernel(what, recording=True, width=4)
    assert len(tree.flatten(kernel.traced.state_like)) == 3 + 2  # the count has no tangent
    p, seeds = np.array([0.7, 0.3, 2.0]), np.array([[1.0, 0.0, 0.6, 0.0], [0.0, 1.0, -0.8, 0.0]])
    values = np.vstack([np.tile(p[:2, None], (1, 4)), seeds])
    out = np.zeros((kernel.outputs + len(kernel.flags), 4))
    history = np.zeros((50, kernel.records, 4))
    state = np.zeros((kernel.carried, 4))
    kernel.run(state, values, rows, history, out, 0, 4, 0, 50, True)
    for lane in range(4):
        direction = np.array([*seeds[:, lane], 0.0])
        truth, _ = extrapolated(lambda e, d=direction: np.array(plainly(p + e * d)), 1e-2)
        np.testing.assert_allclose(out[:3, lane], plainly(p), rtol=1e-13)
        np.testing.assert_allclose(out[3:6, lane], truth, rtol=1e-9, atol=1e-11)
        given = Loop(
            **{**vars(what), "parameters": what.parameters._replace(seeds=(*seeds[:, lane],))}
        )
        (_, on_host), kept = run_on_host(given, 50, rows, recording=True)
        np.testing.assert_allclose(on_host, out[3:6, lane], rtol=1e-12, atol=1e-14)
        np.testing.assert_allclose(np.array(kept), history[:40, 0, lane], rtol=1e-13)


def test_a_run_has_the_derivatives_of_differences(rng):
    """A whole run with respect to start angles and command, twice as long as a law period."""
    array = layouts.pyramid(skew=0.95, h0=1.3, rate_limit=2.0)
    setup = Setup(
        array,
        laws.create("gsr"),
        rng.uniform(-1, 1, 4),
        np.array([0.4, -0.3, 0.2]),
        dt=0.02,
        steps=100,
        period_steps=2,
        delay_steps=1,
    )
    own = parameters(setup)
    fields = [name for name in own._fields for _ in tree.flatten(getattr(own, name))]
    chosen = tuple(name in ("delta", "hdot") for name in fields)
    place = np.array(tree.flatten(own), float)[list(chosen)]
    plain = LoopKernel(loop(setup, chosen), width=8)
    both = LoopKernel(differentiated(loop(setup, chosen), chosen), width=8)

    def flown(kernel: LoopKernel, values: np.ndarray) -> np.ndarray:
        state = np.zeros((kernel.carried, 8))
        out = np.zeros((kernel.outputs + len(kernel.flags), 8))
        none = np.zeros((1, 0))
        kernel.run(state, values, none, none, out, 0, 8, 0, setup.steps + 1, True)
        return out[: kernel.outputs]

    seeds = rng.normal(size=(7, 8))
    values = np.tile(place[:, None], (1, 8))
    found = flown(both, np.vstack([values, seeds]))
    half = len(found) // 2
    assert np.array_equal(found[:half], flown(plain, values))
    truth, doubt = extrapolated(lambda e: flown(plain, values + e * seeds), 1e-2)
    assert doubt.max() < 1e-8
    np.testing.assert_allclose(found[half:], truth, rtol=1e-7, atol=1e-9)
