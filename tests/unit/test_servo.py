"""The gimbal servo against hand-computed answers and bounds."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
import pytest

import nullmotion as nm
from nullmotion import ops
from nullmotion.sim import Setup, Trajectory, run
from nullmotion.spacecraft import Servo, Spacecraft, controllers

DT = 0.01


@dataclass(frozen=True)
class Given(nm.Law):
    """Rates that are a share of a sine for each gimbal, or constant."""

    name: ClassVar[str] = "test-given"
    rates: Any = ()
    frequency: float = 0.0

    def step(self, array: Any, obs: Any, state: Any) -> Any:
        return self.rates * ops.cos(self.frequency * obs.t), state


def turned(servo: Servo | None, rates: Any, frequency: float = 0.0, **more: Any) -> Trajectory:
    """Return a run of the gimbals alone."""
    array = nm.layouts.pyramid(**more.pop("array", {}))
    law = Given(np.array(rates, float), frequency)
    base = {"dt": DT, "steps": 200, "servo": servo}
    return run(Setup(array, law, np.zeros(4), np.zeros(3), **{**base, **more}), backend="python")


RATES = [0.5, -0.8, 0.3, 1.1]


def test_a_servo_without_values_is_half_a_step_late() -> None:
    """Its rate ramps to the command within the step: the angle lags by dt/2 times the rate."""
    ideal, ramped = turned(None, RATES, 3.0), turned(Servo(), RATES, 3.0)
    assert ideal.speed is not None and ramped.speed is not None
    np.testing.assert_allclose(ramped.speed[1:], ideal.speed[:-1], rtol=0, atol=1e-14)
    late = 0.5 * DT * ideal.rates[:-1]
    np.testing.assert_allclose(ramped.delta[1:], ideal.delta[1:] - late, rtol=0, atol=1e-13)


def test_first_order_lag_is_the_exact_exponential() -> None:
    """At the samples, whatever the step; a time constant for each CMG."""
    lags = np.array([0.05, 0.2, 1.0, 0.003])
    result = turned(Servo(time_constant=lags), RATES)
    assert result.speed is not None
    exact = np.array(RATES) * (1.0 - np.exp(-result.t[:, None] / lags))
    np.testing.assert_allclose(result.speed, exact, rtol=0, atol=1e-13)
    behind = np.array(RATES) * (result.t[-1] - lags * (1.0 - np.exp(-result.t[-1] / lags)))
    np.testing.assert_allclose(result.delta[-1], behind, rtol=0, atol=1.2 * DT)
    np.testing.assert_allclose(result.delta[-1, 2], behind[2], rtol=0, atol=1e-5)


def test_acceleration_limit() -> None:
    result = turned(Servo(acceleration_limit=[0.4, 0.5, 2.0, 0.55]), RATES)
    assert result.speed is not None
    t = result.t[:, None]
    ramp = np.minimum(np.abs(RATES), np.array([0.4, 0.5, 2.0, 0.55]) * t) * np.sign(RATES)
    np.testing.assert_allclose(result.speed, ramp, rtol=0, atol=1e-12)
    way = 0.5 * 0.55 * 2.0**2  # the last has just reached 1.1 rad/s after 2 s
    assert result.delta[-1, 3] == pytest.approx(way, abs=1e-12)


def test_rate_limit_of_the_drive() -> None:
    """Whatever the array allows to ask."""
    result = turned(Servo(time_constant=0.1, rate_limit=[0.4, 0.5, 1.0, 0.2]), RATES)
    assert result.speed is not None
    np.testing.assert_allclose(result.speed[-1], [0.4, -0.5, 0.3, 0.2], rtol=1e-8)
    assert (np.abs(result.speed).max(axis=0) <= [0.4, 0.5, 1.0, 0.2]).all()


def test_torque_limit_slows_the_start() -> None:
    """0.02 N m on 0.05 kg m^2: 0.4 rad/s^2, nothing else turns."""
    result = turned(Servo(torque_limit=0.02, inertia=0.05), RATES)
    assert result.speed is not None and result.motor_torque is not None
    ramp = np.minimum(np.abs(RATES), 0.4 * result.t[:, None]) * np.sign(RATES)
    np.testing.assert_allclose(result.speed, ramp, rtol=0, atol=1e-12)
    assert np.abs(result.motor_torque[:-1]).max() == pytest.approx(0.02)


def spinning(servo: Servo | None, rate: float, **more: Any) -> Trajectory:
    """Return a run whose body, too heavy to notice, turns about x; the gimbals are asked to rest.

    At zero angles c_i = h0 t_i: with skew 54.73 deg the torque omega . c_i about gimbals 1 and 3
    is -+ h0 cos(skew) rate, about gimbals 2 and 4 nothing.
    """
    craft = Spacecraft(np.full(3, 1e9), omega_BN_B=np.array([rate, 0.0, 0.0]))
    base = {
        "spacecraft": craft,
        "controller": controllers.create("quaternion-feedback", kp=1e-9, kw=1e-9),
        "target": np.array([1.0, 0.0, 0.0, 0.0]),
    }
    return turned(servo, np.zeros(4), **{**base, **more})


def test_a_saturated_motor_is_driven_back_by_the_body() -> None:
    """Gimbal 1 sees -0.0577 N m, its motor holds 0.05 N m: it falls at the rest over I."""
    skew, rate, inertia = np.radians(54.73), 0.1, 0.5
    held = spinning(Servo(torque_limit=0.06, inertia=inertia), rate)
    assert np.abs(held.delta).max() < 1e-12
    assert held.motor_torque is not None
    np.testing.assert_allclose(
        held.motor_torque[0], [np.cos(skew) * rate, 0, -np.cos(skew) * rate, 0], atol=1e-12
    )
    result = spinning(Servo(torque_limit=0.05, inertia=inertia), rate, steps=20)
    fall = (0.05 - np.cos(skew) * rate) / inertia
    assert result.speed is not None
    np.testing.assert_allclose(result.speed[-1], [0.2 * fall, 0, -0.2 * fall, 0], atol=1e-9)
    assert np.sign(fall) == -1


def test_friction_holds_a_gimbal() -> None:
    """The drive's first torque I u (1 - exp(-dt/tau)) / dt must exceed the friction.

    As dt goes to 0: |u| > friction tau / I = 0.02 rad/s; at 0.01 s within a step of it. A gimbal
    that moves settles that much below its command.
    """
    servo = Servo(time_constant=0.1, friction=0.01, inertia=0.05)
    threshold = 0.01 * DT / (0.05 * (1.0 - np.exp(-DT / 0.1)))
    assert threshold == pytest.approx(0.02, rel=0.06)
    result = turned(servo, [0.0199, -0.99 * threshold, 1.01 * threshold, 0.5], steps=500)
    assert result.speed is not None
    assert (result.delta[:, :2] == 0).all()
    np.testing.assert_allclose(result.speed[-1, 2:], [0.01 * threshold, 0.5 - threshold], rtol=1e-9)


def test_friction_holds_against_the_body() -> None:
    """A motor at its limit and the friction together: 0.05 + 0.01 N m hold 0.0577 N m."""
    servo = Servo(torque_limit=0.05, friction=0.01, inertia=0.5)
    assert np.abs(spinning(servo, 0.1).delta).max() == 0


def test_an_encoder_reads_multiples_of_its_step() -> None:
    step = 0.03
    result = turned(Servo(time_constant=0.3, encoder_resolution=step), RATES, steps=300)
    ideal = turned(Servo(time_constant=0.3), RATES, steps=300)
    off = np.abs(result.delta - ideal.delta).max()
    assert 1e-3 < off < step  # the bound: a first-order lag of what the encoder hides


INERTIA, KP, KW = 10.0, 4.0, 14.0  # kg m^2, N m, N m s: overdamped


def slew(servo: Servo | None, seconds: float = 120.0, **more: Any) -> Trajectory:
    """Return a slew of 20 deg from rest to rest: J omega_dot = -kp q_v - kw omega."""
    axis = np.array([2.0, -1.0, 2.0]) / 3.0
    base = {
        "dt": DT,
        "steps": round(seconds / DT),
        "servo": servo,
        "spacecraft": Spacecraft(np.full(3, INERTIA)),
        "controller": controllers.create("quaternion-feedback", kp=KP, kw=KW),
        "target": np.array([np.cos(np.radians(10)), *np.sin(np.radians(10)) * axis]),
    }
    array, law = nm.layouts.pyramid(h0=1.0), nm.laws.create("pseudo-inverse")
    return run(Setup(array, law, np.zeros(4), np.zeros(3), **{**base, **more}))


LAG = 0.05


def poles() -> np.ndarray:
    """Return -p of J s^2 (tau s + 1) + kw s + kp / 2, small first; all real."""
    roots = np.roots([INERTIA * LAG, INERTIA, KW, 0.5 * KP])
    assert np.isreal(roots).all() and (roots < 0).all()
    p: np.ndarray = np.sort(-roots.real)
    return p


def test_friction_leaves_a_pointing_error() -> None:
    """Within what can be computed by hand, and far more than without friction.

    Whether a gimbal slides or sticks, friction is a torque f_i of at most T_c on it:
    tau v' = u - v - tau f / I. To the frictionless servo's rate it adds what the lag
    1/(tau s + 1) makes of tau f / I, at most u_c = T_c tau / I; to the torque on the body at
    most d = sum h0_i u_c. The body's small angle obeys

        J theta'' = -(kp theta / 2 + kw theta') lagged + d,
        theta = (tau s + 1) d / (J s^2 (tau s + 1) + kw s + kp / 2),

    and (tau s + 1) d = tau A f / I. The three poles are real and there is no zero, so the
    impulse response has one sign and theta is at most the gain at s = 0 times the bound of
    the input: 2 d / kp.
    """
    inertia, friction = 0.05, 2e-4
    poles()
    worn = slew(Servo(LAG, friction=friction, inertia=inertia))
    new = slew(Servo(LAG, inertia=inertia))
    bound = 2.0 * 4 * 1.0 * (friction * LAG / inertia) / KP
    assert worn.pointing_error is not None and new.pointing_error is not None
    late = worn.pointing_error[worn.t > 80.0]
    assert new.pointing_error[-1] < 1e-6
    assert late.max() < bound
    assert late.min() > 1e-2 * bound and late.min() > 10 * new.pointing_error[-1]


def test_an_encoder_leaves_a_limit_cycle() -> None:
    """Of an amplitude within what can be computed by hand.

    The encoder is off by e, at most half its step q. The drive takes its rate from it:
    tau v' + v = u - e', so that the angle is off by what the lag makes of -e and the
    momentum by A e / (tau s + 1), the law's own use of the reading being second order.
    With J theta' = -(momentum of the array):

        theta = s A e / (J s^2 (tau s + 1) + kw s + kp / 2)
              = 1 / (J tau p3) * [s / ((s + p1)(s + p2))] * [p3 / (s + p3)] * A e.

    The greatest amplitude is that of the input, sum h0_i q / 2, times the L1 norm of the
    impulse response. That of the second bracket is 1. That of the first is the derivative of
    (exp(-p1 t) - exp(-p2 t)) / (p2 - p1), which rises from 0 to its maximum at
    t = ln(p2 / p1) / (p2 - p1) and falls to 0: twice the maximum.
    """
    q = 1e-3
    p1, p2, p3 = poles()
    t = np.log(p2 / p1) / (p2 - p1)
    gain = 2.0 * (np.exp(-p1 * t) - np.exp(-p2 * t)) / (p2 - p1) / (INERTIA * LAG * p3)
    result = slew(Servo(LAG, encoder_resolution=q), 200.0)
    assert result.pointing_error is not None
    late = result.pointing_error[result.t > 100.0]
    assert 1e-6 < late.max() < 4 * 1.0 * 0.5 * q * gain
    before, after = late[: len(late) // 2].max(), late[len(late) // 2 :].max()
    assert 0.5 < after / before < 2.0  # it goes on
    assert 0 < np.ptp(result.delta[result.t > 150.0], axis=0).max() < q
