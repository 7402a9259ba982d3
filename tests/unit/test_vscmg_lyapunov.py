"""Lyapunov's function along runs: its bound, errors planted in the controller, assumptions."""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from functools import cache
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from nullmotion import InputError, laws, layouts
from nullmotion.array.wheels import Wheels
from nullmotion.sim import Setup, Trajectory, run
from nullmotion.spacecraft import Desaturation, Disturbance, Event, Sensors, Spacecraft, controllers
from nullmotion.spacecraft.controllers.adaptive import Adaptive
from nullmotion.vscmg import Units
from nullmotion.vscmg.assumptions import SAMPLED
from nullmotion.vscmg.dynamics import Plant, axes, rest_inertia
from nullmotion.vscmg.lyapunov import LyapunovMonitor, monitor
from nullmotion.vscmg.parameters import true_parameters

INERTIA = np.diag([0.061, 0.061, 0.0764])
WHEEL = 6.95e-4
DELTA = np.array([0.5498, 0.2333, 0.5498, 0.2333])
Q = np.array([0.1, 0.3, 0.8, 0.4])
PUBLISHED = Units(2.8e-3 + 3.5e-4, 2.8e-3, 2.8e-3, terms="published")


def reference(dt: float, steps: int) -> np.ndarray:
    """Return Kim's reference: 0.004 rad/s about x, as a sine of 2000 s."""
    t, w, zero = np.arange(steps + 1) * dt, 2.0 * np.pi / 2000.0, np.zeros(steps + 1)
    half = 0.5 * 0.004 / w * (1.0 - np.cos(w * t))
    turn = [0.004 * np.sin(w * t), zero, zero, 0.004 * w * np.cos(w * t), zero, zero]
    return np.stack([np.cos(half), np.sin(half), zero, zero, *turn], axis=1)


def pyramid(rate_limit: float = 25.0, mode: str = "clip", **wheels: Any) -> Any:
    layout = layouts.get("pyramid")(skew=np.radians(54.74))
    return layout.array(
        h0=WHEEL * 200.0,
        rate_limit=rate_limit,
        rate_limit_mode=mode,
        wheels=Wheels(np.array(WHEEL), **{key: np.array(v) for key, v in wheels.items()}),
    )


def startup(dt: float = 0.01, seconds: float = 8.0, **changes: Any) -> Setup:
    """Return the startup of Kim et al., case 2, with changes."""
    steps = round(seconds / dt)
    law = laws.create(
        "vscmg-weighted", W_Omega0=1000.0, lambda1=0.0, damping=3.0, k_m=30.0, as_published=True
    )
    own = {
        "array": pyramid(),
        "law": law,
        "delta": DELTA,
        "hdot": np.zeros(3),
        "dt": dt,
        "steps": steps,
        "spacecraft": Spacecraft(INERTIA, q_BN=Q),
        "controller": controllers.create("adaptive"),
        "reference": reference(dt, steps),
        "units": PUBLISHED,
        "wheel_speed": np.zeros(4),
    }
    return Setup(**own | changes)


@cache
def flown(dt: float = 0.01) -> Trajectory:
    return run(startup(dt))


@cache
def cut() -> Trajectory:
    """Return a run whose limits cut the torque of the first seconds."""
    law = laws.create("vscmg-weighted", k_m=30.0)
    array = pyramid(5.0, "scale", torque_limit=5e-3)
    weak = controllers.create("adaptive", kp=0.005, k=0.02)
    return run(startup(law=law, array=array, controller=weak))


def test_the_true_parameters_make_up_the_inertia(rng: np.random.Generator) -> None:
    unequal = Units(np.array([3.0, 4.0, 5.0, 6.0]) * 1e-3, 2.5e-3, rng.uniform(1e-3, 3e-3, 4))
    full = INERTIA + 1e-3 * np.array([[0, 1, 2], [1, 0, 3], [2, 3, 0]])
    for whole in (True, False):
        units = replace(unequal, inertia_includes_units=whole)
        setup = startup(units=units, spacecraft=Spacecraft(full, q_BN=Q))
        true, array = true_parameters(setup), setup.array
        plant = Plant(array, setup.units, rest_inertia(array, setup.units, full, DELTA))
        for delta in rng.uniform(-np.pi, np.pi, (5, 4)):
            s = array.wheel_axes(delta)
            inertia = plant.inertia(axes(array, delta))
            turning = (s * true.difference) @ s.T
            np.testing.assert_allclose(true.constant + turning, inertia, atol=1e-16)
            r = rng.normal(size=3)
            np.testing.assert_allclose(true.weighed(s[None], r[None]), r @ inertia @ r)
        if whole:
            at_start = true.weighed(array.wheel_axes(DELTA)[None], np.ones((1, 3)))
            np.testing.assert_allclose(at_start, np.sum(full))
        xx, yy, zz, xy, xz, yz = true.theta1[:6]
        entries = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]
        np.testing.assert_allclose(true.constant, entries, atol=1e-16)


def test_V_is_what_the_paper_says() -> None:
    """From the attitude by SciPy's rotations and the inertia of the equations of motion."""
    trajectory = flown()
    found, setup = monitor(trajectory), trajectory.setup
    plant = Plant(
        setup.array, setup.units, rest_inertia(setup.array, setup.units, INERTIA, setup.delta)
    )
    for k in (0, 37, 150, 700):
        q, row = trajectory.q_BN[k], setup.reference[k]
        body, wanted = (Rotation.from_quat([*v[1:], v[0]]) for v in (q, row[:4]))
        x, y, z, w = (wanted.inv() * body).as_quat(canonical=True)
        e = np.array([x, y, z])
        omega_R = body.inv().apply(wanted.apply(row[4:7]))
        r = trajectory.omega_BN_B[k] - omega_R + 0.5 * e
        J = plant.inertia(axes(setup.array, trajectory.delta[k]))
        true = true_parameters(setup)
        off = trajectory.estimates[k, :18] - np.concatenate([true.theta1, true.theta2])
        expected = e @ e + (1.0 - w) ** 2 + 0.5 * r @ J @ r + 0.5 * off @ off / 0.01
        np.testing.assert_allclose(found.V[k], expected, rtol=1e-12)


def test_the_bound_is_the_integral() -> None:
    trajectory = flown()
    found = monitor(trajectory)
    # V falls by r.(k r) + alpha kp e.e, and for small errors r and e are all that moves
    assert found.bound[0] == found.V[0] and np.all(np.diff(found.bound) <= 0.0)
    e2 = np.sum(trajectory.q_BR[:, 1:] ** 2, axis=1)
    r = trajectory.omega_BN_B + 0.5 * trajectory.q_BR[:, 1:]
    rough = np.trapezoid(0.5 * e2 + 0.05 * np.sum(r * r, axis=1), trajectory.t)
    np.testing.assert_allclose(found.V[0] - found.bound[-1], rough, rtol=1e-2)  # omega_R: 0.004


def test_V_falls_and_keeps_its_bound() -> None:
    found = monitor(flown())
    assert np.all(np.diff(found.V) <= 1e-9 * found.V[0]) and found.rise < 1e-9
    assert len(found.above) == 0 and found.applies
    assert found.V[-1] < 0.4 * found.V[0]
    assert found.words().endswith("All that the theorem assumes holds, but for continuous control.")
    assert [b.assumption for b in found.broken] == [SAMPLED]


def test_the_excess_is_of_first_order_in_the_period() -> None:
    coarse, fine = (np.max(monitor(flown(dt)).excess) for dt in (0.01, 0.005))
    assert 1.8 < coarse / fine < 2.3
    assert coarse < 0.03


@pytest.mark.slow
def test_the_excess_is_of_first_order_in_small_periods() -> None:
    most = [np.max(monitor(flown(dt)).excess) for dt in (0.005, 0.0025, 0.00125)]
    np.testing.assert_allclose([most[0] / most[1], most[1] / most[2]], 2.0, atol=0.06)


@dataclass(frozen=True)
class Backwards(Adaptive):
    """Adapts in the wrong direction."""

    def step(self, obs: Any, state: Any) -> Any:
        torque, new = Adaptive.step(self, obs, state)
        turned = new._replace(
            theta1=2.0 * state.theta1 - new.theta1, theta2=2.0 * state.theta2 - new.theta2
        )
        Y1 = self._regressor(obs, self._errors(obs))
        return torque + Y1 @ (new.theta1 - turned.theta1), turned


@dataclass(frozen=True)
class Weak(Adaptive):
    """Has a fifth of the gain k that it says."""

    def step(self, obs: Any, state: Any) -> Any:
        return Adaptive(k=0.2 * self.k, alpha=self.alpha, kp=self.kp).step(obs, state)


@dataclass(frozen=True)
class Slack(Adaptive):
    """Has half of the alpha that it says."""

    def step(self, obs: Any, state: Any) -> Any:
        return Adaptive(k=self.k, alpha=0.5 * self.alpha, kp=self.kp).step(obs, state)


@dataclass(frozen=True)
class Forgetful(Adaptive):
    """Learns theta_2 and does not use it."""

    def torque_matrix(self, obs: Any, state: Any) -> Any:
        return Adaptive.torque_matrix(self, obs, state._replace(theta2=0.0 * state.theta2))


@pytest.mark.parametrize(
    ("controller", "least"),
    [
        (Backwards, 2.0),
        (Weak, 0.5),
        pytest.param(Slack, 0.08, marks=pytest.mark.slow),
        pytest.param(Forgetful, 0.5, marks=pytest.mark.slow),
    ],
)
def test_a_planted_error_shows(controller: type[Adaptive], least: float) -> None:
    found = monitor(run(startup(controller=controller())))
    assert np.max(found.excess) > least
    assert 0.1 < found.above[0] < 2.0
    assert found.summary()["above_bound_from_s"] == found.above[0]
    assert "passes its bound" in found.words()


def test_torque_that_is_cut_is_told_with_its_times() -> None:
    trajectory = cut()
    found = monitor(trajectory)
    marked = trajectory.t[trajectory.limited > 0]
    assert 50 < len(marked) < 400  # the run starts at the limits and leaves them
    (told,) = [b for b in found.broken if b.assumption == "all torque asked for is given"]
    inside = [np.sum((a <= marked) & (marked < b - 1e-9)) for a, b in told.spans]
    assert min(inside) > 0 and sum(inside) == len(marked)
    np.testing.assert_allclose(told.seconds, 0.01 * len(marked))
    assert not found.applies and "cut by a limit" in found.words()
    assert len(found.above) and found.above[0] >= marked[0]
    assert found.gained_while_cut > 0.9 * np.max(found.excess)
    after = found.t > told.spans[-1, 1]
    rest = found.excess[after]
    assert np.ptp(rest) < 0.05 * np.max(found.excess)  # kept, once no limit cuts any more


def test_the_gimbals_acceleration_breaks_the_bound() -> None:
    found = monitor(run(startup(units=replace(PUBLISHED, terms="all"))))
    assert len(found.above) and not found.applies
    (told,) = [b for b in found.broken if b.assumption != SAMPLED]
    assert told.assumption == "gimbals accelerate without torque"
    assert told.spans.tolist() == [[0.0, 8.0]]


@pytest.mark.parametrize("gain", [0.0, pytest.param(0.05, marks=pytest.mark.slow)])
def test_a_constant_torque_from_outside_is_an_assumption_only_if_not_learned(gain: float) -> None:
    outside = Disturbance(np.array([0.05, -0.1, 0.02]))
    learner = controllers.create("adaptive", Gamma3=gain)
    found = monitor(run(startup(disturbance=outside, controller=learner)))
    assert found.applies == (gain > 0.0) == (len(found.above) == 0)
    if gain > 0.0:  # what is not known of the torque is part of V
        np.testing.assert_allclose(
            found.V[0] - monitor(flown()).V[0], 0.5 * 0.0129 / gain, rtol=1e-9
        )


def test_only_the_controllers_samples_count() -> None:
    setup = startup(seconds=0.4, period_steps=4, reference=None, target=Q)
    found = monitor(run(replace(setup, delay_steps=4), backend="python"))
    np.testing.assert_allclose(found.t, 0.04 * np.arange(11))
    kinds = [b.assumption for b in found.broken]
    assert kinds[:2] == [SAMPLED, "commands act at once"]
    assert "every 0.04 s" in found.broken[0].detail and "0.04 s" in found.broken[1].detail


def learning(**gains: float) -> dict[str, Any]:
    return {"controller": controllers.create("adaptive", **gains)}


BREACHES = {
    "parameters are learned": learning(Gamma1=0.0),
    "parameters lie within the projection's bounds": learning(inertia_bound=0.05),
    "rates and accelerations are as commanded": {
        "units": replace(PUBLISHED, terms="all", drive="torque")
    },
    "measurements are exact": {"sensors": Sensors(gyro_bias=np.array([1e-3, 0.0, 0.0]))},
    "axes and wheels are known": {"plant": pyramid()},
    "every motor works": {"events": (Event("wheel-dead", 2, 0.02),)},
    "no torque from outside": {"desaturation": Desaturation(1e-3)},
    "gimbals turn freely": {
        "array": pyramid().altered(angle_limits=np.array([[-0.6, 0.6]] * 4)),
        "delta": np.full(4, 0.6),
    },
    "the error stays within half a turn": {
        "spacecraft": Spacecraft(INERTIA, [1e-4, 1.0, 0.0, 0.0], np.array([1.0, 0.0, 0.0])),
        "reference": None,
        "target": np.array([1.0, 0.0, 0.0, 0.0]),
    },
}


@pytest.mark.parametrize("assumption", BREACHES)
def test_what_the_theorem_assumes_is_checked(assumption: str) -> None:
    found = monitor(run(startup(seconds=0.04, **BREACHES[assumption]), backend="python"))
    told = [b for b in found.broken if b.assumption == assumption]
    assert len(told) == 1 and not found.applies
    assert np.all(told[0].spans[:, 0] < told[0].spans[:, 1]) and told[0].spans[-1, 1] <= 0.04
    assert f"{assumption} ({told[0].detail}" in found.words()
    if assumption == "every motor works":
        assert told[0].spans.tolist() == [[0.02, 0.04]]


def test_a_changing_disturbance_is_told_even_if_a_torque_is_learned() -> None:
    wave = Disturbance(amplitude=np.array([1e-3, 0.0, 0.0]), frequency=1.0)
    found = monitor(
        run(startup(seconds=0.04, disturbance=wave, **learning(Gamma3=0.1)), backend="python")
    )
    assert "a changing disturbance" in found.words()


def test_an_attitude_that_is_held_stays_within_the_bound() -> None:
    """Its errors are made by sampling alone."""
    found = monitor(run(startup(seconds=4.0, reference=None, target=Q)))
    assert 0.0 < np.max(found.tracking) < found.settled
    assert len(found.above) == 0


def test_the_summary_is_plain_numbers() -> None:
    for found in (monitor(flown()), monitor(cut())):
        record = json.loads(json.dumps(found.summary(), allow_nan=False))
        assert record["theorem_applies"] is found.applies
        assert record["V_start_Nm"] == found.V[0] and record["V_end_Nm"] == found.V[-1]
        assert len(record["assumptions_broken"]) == len(found.broken)
        assert 0.0 <= record["above_bound_share_of_time"] <= 1.0


def test_numbers_that_are_none_count_as_above() -> None:
    found = monitor(flown())
    lost = replace(found, V=np.where(found.t > 3.0, np.nan, found.V))
    assert isinstance(lost, LyapunovMonitor)
    np.testing.assert_allclose(lost.above[0], 3.01)


def test_refusals() -> None:
    other = controllers.create("quaternion-feedback", kp=0.1, kw=0.1)
    trajectory = run(startup(seconds=0.02, controller=other), backend="python")
    with pytest.raises(InputError, match="'adaptive'"):
        monitor(trajectory)
    for wrong in (0.0, -1.0, np.nan):
        with pytest.raises(InputError, match="tolerance"):
            monitor(flown(), tolerance=wrong)
