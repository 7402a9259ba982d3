"""The time loop: order of events, law period and delay, stops, history, kernel against Python."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, ClassVar, NamedTuple

import numpy as np
import pytest

import nullmotion as nm
from nullmotion import metrics, ops
from nullmotion.errors import InputError, MemoryLimitError, TraceError, UnsupportedArrayError
from nullmotion.sim import Setup, Stop, run, run_batch


class Count(NamedTuple):
    samples: Any


@dataclass(frozen=True)
class Ramp(nm.Law):
    """Rates that tell how often the law was asked: first 0.01, then 0.02, ... rad/s."""

    name: ClassVar[str] = "test-ramp"

    def init(self, array, delta):
        return Count(0.0)

    def step(self, array, obs, state):
        count = state.samples + 1.0
        return np.array([0.01 * count] * array.n), Count(count)


@dataclass(frozen=True)
class Echo(nm.Law):
    """Rates equal to the time and to what the law is told."""

    name: ClassVar[str] = "test-echo"

    def step(self, array, obs, state):
        return np.array([obs.t, obs.period, obs.hdot[0], obs.delta[3]]), state


@dataclass(frozen=True)
class Branching(nm.Law):
    """A law that decides by a value."""

    name: ClassVar[str] = "test-branching"

    def step(self, array, obs, state):
        if obs.delta[0] > -1.0:
            return array.jacobian(obs.delta).T @ obs.hdot, state
        return np.zeros(array.n), state


BACKENDS = ["kernel", "python"]


def pyramid(**more):
    return nm.layouts.pyramid(**{"rate_limit": np.pi, **more})


def setup(law, **more):
    base = {
        "delta": np.zeros(4),
        "hdot": np.array([1.0, 0.0, 0.0]),
        "steps": 40,
        "integrator": "euler",
    }
    return Setup(pyramid(), law, **{**base, **more})


def named(*names):
    return tuple(metrics.get(n)() for n in names)


@pytest.mark.parametrize("backend", BACKENDS)
def test_law_state_advances_once_a_period(backend):
    result = run(setup(Ramp(), period_steps=10), backend=backend)
    np.testing.assert_allclose(
        result.rates[:40, 0], np.repeat([0.01, 0.02, 0.03, 0.04], 10), rtol=1e-15
    )


@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize("integrator", ["euler", "rk4", "semi-implicit-euler"])
def test_law_state_does_not_advance_inside_integrator_stages(backend, integrator):
    result = run(setup(Ramp(), integrator=integrator), backend=backend)
    np.testing.assert_allclose(result.rates[:40, 0], 0.01 * np.arange(1, 41), rtol=1e-14)


@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize(("period", "delay"), [(1, 0), (1, 3), (5, 2), (5, 5), (5, 7), (10, 23)])
def test_delay_moves_rates_by_whole_steps(backend, period, delay):
    result = run(setup(Ramp(), period_steps=period, delay_steps=delay), backend=backend)
    k = np.arange(40)
    expected = np.where(k >= delay, 0.01 * ((k - delay) // period + 1), 0.0)
    np.testing.assert_allclose(result.rates[:40, 0], expected, rtol=1e-14)


@pytest.mark.parametrize("backend", BACKENDS)
def test_what_a_law_is_told(backend):
    bias = np.array([0.0, 0.0, 0.0, 0.25])
    what = setup(
        Echo(), dt=0.02, period_steps=5, encoder_bias=bias, delta=np.array([0.1, 0.2, 0.3, 0.5])
    )
    asked = run(what, backend=backend).rates_asked
    np.testing.assert_allclose(asked[[0, 5, 10], 0], [0.0, 0.1, 0.2], atol=1e-15)
    assert asked[0, 1] == pytest.approx(0.1)
    assert asked[0, 2] == 1.0
    assert asked[0, 3] == 0.75


@pytest.mark.parametrize("backend", BACKENDS)
def test_schedule_has_a_row_for_each_sample_and_holds_the_last(backend):
    rows = np.array([[0.1, 0, 0], [0.2, 0, 0], [0.3, 0, 0]])
    result = run(setup(Echo(), hdot=rows, period_steps=10), backend=backend)
    np.testing.assert_allclose(result.rates_asked[:40, 2], np.repeat([0.1, 0.2, 0.3, 0.3], 10))


def test_momentum_follows_the_command():
    result = run(setup(nm.laws.create("pseudo-inverse"), steps=100, dt=0.001, integrator="rk4"))
    np.testing.assert_allclose(result.momentum[-1], [0.1, 0.0, 0.0], atol=2e-5)
    np.testing.assert_allclose(result.torque[:-1], np.tile([1.0, 0, 0], (100, 1)), atol=1e-12)


@pytest.mark.parametrize(
    ("integrator", "order"), [("euler", 1), ("semi-implicit-euler", 1), ("rk4", 4)]
)
def test_integrators_have_their_order(integrator, order):
    """The impulse integral of held rates, against the exact change of momentum."""

    def error(steps):
        s = setup(Ramp(), steps=steps, dt=1.0 / steps, period_steps=steps, integrator=integrator)
        s = replace(s, law=Constant(np.array([1.0, -0.7, 0.4, 0.9])))
        result = run(s, backend="python")
        return np.abs(result.impulse[-1] - (result.momentum[-1] - result.momentum[0])).max()

    measured = np.log2(error(8) / error(16))
    assert measured == pytest.approx(order, abs=0.25)


@dataclass(frozen=True)
class Constant(nm.Law):
    """Rates that never change."""

    rates: Any
    name: ClassVar[str] = "test-constant"

    def step(self, array, obs, state):
        return self.rates, state


@dataclass(frozen=True)
class Failing(nm.Law):
    """Rates that are no numbers from 0.1 s on."""

    name: ClassVar[str] = "test-failing"

    def step(self, array, obs, state):
        late = ops.less(0.095, obs.t)
        return np.array([ops.where(late, np.nan, 0.1)] * array.n), state


@pytest.mark.parametrize("backend", BACKENDS)
def test_stop_is_tested_before_the_step(backend):
    stop = Stop(metrics.get("momentum_Nms")(), 0.095, below=False)
    result = run(
        setup(nm.laws.create("pseudo-inverse"), stop=(stop,), metrics=named("momentum_Nms")),
        backend=backend,
    )
    assert result.stopped_at_s == pytest.approx(0.10)
    assert result.stop_reason == "momentum_Nms above 0.095"
    assert result.momentum[-2, 0] < 0.095 < result.momentum[-1, 0]
    assert len(result.t) == 11
    assert np.isnan(result.rates[-1]).all()
    assert result.metrics["final_momentum_Nms"] == pytest.approx(
        np.linalg.norm(result.momentum[-1])
    )


def test_metrics_are_those_of_the_history():
    names = [n for n in metrics.applicable(False) if n != "momentum_error_Nms"]
    result = run(
        setup(
            nm.laws.create("sr"),
            steps=120,
            metrics=named(*names),
            delta=np.array([0.3, -0.2, 0.5, 0.1]),
        )
    )
    m = result.metrics
    assert m["min_sigma_min"] == pytest.approx(result.measures["sigma_min"].min(), rel=1e-12)
    assert m["final_momentum_state"] == pytest.approx(
        result.measures["momentum_state"][-1], rel=1e-12
    )
    steps = np.abs(np.diff(result.rates[:-1], axis=0)).max()
    assert m["max_rate_step_rad_s"] == pytest.approx(steps, rel=1e-12)
    across = np.linalg.norm(result.torque[:-1, 1:], axis=1)
    assert m["max_off_axis_torque_fraction"] == pytest.approx(across.max(), rel=1e-9, abs=1e-13)
    assert m["rms_off_axis_torque_fraction"] == pytest.approx(
        np.sqrt((across**2).mean()), rel=1e-9, abs=1e-13
    )
    along = np.abs(result.torque[:-1, 0] - 1.0)
    assert m["max_along_axis_torque_fraction"] == pytest.approx(along.max(), rel=1e-9)


@pytest.mark.parametrize("law", ["pseudo-inverse", "sr", "vcbsae"])
@pytest.mark.sampled(2)
def test_kernel_and_python_agree(law):
    s = setup(
        nm.laws.create(law),
        steps=100,
        metrics=named("sigma_min", "off_axis_torque_fraction", "rate_step_rad_s"),
        delta=np.array([0.3, -0.2, 0.5, 0.1]),
        period_steps=2,
        delay_steps=1,
        integrator="rk4",
    )
    a, b = run(s, backend="kernel"), run(s, backend="python")
    np.testing.assert_allclose(a.delta, b.delta, atol=1e-12)
    np.testing.assert_allclose(a.rates, b.rates, atol=1e-11)
    for key in a.metrics:
        assert a.metrics[key] == pytest.approx(b.metrics[key], rel=1e-9, abs=1e-11)


def test_end_stops_hold_the_gimbals():
    array = pyramid(angle_limits=np.radians([-2.0, 2.0]))
    s = replace(setup(Constant(np.array([1.0, -1.0, 0.5, 0.0]))), array=array)
    for backend in BACKENDS:
        result = run(s, backend=backend)
        np.testing.assert_allclose(np.degrees(result.delta[-1]), [2.0, -2.0, 2.0, 0.0], atol=1e-9)
        assert abs(result.rates[-2]).max() < 1e-12


def test_a_law_that_branches_still_runs_and_says_where():
    with pytest.warns(
        RuntimeWarning, match=r"test_simulation\.py:\d+: this line decides by a value"
    ):
        result = run(setup(Branching()))
    assert result.backend == "python"
    with pytest.raises(TraceError, match=r"test_simulation\.py:\d+"):
        run(setup(Branching()), backend="kernel")


def test_decimated_history_is_every_so_many_steps():
    s = setup(nm.laws.create("sr"), steps=45)
    whole, thin = run(s), run(s, decimate=10)
    np.testing.assert_array_equal(thin.delta, whole.delta[::10])
    np.testing.assert_allclose(thin.t, whole.t[::10])


def test_batch_equals_single_runs_bit_for_bit(rng):
    """Lanes, threads and slices change nothing."""
    starts, commands = rng.uniform(-0.5, 0.5, (37, 4)), rng.normal(size=(37, 3))
    stop = Stop(metrics.get("sigma_min")(), 0.3)
    s = setup(
        nm.laws.create("vcbsae"),
        steps=150,
        stop=(stop,),
        metrics=named("sigma_min", "peak_rate_rad_s"),
    )
    batch = run_batch(s, delta=starts, hdot=commands, threads=2, history=1)
    for i in (0, 7, 36):
        one = run(replace(s, delta=starts[i], hdot=commands[i]))
        steps = len(one.t)
        np.testing.assert_allclose(batch.history.delta[i, :steps], one.delta, rtol=0, atol=1e-13)
        stopped = np.nan if one.stopped_at_s is None else one.stopped_at_s
        np.testing.assert_allclose(batch.stopped_at_s[i], stopped)
        assert batch.stop_reason[i] == one.stop_reason
        assert batch["min_sigma_min"][i] == pytest.approx(one.metrics["min_sigma_min"], rel=1e-12)
        np.testing.assert_allclose(batch.final_momentum[i], one.momentum[-1], atol=1e-12)


def test_batch_varies_any_number(rng):
    law, setups = "sr", []
    for skew, lambda0 in zip(np.radians([40, 50, 60, 70]), [0.001, 0.01, 0.02, 0.1], strict=True):
        array = nm.layouts.pyramid(skew=skew, rate_limit=2.0)
        setups.append(
            Setup(
                array,
                nm.laws.create(law, lambda0=lambda0),
                np.full(4, 0.2),
                np.array([0.3, 0.1, 0.2]),
                steps=60,
            )
        )
    batch = run_batch(setups[0], setups=setups)
    for i, one in enumerate(setups):
        np.testing.assert_allclose(batch.final_gimbal_rad[i], run(one).delta[-1], atol=1e-13)
    with pytest.raises(InputError, match="same structure"):
        run_batch(setups[0], setups=[*setups[:2], replace(setups[2], steps=61)])


def test_batch_refuses_what_does_not_fit(rng):
    s = setup(nm.laws.create("sr"))
    with pytest.raises(InputError, match="same number of runs"):
        run_batch(s, delta=np.zeros((3, 4)), hdot=np.zeros((2, 3)))
    with pytest.raises(InputError, match="finite"):
        run_batch(s, delta=np.full((3, 4), np.nan))
    with pytest.raises(MemoryLimitError, match="half of this machine"):
        run_batch(replace(s, steps=10**6), delta=np.zeros((10**6, 4)), history=1)


def test_status_tells_angles_beyond_the_sine_range():
    s = setup(nm.laws.create("sr"), delta=np.array([1.1e5, 0.0, 0.0, 0.0]))
    assert run(s).status == ["angle-range"]
    assert run(setup(nm.laws.create("sr"))).status == []


def test_a_failed_run_still_has_measures_and_a_summary():
    s = setup(Failing(), steps=30, metrics=named("sigma_min"))
    for backend in BACKENDS:
        result = run(s, backend=backend)
        assert result.status[-1] == "non-finite"
        good = np.isfinite(result.delta).all(axis=1)
        assert 0 < good.sum() < len(good)
        for values in result.measures.values():
            assert np.isfinite(values[good]).all() and np.isnan(values[~good]).all()
        assert result.summary()["momentum_state"] == "unknown"


def test_durations_are_written_as_meant():
    assert run(setup(nm.laws.create("sr"), steps=330)).summary()["duration_s"] == 3.3


def test_setup_refuses():
    law = nm.laws.create("sr")
    with pytest.raises(InputError, match="delta"):
        setup(law, delta=np.zeros(3))
    with pytest.raises(InputError, match="hdot"):
        setup(law, hdot=np.array([1.0, np.nan, 0.0]))
    with pytest.raises(InputError, match="dt"):
        setup(law, dt=0.0)
    with pytest.raises(UnsupportedArrayError, match="nd"):
        Setup(nm.layouts.planar(n=2), nm.laws.create("nd"), np.zeros(2), np.zeros(2))


def test_progress_reaches_one():
    seen: list[float] = []
    run(setup(nm.laws.create("sr")), progress=seen.append)
    assert seen[-1] == 1.0
    seen.clear()
    run_batch(setup(nm.laws.create("sr")), delta=np.zeros((100, 4)), progress=seen.append)
    assert seen[-1] == 1.0
