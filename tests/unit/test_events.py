"""Faults: what they do to the array, what the law knows of them, what becomes of a slew."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
import pytest

import nullmotion as nm
from nullmotion.errors import InputError
from nullmotion.sim import Setup, Trajectory, run
from nullmotion.spacecraft import Event, Servo, Spacecraft, controllers

SLOW = pytest.mark.slow
INERTIA = np.array([[12.0, -1.5, 0.8], [-1.5, 9.0, 1.1], [0.8, 1.1, 14.0]])
KP, KW = 4.0, 12.0


@dataclass(frozen=True)
class Tell(nm.Law):
    """Asks for rates that tell something of the array that the law is given."""

    name: ClassVar[str] = "test-tell"
    what: str = "h0"

    def step(self, array: Any, obs: Any, state: Any) -> Any:
        bias = np.array([*array.momentum_bias, 0.0])
        told = {"h0": array.h0, "bias": bias, "rate_limit": array.rate_limit}[self.what]
        return np.array(list(told)), state


def told(what: str, event: Event, **more: Any) -> Trajectory:
    """Return 1 s of a run at 0.01 s of gimbals that (almost) stand still."""
    array = nm.layouts.pyramid(h0=[1.0, 2.0, 3.0, 4.0], rate_limit=1e-9)
    delta = np.array([0.3, -0.4, 0.5, 0.9])
    return run(
        Setup(array, Tell(what), delta, np.zeros(3), steps=100, events=(event,), **more),
        backend="python",
    )


def test_a_stuck_cmg_is_known_when_it_is_found() -> None:
    """Then it has no momentum to steer with, and what it holds is a bias."""
    event = Event("stuck", 2, 0.3, 0.25)
    h0 = told("h0", event).rates_asked[:100]
    np.testing.assert_allclose(h0[:55], np.tile([1.0, 2.0, 3.0, 4.0], (55, 1)), rtol=1e-15)
    np.testing.assert_allclose(h0[55:], np.tile([1.0, 2.0, 0.0, 4.0], (45, 1)), rtol=1e-15)
    bias = told("bias", event).rates_asked[:100, :3]
    skew = np.radians(54.73)  # the third CMG: s = -y, t = (cos skew, 0, sin skew)
    held = 3.0 * np.array([np.cos(skew) * np.sin(0.5), -np.cos(0.5), np.sin(skew) * np.sin(0.5)])
    np.testing.assert_allclose(bias[:55], 0.0, atol=1e-15)
    np.testing.assert_allclose(bias[55:], np.tile(held, (45, 1)), atol=1e-8)


def test_a_wheel_that_spins_down_is_known_when_it_is_found() -> None:
    result = told("h0", Event("spin-down", 1, 0.2, 0.3, 0.0, 0.4, 0.25))
    t = result.t[:100]
    left = 0.25 + 0.75 * np.exp(-(t - 0.2) / 0.4)
    expected = np.where(t > 0.495, 2.0 * left, 2.0)
    np.testing.assert_allclose(result.rates_asked[:100, 1], expected, rtol=1e-14)
    np.testing.assert_allclose(
        result.rates_asked[:100, [0, 2, 3]], np.tile([1.0, 3.0, 4.0], (100, 1))
    )


@pytest.mark.parametrize(
    ("kind", "what"), [("stuck", "bias"), ("slow", "rate_limit"), ("spin-down", "h0")]
)
def test_what_is_never_found_is_never_known(kind: Any, what: str) -> None:
    event = Event(kind, 2, 0.3, np.inf, 1e-10, 0.4, 0.5)
    asked = told(what, event).rates_asked[:100]
    np.testing.assert_array_equal(asked, np.tile(asked[0], (100, 1)))


def test_a_slow_gimbal_turns_at_its_limit() -> None:
    """Until it is found the others go on; then all are scaled to it."""
    array = nm.layouts.pyramid(rate_limit=1.0)
    event = Event("slow", 3, 0.3, 0.25, rate_limit=0.1)
    what = Setup(array, Tell("h0"), np.zeros(4), np.zeros(3), steps=100, events=(event,))
    rates = run(what, backend="python").rates[:100]
    np.testing.assert_allclose(rates[:30], 1.0)
    np.testing.assert_allclose(rates[30:55], np.tile([1.0, 1.0, 1.0, 0.1], (25, 1)))
    np.testing.assert_allclose(rates[55:], 0.1)
    limits = told("rate_limit", Event("slow", 3, 0.3, 0.25, 1e-10)).rates_asked[:100, 3]
    np.testing.assert_allclose(limits, np.where(np.arange(100) < 55, 1e-9, 1e-10))


def test_several_faults_of_one_cmg_add_up() -> None:
    array = nm.layouts.pyramid(rate_limit=1.0)
    events = (
        Event("slow", 0, 0.2, 0.0, rate_limit=0.5),
        Event("slow", 0, 0.4, 0.0, rate_limit=0.2),
        Event("stuck", 0, 0.6, 0.0),
        Event("spin-down", 0, 0.2, 0.0, time_constant=0.5, final_fraction=0.5),
        Event("spin-down", 0, 0.4, 0.0, time_constant=0.3),
    )
    law = nm.laws.create("sr")
    what = Setup(array, law, np.zeros(4), np.array([0.0, 0.0, 2.0]), steps=100, events=events)
    result = run(what)
    rates = np.abs(result.rates[:100, 0])
    assert rates[:20].min() > 0.55 and rates[20:40].max() <= 0.5 and rates[40:60].max() <= 0.2
    assert (rates[60:] == 0).all()
    t = 1.0
    left = (0.5 + 0.5 * np.exp(-(t - 0.2) / 0.5)) * np.exp(-(t - 0.4) / 0.3)
    others = nm.layouts.pyramid(h0=[left, 1.0, 1.0, 1.0]).momentum(result.delta[-1])
    np.testing.assert_allclose(result.momentum[-1], others, rtol=1e-13)


def slew(n: int, *events: Event, steps: int = 6000, **more: Any) -> Trajectory:
    """Return a slew of 74 deg by a pyramid of n CMGs."""
    base = {
        "dt": 0.01,
        "steps": steps,
        "spacecraft": Spacecraft(INERTIA),
        "controller": controllers.create("quaternion-feedback", kp=KP, kw=KW),
        "target": np.array([0.8, 0.4, -0.3, 0.33]),
        "events": events,
    }
    array, law = nm.layouts.pyramid(n=n, rate_limit=1.0), nm.laws.create("sr")
    return run(Setup(array, law, np.zeros(n), np.zeros(3), **{**base, **more}))


def settled(result: Trajectory) -> float:
    """Return the greatest pointing error of the last 10 s [deg]."""
    assert result.pointing_error is not None
    assert np.isfinite(result.delta).all() and np.isfinite(result.omega_BN_B).all()
    return float(np.degrees(result.pointing_error[-1000:].max()))


@pytest.mark.parametrize("found", [0.5, np.inf])
@pytest.mark.parametrize(
    ("n", "cmg"), [(5, 0), *[pytest.param(n, 3 if n == 6 else 1, marks=SLOW) for n in (4, 5, 6)]]
)
def test_a_gimbal_sticks_in_the_middle_of_a_slew(n: int, cmg: int, found: float) -> None:
    """The slew settles all the same.

    What is not found is a gimbal that does not follow: the feedback makes up for it.
    """
    result = slew(n, Event("stuck", cmg, 2.0, found))
    turning = np.flatnonzero(np.diff(result.delta[:, cmg]))
    assert turning.max() == 199 and abs(result.delta[-1, cmg]) > 0.1
    assert settled(result) < 0.1
    used = np.abs(result.rates_asked[:-1, cmg])
    if found < 1:
        assert used[200:250].min() > 1e-6 and (used[250:] == 0).all()
    else:
        assert (used[200:2000] > 0).all()


def test_four_cmgs_of_which_one_sticks() -> None:
    """Three are left, and enough if the law knows it.

    Else what it asks of the fourth is missing: of four CMGs the feedback cannot always make
    up for that. Here the spacecraft turns away from the target and comes back after minutes.
    """
    assert settled(slew(4)) < 0.1
    assert settled(slew(4, Event("stuck", 3, 2.0, 0.5))) < 0.1
    untold = slew(4, Event("stuck", 3, 2.0, np.inf), steps=20000)
    assert settled(untold) < 0.1
    assert np.degrees(untold.pointing_error[1000:].max()) > 90.0


def commanded(result: Trajectory, momentum: np.ndarray) -> np.ndarray:
    """Return hdot = -T - omega x h of quaternion feedback, written again."""
    assert result.q_BR is not None and result.omega_BN_B is not None
    feedback = -KP * result.q_BR[:, 1:] - KW * result.omega_BN_B
    compensated: np.ndarray = -feedback - np.cross(result.omega_BN_B, momentum)
    return compensated


def test_the_command_reckons_with_what_a_stuck_cmg_holds() -> None:
    result = slew(5, Event("stuck", 3, 2.0, 0.5), steps=1000)
    np.testing.assert_allclose(result.hdot, commanded(result, result.momentum), atol=1e-12)
    assert np.abs(np.cross(result.omega_BN_B, result.momentum)).max() > 0.02


def test_the_command_reckons_with_a_spin_down_once_found() -> None:
    result = slew(5, Event("spin-down", 3, 2.0, 1.5, time_constant=3.0), steps=1000)
    right = commanded(result, result.momentum)
    nominal = commanded(result, result.setup.array.momentum(result.delta))
    np.testing.assert_allclose(result.hdot[:350], nominal[:350], atol=1e-12)
    np.testing.assert_allclose(result.hdot[350:], right[350:], atol=1e-12)
    assert np.abs(right - nominal)[300:350].max() > 1e-3


@pytest.mark.parametrize("at", [0.9951, pytest.param(1.0, marks=SLOW)])
def test_momentum_of_a_wheel_that_spins_down(at: float) -> None:
    """From the first step that starts at or after the time; the body gets the rest."""
    event = Event("spin-down", 2, at, np.inf, time_constant=5.0, final_fraction=0.2)
    result = slew(4, event, steps=1000)
    left = np.where(result.t < 0.999, 1.0, 0.2 + 0.8 * np.exp(-(result.t - 1.0) / 5.0))
    parts = result.setup.array.rotor_momenta(result.delta)
    parts[:, 2] *= left[:, None]
    np.testing.assert_allclose(result.momentum, parts.sum(axis=1), atol=1e-13)
    total = result.inertial_momentum
    assert total is not None
    np.testing.assert_allclose(total, np.tile(total[0], (1001, 1)), atol=1e-9)


def test_a_stuck_gimbal_of_a_servo_stops_within_a_step() -> None:
    result = slew(5, Event("stuck", 3, 2.0, 0.5), steps=400, servo=Servo(0.05, inertia=0.02))
    assert result.speed is not None
    assert abs(result.speed[200, 3]) > 0.05
    assert np.abs(result.speed[201:, 3]).max() < 1e-15
    assert np.ptp(result.delta[201:, 3]) < 1e-15


@pytest.mark.parametrize(
    ("key", "values"),
    [
        ("event.kind", {"kind": "lost"}),
        ("event.at", {"at": -1.0}),
        ("event.at", {"at": np.nan}),
        ("event.detected_after", {"detected_after": -0.1}),
        ("event.rate_limit", {"kind": "slow"}),
        ("event.time_constant", {"kind": "spin-down", "time_constant": 0.0}),
        ("event.final_fraction", {"kind": "spin-down", "final_fraction": 1.1}),
    ],
)
def test_an_event_refuses(key: str, values: dict[str, Any]) -> None:
    with pytest.raises(InputError, match=key):
        Event(**{"kind": "stuck", "cmg": 0, "at": 1.0} | values)


def test_a_setup_refuses_a_cmg_that_is_not_there() -> None:
    with pytest.raises(InputError, match=r"event\.cmg"):
        told("h0", Event("stuck", 4, 1.0))
