"""The equations of motion against Basilisk's: its rigid hub, and its gimbals with wheels."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, replace
from typing import Any, ClassVar, NamedTuple

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import nullmotion as nm
from nullmotion.sim import Setup, run
from nullmotion.spacecraft import Disturbance, Servo, Spacecraft, controllers

with warnings.catch_warnings():  # its SWIG modules may warn when imported
    warnings.simplefilter("ignore")
    pytest.importorskip("Basilisk")
    from Basilisk.architecture import messaging
    from Basilisk.simulation import (
        extForceTorque,
        spacecraft,
        svIntegrators,
        vscmgStateEffector,
    )
    from Basilisk.utilities import SimulationBaseClass, macros

INERTIA = np.array([[12.0, -1.5, 0.8], [-1.5, 9.0, 1.1], [0.8, 1.1, 14.0]])
SIGMA, OMEGA = np.array([0.1, 0.15, -0.1]), np.array([0.12, -0.08, 0.15])
H0, WHEEL, GIMBAL, ACROSS = 1.2, 1e-9, 0.06, 0.02  # wheel: so light that only its momentum counts


def column(values: Any) -> list[list[float]]:
    """A 3 x 1 nested list, as Basilisk's matrix setters want."""
    return [[float(x)] for x in values]


class Basilisk:
    """A hub, with or without CMGs, under RK4 at a fixed step."""

    def __init__(self, dt: float, inertia: np.ndarray, array: nm.CmgArray | None = None) -> None:
        self.sim, self.now = SimulationBaseClass.SimBaseClass(), 0.0
        step = macros.sec2nano(dt)
        self.sim.CreateNewProcess("process").addTask(self.sim.CreateNewTask("task", step))
        self.body = spacecraft.Spacecraft()
        hub = self.body.hub
        hub.mHub, hub.r_BcB_B, hub.IHubPntBc_B = 100.0, column([0, 0, 0]), inertia.tolist()
        hub.sigma_BNInit, hub.omega_BN_BInit = column(SIGMA), column(OMEGA)
        self.integrator = svIntegrators.svIntegratorRK4(self.body)
        self.body.setIntegrator(self.integrator)
        self.outside = extForceTorque.ExtForceTorque()
        self.body.addDynamicEffector(self.outside)
        self.sim.AddModelToTask("task", self.outside, 30)
        if array is not None:
            self.add_gimbals(array)
        self.sim.AddModelToTask("task", self.body, 20)
        self.states = self.body.scStateOutMsg.recorder()
        self.sim.AddModelToTask("task", self.states, 10)
        self.sim.InitializeSimulation()

    def add_gimbals(self, array: nm.CmgArray) -> None:
        """Put balanced CMGs without limits or friction at the mass centre."""
        self.cmgs = vscmgStateEffector.VSCMGStateEffector()
        self.units = [cmg(g, s) for g, s in zip(array.gimbal_axes, array.spin_axes, strict=True)]
        for unit in self.units:
            self.cmgs.AddVSCMG(unit)
        self.body.addStateEffector(self.cmgs)
        self.motors = messaging.VSCMGArrayTorqueMsg()
        self.motors.write(messaging.VSCMGArrayTorqueMsgPayload())
        self.cmgs.cmdsInMsg.subscribeTo(self.motors)
        self.sim.AddModelToTask("task", self.cmgs, 25)
        self.gimbals = self.cmgs.speedOutMsg.recorder()
        self.sim.AddModelToTask("task", self.gimbals, 10)

    def advance(self, seconds: float) -> None:
        self.now += seconds
        self.sim.ConfigureStopTime(macros.sec2nano(self.now))
        self.sim.ExecuteSimulation()

    @property
    def attitude(self) -> np.ndarray:
        """C_NB at each sample; Basilisk's sigma_BN turns N into B, as q_BN does."""
        return Rotation.from_mrp(np.array(self.states.sigma_BN)).as_matrix()


def cmg(gimbal_axis: np.ndarray, spin_axis: np.ndarray) -> Any:
    unit = vscmgStateEffector.VSCMGConfigMsgPayload()
    unit.rGB_B = unit.rGcG_G = column([0, 0, 0])
    unit.gsHat0_B, unit.ggHat_B = column(spin_axis), column(gimbal_axis)
    unit.gtHat0_B = column(np.cross(gimbal_axis, spin_axis))
    unit.VSCMGModel = 0
    unit.Omega, unit.gamma, unit.gammaDot = H0 / WHEEL, 0.0, 0.0
    unit.massW = unit.massG = 1.0
    unit.IW1 = unit.IW2 = unit.IW3 = WHEEL
    unit.IG1 = unit.IG2 = ACROSS
    unit.IG3 = GIMBAL - WHEEL
    for name in ("u_s_max", "u_s_min", "u_g_max", "u_g_min", "gammaDot_max"):
        setattr(unit, name, -1)
    unit.Omega_max = 1e300
    unit.wheelLinearFrictionRatio = unit.gimbalLinearFrictionRatio = -1
    return unit


def attitude(result: nm.Trajectory) -> np.ndarray:
    assert result.q_BN is not None
    matrices: np.ndarray = Rotation.from_quat(np.roll(result.q_BN, -1, axis=1)).as_matrix()
    return matrices


def start() -> Spacecraft:
    x, y, z, w = Rotation.from_mrp(SIGMA).as_quat()
    return Spacecraft(INERTIA, np.array([w, x, y, z]), OMEGA)


@dataclass(frozen=True)
class Parked(nm.Law):
    """No gimbal turns."""

    name: ClassVar[str] = "test-parked"

    def step(self, array: Any, obs: Any, state: Any) -> Any:
        return np.zeros(array.n), state


def test_rigid_hub_under_steps_of_torque() -> None:
    """The pyramid's momenta cancel at zero angles: parked, only the torque from outside is left."""
    dt, seconds = 0.01, 2.0
    torques = np.random.default_rng(7).uniform(-1.0, 1.0, (4, 3))
    theirs = Basilisk(dt, INERTIA)
    array, steps = nm.layouts.pyramid(), round(seconds / dt)
    craft = start()
    for i, torque in enumerate(torques):
        theirs.outside.extTorquePntB_B = column(torque)
        theirs.advance(seconds)
        what = Setup(
            array,
            Parked(),
            np.zeros(4),
            np.zeros(3),
            dt=dt,
            steps=steps,
            spacecraft=craft,
            controller=controllers.create("quaternion-feedback"),
            target=np.array([1.0, 0.0, 0.0, 0.0]),
            disturbance=Disturbance(constant=torque),
        )
        ours = run(what)
        assert ours.q_BN is not None and ours.omega_BN_B is not None
        rows = slice(i * steps, (i + 1) * steps + 1)
        np.testing.assert_allclose(attitude(ours), theirs.attitude[rows], rtol=0, atol=1e-8)
        rates = np.array(theirs.states.omega_BN_B)[rows]
        np.testing.assert_allclose(ours.omega_BN_B, rates, rtol=0, atol=1e-8)
        craft = replace(craft, q_BN=ours.q_BN[-1], omega_BN_B=ours.omega_BN_B[-1])
    assert np.linalg.norm(OMEGA - craft.omega_BN_B) > 0.1


@dataclass(frozen=True)
class Table(nm.Law):
    """Rates from a table, one row for the end of each step."""

    name: ClassVar[str] = "test-table"
    rows: Any = ()

    def step(self, array: Any, obs: Any, state: Any) -> Any:
        k = round(float(obs.t) / float(obs.period))
        return self.rows[min(k + 1, len(self.rows) - 1)], state


class Flight(NamedTuple):
    array: nm.CmgArray
    attitude: np.ndarray  # C_NB at each sample
    omega: np.ndarray
    angles: np.ndarray
    rates: np.ndarray


def motor_torques(t: float) -> np.ndarray:
    return 0.06 * np.sin(np.array([0.9, 1.3, 0.7, 1.1]) * t + np.array([0.3, 1.0, 2.0, 4.0]))


@pytest.fixture(scope="module")
def flight() -> Flight:
    """Basilisk's flight: motor torques held for 0.1 s, 4 s at 0.005 s."""
    array, fine = nm.layouts.pyramid(h0=H0), 0.005
    axes = array.gimbal_axes
    carried = sum(ACROSS * np.eye(3) + (GIMBAL - ACROSS) * np.outer(g, g) for g in axes)
    theirs = Basilisk(fine, INERTIA - carried, array)
    for k in range(40):
        message = messaging.VSCMGArrayTorqueMsgPayload()
        message.gimbalTorque = [*motor_torques(0.1 * k), *np.zeros(32)]
        theirs.motors.write(message)
        theirs.advance(0.1)
    theirs.advance(fine)  # the gimbals' message is a step behind
    speeds = theirs.gimbals
    angles, rates = (np.array(v)[1:, :4] for v in (speeds.gimbalAngles, speeds.gimbalRates))
    omega = np.array(theirs.states.omega_BN_B)[:-1]
    return Flight(array, theirs.attitude[:-1], omega, angles, rates)


def follow(flight: Flight, every: int) -> nm.Trajectory:
    """Return our run whose gimbal rates are theirs at every so many samples."""
    rates = flight.rates[::every]
    what = Setup(
        flight.array,
        Table(rates),
        np.zeros(4),
        np.zeros(3),
        dt=0.005 * every,
        steps=len(rates) - 1,
        spacecraft=start(),
        controller=controllers.create("quaternion-feedback"),
        target=np.array([1.0, 0.0, 0.0, 0.0]),
        servo=Servo(inertia=GIMBAL),
    )
    return run(what, backend="python")


@pytest.fixture(scope="module")
def fine(flight: Flight) -> nm.Trajectory:
    return follow(flight, 2)


def test_gimbals_turned_by_their_motors(flight: Flight, fine: nm.Trajectory) -> None:
    """Wheels, gimbals and hub of Basilisk, driven by motor torques; its gimbal rates are ours.

    Between two samples our rates are straight, so that we are off by a multiple of dt^2: with
    the step halved by a quarter, and extrapolated from both by next to nothing.
    """
    assert np.ptp(flight.angles, axis=0).max() > 1.0
    assert np.linalg.norm(flight.omega - OMEGA, axis=1).max() > 0.1
    theirs = np.concatenate([flight.attitude[-1].ravel(), flight.omega[-1], flight.angles[-1]])

    def final(ours: nm.Trajectory) -> np.ndarray:
        assert ours.omega_BN_B is not None
        return np.concatenate([attitude(ours)[-1].ravel(), ours.omega_BN_B[-1], ours.delta[-1]])

    far, near = final(follow(flight, 4)), final(fine)
    errors = [np.abs(x - theirs).max() for x in (far, near)]
    assert errors[0] < 2e-4
    assert errors[0] / errors[1] == pytest.approx(4.0, abs=0.01)
    np.testing.assert_allclose((4.0 * near - far) / 3.0, theirs, rtol=0, atol=1e-8)


def test_motor_torque(flight: Flight, fine: nm.Trajectory) -> None:
    """Ours moves the gimbal against the body; theirs, which was given, also with the body.

    In the middle of a step: the gyroscopic part is what the torque at its start has beside
    I delta_ddot, averaged over both ends.
    """
    dt, omega, torque, speed = 0.01, fine.omega_BN_B, fine.motor_torque, fine.speed
    assert omega is not None and torque is not None and speed is not None
    accelerations = np.diff(speed, axis=0) / dt
    gyroscopic = torque[:-1] - GIMBAL * accelerations
    middle = GIMBAL * accelerations[:-1] + 0.5 * (gyroscopic[1:] + gyroscopic[:-1])
    with_body = GIMBAL * (np.diff(omega, axis=0) / dt @ flight.array.gimbal_axes.T)
    given = np.repeat([motor_torques(0.1 * k) for k in range(40)], 10, axis=0)[:-1]
    np.testing.assert_allclose(middle + with_body[:-1], given, rtol=0, atol=1e-4)
    assert np.abs(gyroscopic).max() > 0.2
