"""Attitude runs against an independent integration with SciPy.

The equations are written again here, and in another form: the total angular momentum is balanced
in the inertial frame, the attitude is a direction cosine matrix, and each CMG's momentum is its
spin axis turned by Rodrigues' formula. Only the history of the gimbal rates is taken from the run.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, ClassVar

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

import nullmotion as nm
from nullmotion.sim import Setup, Trajectory, run
from nullmotion.spacecraft import Disturbance, Event, Orbit, Servo, Spacecraft, controllers

SLOW = pytest.mark.slow
INERTIA = np.array([[12.0, -1.5, 0.8], [-1.5, 9.0, 1.1], [0.8, 1.1, 14.0]])
INVERSE = np.linalg.inv(INERTIA)
START = np.array([0.9, 0.1, -0.3, 0.2]) / np.linalg.norm([0.9, 0.1, -0.3, 0.2])
TARGET = np.array([0.8, 0.4, -0.3, 0.33])
RATE = np.array([0.02, -0.03, 0.01])
ORBIT = {
    "rate": 0.05,  # rad/s: fast, so that the gravity gradient counts
    "inclination": 0.7,
    "ascending_node": 0.4,
    "argument_of_latitude": 1.1,
}
PLANE = Rotation.from_euler("ZXZ", [0.4, 0.7, 1.1]).as_matrix()  # node, inclination, latitude
CONSTANT, AMPLITUDE, FREQUENCY, PHASE = (
    np.array([0.02, -0.01, 0.03]),
    np.array([0.05, 0.04, -0.06]),
    0.21,
    0.6,
)
OUTSIDE = Disturbance(CONSTANT, AMPLITUDE, FREQUENCY, PHASE, Orbit(**ORBIT))


def cross_matrix(v: np.ndarray) -> np.ndarray:
    return np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])


def outside_torque(t: float, to_body: np.ndarray) -> np.ndarray:
    """Constant, sinusoid and gravity gradient in B."""
    place = PLANE @ [np.cos(ORBIT["rate"] * t), np.sin(ORBIT["rate"] * t), 0.0]
    nadir = -to_body @ place
    gradient = 3.0 * ORBIT["rate"] ** 2 * np.cross(nadir, INERTIA @ nadir)
    return CONSTANT + AMPLITUDE * np.sin(2.0 * np.pi * FREQUENCY * t + PHASE) + gradient


@dataclass
class Truth:
    """Angular momentum balance in N: d/dt [C (J omega + h + sum I delta_dot g)] = C T."""

    array: nm.CmgArray
    outside: bool = False
    gimbal_inertia: float = 0.0
    wheel: Callable[[int, float], float] = lambda i, t: 1.0

    def __post_init__(self) -> None:
        """Rodrigues: an axis s turned about g is s + sin(delta) K s + (1 - cos(delta)) K K s."""
        self.g, self.s = self.array.gimbal_axes, self.array.spin_axes
        self.ks = np.array([cross_matrix(g) @ s for g, s in zip(self.g, self.s, strict=True)])
        self.kks = np.array([cross_matrix(g) @ v for g, v in zip(self.g, self.ks, strict=True)])
        self.h0 = np.broadcast_to(self.array.h0, len(self.g))

    def stored(self, t: float, delta: np.ndarray, rates: np.ndarray) -> np.ndarray:
        """Momentum of wheels and gimbals relative to the body, in B."""
        h = [h0 * self.wheel(i, t) for i, h0 in enumerate(self.h0)]
        wheels = h @ self.s + (h * np.sin(delta)) @ self.ks + (h * (1 - np.cos(delta))) @ self.kks
        total: np.ndarray = wheels + self.gimbal_inertia * (rates @ self.g)
        return total

    def fly(
        self, start: Trajectory, segments: list[tuple[float, np.ndarray, np.ndarray]]
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return C_NB and omega at the end.

        Args:
            start: Where attitude, rate and gimbal angles at t = 0 come from.
            segments: Length in time, gimbal rates at the start, gimbal accelerations.
        """
        assert start.q_BN is not None and start.omega_BN_B is not None
        to_inertial = Rotation.from_quat(np.roll(start.q_BN[0], -1)).as_matrix()
        delta, t = start.delta[0].copy(), 0.0
        first = INERTIA @ start.omega_BN_B[0] + self.stored(0.0, delta, segments[0][1])
        y = np.concatenate([to_inertial.ravel(), to_inertial @ first])
        omega = start.omega_BN_B[0]
        for length, rates, accelerations in segments:
            flow = self.flow(t, delta, rates, accelerations)
            y = solve_ivp(flow, (t, t + length), y, "DOP853", rtol=1e-12, atol=1e-13).y[:, -1]
            delta = delta + length * rates + 0.5 * length**2 * accelerations
            t += length
            omega = self.rate(t, y, delta, rates + length * accelerations)
        return y[:9].reshape(3, 3), omega

    def rate(self, t: float, y: np.ndarray, delta: np.ndarray, rates: np.ndarray) -> np.ndarray:
        total = y[:9].reshape(3, 3).T @ y[9:]
        omega: np.ndarray = INVERSE @ (total - self.stored(t, delta, rates))
        return omega

    def flow(self, start: float, delta: np.ndarray, rates: np.ndarray, accelerations: Any) -> Any:
        def slope(t: float, y: np.ndarray) -> np.ndarray:
            since, to_inertial = t - start, y[:9].reshape(3, 3)
            now = rates + since * accelerations
            angles = delta + since * rates + 0.5 * since**2 * accelerations
            omega = self.rate(t, y, angles, now)
            torque = outside_torque(t, to_inertial.T) if self.outside else np.zeros(3)
            turning = to_inertial @ cross_matrix(omega)
            return np.concatenate([turning.ravel(), to_inertial @ torque])

        return slope


def held(result: Trajectory) -> list[tuple[float, np.ndarray, np.ndarray]]:
    """Return segments of constant rates: neighbouring steps with the same ones are one."""
    rates = result.rates[:-1]
    edges = np.flatnonzero(np.any(rates[1:] != rates[:-1], axis=1)) + 1
    edges = np.concatenate([[0], edges, [len(rates)]])
    return [
        ((b - a) * result.setup.dt, rates[a], np.zeros(rates.shape[1])) for a, b in pairwise(edges)
    ]


def ramps(result: Trajectory) -> list[tuple[float, np.ndarray, np.ndarray]]:
    """Return one segment a step: the rate at its start and what makes its mean rate."""
    assert result.speed is not None
    dt = result.setup.dt
    return [
        (dt, speed, 2.0 * (mean - speed) / dt)
        for speed, mean in zip(result.speed[:-1], result.rates[:-1], strict=True)
    ]


def error(result: Trajectory, truth: tuple[np.ndarray, np.ndarray]) -> tuple[float, float]:
    """Return the greatest errors of the final C_NB and omega."""
    assert result.q_BN is not None and result.omega_BN_B is not None
    attitude = Rotation.from_quat(np.roll(result.q_BN[-1], -1)).as_matrix()
    return np.abs(attitude - truth[0]).max(), np.abs(result.omega_BN_B[-1] - truth[1]).max()


def slew(array: nm.CmgArray, **more: Any) -> Setup:
    """Return a slew of 40 deg from a body rate, by quaternion feedback and SR."""
    base = {
        "law": nm.laws.create("sr"),
        "delta": np.zeros(array.n),
        "hdot": np.zeros(3),
        "dt": 0.002,
        "steps": 10000,
        "period_steps": 200,
        "spacecraft": Spacecraft(INERTIA, START, RATE),
        "controller": controllers.create("quaternion-feedback", kp=4.0, kw=12.0),
        "target": TARGET,
    }
    return Setup(array, **{**base, **more})


def pyramid(**more: Any) -> nm.CmgArray:
    return nm.layouts.pyramid(**{"h0": 1.5, "rate_limit": 1.0, **more})


def roof6() -> nm.CmgArray:
    return nm.layouts.roof6(h0=[1.0, 0.8, 1.2, 1.5, 0.7, 1.1], rate_limit=1.0)


HOME6 = np.tile(2 * np.pi * np.arange(3) / 3, 2)


@pytest.mark.parametrize(
    ("make", "delta"), [(pyramid, np.zeros(4)), pytest.param(roof6, HOME6, marks=SLOW)]
)
def test_slew_under_torques_from_outside(make: Any, delta: np.ndarray) -> None:
    array = make()
    result = run(slew(array, delta=delta, disturbance=OUTSIDE))
    moved = np.degrees(np.ptp(result.delta, axis=0))
    assert moved.max() > 30 and np.degrees(result.pointing_error[0]) > 39
    attitude, rate = error(result, Truth(array, outside=True).fly(result, held(result)))
    assert attitude < 1e-9 and rate < 1e-9
    quiet = Truth(array).fly(result, held(result))  # the torques from outside do count
    assert min(error(result, quiet)) > 1e-3


def test_gimbals_of_a_servo_react_on_the_body() -> None:
    array, inertia = pyramid(), 0.2
    servo = Servo(time_constant=0.1, inertia=inertia, acceleration_limit=3.0, rate_limit=0.9)
    what = slew(array, servo=servo, dt=0.02, steps=150, period_steps=5, disturbance=OUTSIDE)
    result = run(what)
    truth = Truth(array, outside=True, gimbal_inertia=inertia)
    attitude, rate = error(result, truth.fly(result, ramps(result)))
    assert attitude < 1e-8 and rate < 1e-8
    light = Truth(array, outside=True).fly(result, ramps(result))  # the gimbals do count
    assert min(error(result, light)) > 1e-5


@pytest.mark.parametrize("at", [3.0999, *[pytest.param(at, marks=SLOW) for at in (3.0, 3.1)]])
def test_momentum_of_a_wheel_that_stops_goes_to_the_body(at: float) -> None:
    array = pyramid()
    event = Event("spin-down", 2, at, np.inf, time_constant=2.5, final_fraction=0.3)
    what = slew(array, delta=np.radians([10.0, 40.0, -20.0, 60.0]), events=(event,), steps=5000)
    result = run(what)
    begin = 3.0 if at == 3.0 else 3.1  # with the first step from then on

    def left(i: int, t: float) -> float:
        return 0.3 + 0.7 * np.exp(-max(t - begin, 0.0) / 2.5) if i == 2 else 1.0

    attitude, rate = error(result, Truth(array, wheel=left).fly(result, held(result)))
    assert attitude < 1e-9 and rate < 1e-9
    kept = Truth(array).fly(result, held(result))
    assert min(error(result, kept)) > 1e-2


def test_adaptive_integrator_agrees_with_rk4() -> None:
    array = pyramid()
    event = Event("spin-down", 2, 0.4, 0.1, time_constant=2.5)
    more = {"dt": 0.02, "steps": 40, "period_steps": 5, "disturbance": OUTSIDE}
    more |= {"servo": Servo(time_constant=0.1, inertia=0.2), "events": (event,)}
    a = run(slew(array, integrator="dop853", **more))
    b = run(slew(array, integrator="rk4", **more))
    for key in ("q_BN", "omega_BN_B", "delta", "impulse"):
        np.testing.assert_allclose(getattr(a, key), getattr(b, key), rtol=0, atol=1e-8)


@dataclass(frozen=True)
class Steady(nm.Law):
    """Rates that never change."""

    name: ClassVar[str] = "test-steady"
    rates: Any = ()

    def step(self, array: Any, obs: Any, state: Any) -> Any:
        return self.rates, state


@pytest.mark.parametrize(
    ("integrator", "order"),
    [("rk4", 4), ("semi-implicit-euler", 1), pytest.param("euler", 1, marks=SLOW)],
)
def test_order_of_the_integrators(integrator: Any, order: int) -> None:
    """Halving the step divides the error by 2^order."""
    array, law = pyramid(), Steady(np.array([1.0, -0.7, 0.4, 0.9]))

    def errors(steps: int) -> np.ndarray:
        dt = 4.0 / steps
        more = {"dt": dt, "steps": steps, "period_steps": steps, "integrator": integrator}
        result = run(slew(array, law=law, disturbance=OUTSIDE, **more))
        return np.array(error(result, truth or exact(result)))

    def exact(result: Trajectory) -> tuple[np.ndarray, np.ndarray]:
        return Truth(array, outside=True).fly(result, held(result))

    truth: Any = None
    coarse, fine = (40, 80) if order == 4 else (800, 1600)
    np.testing.assert_allclose(np.log2(errors(coarse) / errors(fine)), order, atol=0.12)


def conserved(result: Trajectory) -> float:
    """Return the greatest change of momentum in N, as a share of the greatest that was stored."""
    total = result.inertial_momentum
    assert total is not None and result.omega_BN_B is not None
    scale = max(np.abs(result.omega_BN_B @ INERTIA).max(), np.abs(total).max())
    return float(np.abs(total - total[0]).max() / scale)


STUCK = Event("stuck", 1, 5.0, 0.5)
SLOW_GIMBAL = Event("slow", 0, 2.0, 0.5, rate_limit=0.05)
SPIN_DOWN = Event("spin-down", 3, 4.0033, 0.5, time_constant=20.0, final_fraction=0.4)
AGAIN = Event("spin-down", 3, 6.0, 0.5, time_constant=3.0, final_fraction=0.5)
STOPS = {"angle_limits": np.radians([-20.0, 20.0])}
GIMBAL = Servo(time_constant=0.05, inertia=0.05)
WORN = Servo(0.05, 0.8, 20.0, 0.1, friction=1e-3, inertia=0.05, encoder_resolution=1e-4)


@pytest.mark.parametrize(
    ("array", "more"),
    [
        pytest.param({}, {"spacecraft": Spacecraft(INERTIA, START)}, id="rest", marks=SLOW),
        pytest.param({}, {}, id="rate"),
        pytest.param({"momentum_bias": [0.2, -0.1, 0.15]}, {}, id="bias", marks=SLOW),
        pytest.param({}, {"events": (STUCK,)}, id="stuck", marks=SLOW),
        pytest.param({}, {"events": (SPIN_DOWN,)}, id="spin-down", marks=SLOW),
        pytest.param({}, {"events": (STUCK, SLOW_GIMBAL, SPIN_DOWN, AGAIN)}, id="faults"),
        pytest.param({}, {"servo": GIMBAL}, id="servo", marks=SLOW),
        pytest.param(STOPS, {"servo": GIMBAL}, id="end stops"),
        pytest.param(
            STOPS | {"momentum_bias": [0.2, -0.1, 0.15]},
            {"servo": WORN, "events": (STUCK, SLOW_GIMBAL, SPIN_DOWN)},
            id="all",
        ),
    ],
)
@pytest.mark.sampled(2)
def test_momentum_is_conserved(array: dict[str, Any], more: dict[str, Any]) -> None:
    """Without torque from outside, over a slew of 100 s at 0.01 s."""
    what = {"dt": 0.01, "steps": 10000, "period_steps": 1, "delta": np.radians([3.0, -5, 4, 2])}
    layout = nm.layouts.pyramid(h0=1.0, rate_limit=1.0)
    carrier = nm.CmgArray(
        layout.gimbal_axes, layout.spin_axes, layout.h0, layout.rate_limit, **array
    )
    result = run(slew(carrier, **(what | more)), decimate=20)
    assert np.ptp(result.momentum, axis=0).max() > 0.3
    assert conserved(result) < 1e-9


def test_momentum_is_not_conserved_without_coupling() -> None:
    craft = Spacecraft(INERTIA, START, momentum_coupling=False)
    assert conserved(run(slew(pyramid(), dt=0.01, steps=2000, spacecraft=craft))) > 1e-2


def test_motors_do_the_work() -> None:
    """The power of ideal gimbals' motors, T_i delta_dot_i, is the growth of the kinetic energy.

    The torque is taken at both ends of a step: the sum is the integral to second order.
    """
    result = run(slew(pyramid(), dt=0.01, steps=1500, period_steps=1))
    omega, motor = result.omega_BN_B, result.motor_torque
    assert omega is not None and motor is not None
    energy = 0.5 * np.einsum("ki,ij,kj->k", omega, INERTIA, omega)
    mean = 0.5 * (motor[:-2] + motor[1:-1])
    work = np.cumsum((mean * result.rates[:-2]).sum(axis=1) * 0.01)
    assert np.ptp(energy) > 0.05
    np.testing.assert_allclose(work, energy[1:-1] - energy[0], atol=1e-5)
