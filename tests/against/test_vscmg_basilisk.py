"""The equations of motion of VSCMGs against Basilisk's, under torques of both motors."""

from __future__ import annotations

import warnings
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import nullmotion as nm
from nullmotion import tree
from nullmotion.array.wheels import Wheels
from nullmotion.compile.kernel import LoopKernel
from nullmotion.compile.loop import Loop, Stage
from nullmotion.vscmg import Units, dynamics

with warnings.catch_warnings():  # its SWIG modules may warn when imported
    warnings.simplefilter("ignore")
    pytest.importorskip("Basilisk")
    from Basilisk.architecture import messaging, sysModel
    from Basilisk.simulation import spacecraft, svIntegrators, vscmgStateEffector
    from Basilisk.utilities import SimulationBaseClass, macros

HOLD = 0.01  # s for which the motors hold their torques, whatever the step of integration
SIGMA = np.array([0.1, 0.15, -0.1])  # attitude at the start, in modified Rodrigues parameters
PACE, PHASE = np.array([1.0, 1.2, 1.4, 1.6]), np.array([0.3, 1.6, 2.9, 4.2])


class Craft(NamedTuple):
    """A spacecraft with a pyramid of four VSCMGs, and what its motors are told.

    The gimbals' motors give u_g = torque + gain (rate - delta_dot), the wheels' u_w; torque,
    rate and u_w are sines sampled at the start of each hold.
    """

    hub: np.ndarray  # inertia without the units
    wheel: tuple[float, float, float]  # inertias about spin, transverse and gimbal axis
    gimbal: tuple[float, float, float]
    speed: float
    delta: np.ndarray
    omega: np.ndarray
    pace: float
    torque: float = 0.0
    rate: float = 0.0
    gain: float = 0.0
    wheel_torque: float = 0.0
    skew: float = float(np.radians(54.75))

    @property
    def array(self) -> nm.CmgArray:
        plain = nm.layouts.pyramid(skew=self.skew, h0=self.wheel[0] * self.speed)
        return replace(plain, wheels=Wheels(np.array(self.wheel[0])))

    @property
    def held(self) -> np.ndarray:
        """The units' inertia at the start, (3, 3)."""
        total = np.zeros((3, 3))
        inertias = np.add(self.wheel, self.gimbal)
        rows = zip(self.array.gimbal_axes, self.array.spin_axes, self.delta, strict=True)
        for g, s, angle in rows:
            spin = Rotation.from_rotvec(angle * g).apply(s)
            unit = np.array([spin, np.cross(g, spin), g])
            total += unit.T @ np.diag(inertias) @ unit
        return total

    def told(self, t: float) -> np.ndarray:
        """Return gimbal torques, gimbal rates and wheel torques at a time, (12,)."""
        swing = np.sin(self.pace * PACE * t + PHASE)
        spin_up = self.wheel_torque * np.cos(0.5 * self.pace * PACE * t + 0.7 * PHASE)
        return np.concatenate([self.torque * swing, self.rate * swing, spin_up])


class End(NamedTuple):
    """Where a flight ends: C_NB, body rate, gimbal angles and rates, wheel speeds."""

    attitude: np.ndarray
    omega: np.ndarray
    delta: np.ndarray
    rates: np.ndarray
    speed: np.ndarray

    def off(self, other: End) -> np.ndarray:
        """Return the greatest differences, one for each field."""
        return np.array([np.abs(a - b).max() for a, b in zip(self, other, strict=True)])


TEXTBOOK = Craft(
    hub=np.diag([86.0, 85.0, 113.0]),
    wheel=(0.10, 0.04, 0.03),
    gimbal=(0.03, 0.0, 0.0),
    speed=14.4,
    delta=np.radians([0.0, 0.0, 90.0, -90.0]),
    omega=np.array([0.002, -0.004, 0.003]),
    pace=4.0,
    torque=0.005,
    wheel_torque=0.05,
)
SERVED = TEXTBOOK._replace(
    omega=np.array([0.02, -0.04, 0.03]), pace=0.5, torque=0.01, rate=1.0, gain=0.3
)
AGILE = Craft(
    hub=np.diag([320.0, 280.0, 350.0]),
    wheel=(0.20, 0.11, 0.11),
    gimbal=(0.05, 0.09, 0.14),
    speed=500.0,
    delta=np.radians([10.0, -20.0, 30.0, -40.0]),
    omega=np.array([0.02, -0.04, 0.03]),
    pace=1.0,
    rate=1.0,
    gain=2.5,
    wheel_torque=0.5,
)
PICO = Craft(
    hub=np.diag([0.050, 0.050, 0.062]),
    wheel=(6.95e-4, 3.5e-4, 3.5e-4),
    gimbal=(2.455e-3, 2.45e-3, 2.45e-3),
    speed=200.0,
    delta=np.array([0.5498, 0.2333, 0.5498, 0.2333]),
    omega=np.array([0.02, -0.04, 0.03]),
    pace=1.0,
    rate=1.0,
    gain=0.028,
    wheel_torque=1e-3,
)


def column(values: Any) -> list[list[float]]:
    """A 3 x 1 nested list, as Basilisk's matrix setters want."""
    return [[float(x)] for x in values]


class Motors(sysModel.SysModel):
    """Writes the motors' torques before each step of Basilisk, from its state there."""

    def __init__(self, craft: Craft, dt: float, read: Any) -> None:
        super().__init__()
        self.craft, self.dt, self.read = craft, dt, read
        self.every = round(HOLD / dt)
        self.torques = messaging.VSCMGArrayTorqueMsg()
        self.torques.write(messaging.VSCMGArrayTorqueMsgPayload())

    def UpdateState(self, now: int) -> None:
        """Write the torques for the step that ends now."""
        k = round(now * 1e-9 / self.dt) - 1
        if k < 0 or k % self.every:
            return
        torque, rate, spin_up = self.craft.told(k * self.dt).reshape(3, 4)
        message = messaging.VSCMGArrayTorqueMsgPayload()
        driven = torque + self.craft.gain * (rate - self.read())
        message.gimbalTorque, message.wheelTorque = ([*u, *np.zeros(32)] for u in (driven, spin_up))
        self.torques.write(message, now)


def unit_of(craft: Craft, gimbal_axis: np.ndarray, spin_axis: np.ndarray, angle: float) -> Any:
    """Return a balanced VSCMG at the mass centre without limits or friction."""
    unit = vscmgStateEffector.VSCMGConfigMsgPayload()
    unit.rGB_B = unit.rGcG_G = column([0, 0, 0])
    unit.gsHat0_B, unit.ggHat_B = column(spin_axis), column(gimbal_axis)
    unit.gtHat0_B = column(np.cross(gimbal_axis, spin_axis))
    unit.VSCMGModel = 0
    unit.Omega, unit.gamma, unit.gammaDot = craft.speed, float(angle), 0.0
    unit.massW = unit.massG = 1.0
    unit.IW1, unit.IW2, unit.IW3 = craft.wheel
    unit.IG1, unit.IG2, unit.IG3 = craft.gimbal
    for name in ("u_s_max", "u_s_min", "u_g_max", "u_g_min", "gammaDot_max"):
        setattr(unit, name, -1)
    unit.Omega_max = 1e300
    unit.wheelLinearFrictionRatio = unit.gimbalLinearFrictionRatio = -1
    return unit


def theirs(craft: Craft, seconds: float, dt: float = 0.01) -> End:
    """Fly with Basilisk."""
    sim = SimulationBaseClass.SimBaseClass()
    sim.CreateNewProcess("process").addTask(sim.CreateNewTask("task", macros.sec2nano(dt)))
    body = spacecraft.Spacecraft()
    hub = body.hub
    hub.mHub, hub.r_BcB_B, hub.IHubPntBc_B = 100.0, column([0, 0, 0]), craft.hub.tolist()
    hub.sigma_BNInit, hub.omega_BN_BInit = column(SIGMA), column(craft.omega)
    integrator = svIntegrators.svIntegratorRK4(body)
    body.setIntegrator(integrator)
    cmgs, array = vscmgStateEffector.VSCMGStateEffector(), craft.array
    rows = zip(array.gimbal_axes, array.spin_axes, craft.delta, strict=True)
    units = [unit_of(craft, g, s, angle) for g, s, angle in rows]
    for unit in units:
        cmgs.AddVSCMG(unit)
    body.addStateEffector(cmgs)

    def state(name: str) -> np.ndarray:
        return np.array(body.dynManager.getStateObject(name).getState(), float).ravel()

    motors = Motors(craft, dt, lambda: state(cmgs.nameOfVSCMGGammaDotsState))
    cmgs.cmdsInMsg.subscribeTo(motors.torques)
    for module, priority in ((motors, 30), (cmgs, 20), (body, 10)):
        sim.AddModelToTask("task", module, priority)
    sim.InitializeSimulation()
    sim.ConfigureStopTime(macros.sec2nano(seconds))
    sim.ExecuteSimulation()
    return End(
        Rotation.from_mrp(state(hub.nameOfHubSigma)).as_matrix(),
        state(hub.nameOfHubOmega),
        state(cmgs.nameOfVSCMGGammasState),
        state(cmgs.nameOfVSCMGGammaDotsState),
        state(cmgs.nameOfVSCMGOmegasState),
    )


class Flown(NamedTuple):
    """What our time loop carries."""

    state: dynamics.State
    torque: Any


class Given(NamedTuple):
    """What it starts from."""

    plant: dynamics.Plant
    state: dynamics.State
    gain: Any
    dt: Any


def given(craft: Craft, dt: float, includes_units: bool) -> Given:
    spin, across, about = (np.array(x) for x in np.add(craft.wheel, craft.gimbal))
    units = Units(spin, across, about, drive="torque", inertia_includes_units=includes_units)
    array, units = craft.array, units.for_n(4)
    inertia = craft.hub + craft.held if includes_units else craft.hub
    rest = dynamics.rest_inertia(array, units, inertia, craft.delta)
    x, y, z, w = Rotation.from_mrp(SIGMA).as_quat()
    rates, speed = np.zeros(4), np.full(4, craft.speed)
    start = dynamics.State(np.array([w, x, y, z]), craft.omega, craft.delta, rates, speed, 0.0)
    return Given(dynamics.Plant(array, units, rest), start, craft.gain, dt)


def motors(k: Any, row: Any, now: Flown, p: Given) -> Flown:
    return now._replace(torque=row[:4] + p.gain * (row[4:8] - now.state.rates))


def moved(k: Any, row: Any, now: Flown, p: Given) -> Flown:
    def nothing(since: Any, q: Any) -> Any:
        return np.zeros(3)

    after = dynamics.torque_driven(p.plant, now.state, now.torque, row[8:], nothing, p.dt)
    return now._replace(state=after)


def ours(craft: Craft, seconds: float, dt: float = 0.01, includes_units: bool = False) -> End:
    """Fly with our plant, compiled."""
    start, every, steps = given(craft, dt, includes_units), round(HOLD / dt), round(seconds / dt)
    loop = Loop(
        start=lambda p: Flown(p.state, np.zeros(4)),
        stages=(Stage(motors, every), Stage(moved)),
        outputs=lambda now, p: now.state,
        parameters=start,
        varying=(False,) * len(tree.flatten(start)),
        row=12,
        row_period=every,
    )
    kernel = LoopKernel(loop, width=1)
    rows = np.array([craft.told(HOLD * k) for k in range(steps // every)])
    carried, out = (np.zeros((n, 1)) for n in (kernel.carried, kernel.outputs + len(kernel.flags)))
    nothing = np.zeros((0, 1))
    kernel.run(carried, nothing, rows, np.zeros((0, 0, 1)), out, 0, 1, 0, steps, True)
    end = tree.unflatten(start.state, list(out[: kernel.outputs, 0]))
    attitude = Rotation.from_quat(np.roll(end.q, -1)).as_matrix()
    return End(attitude, end.omega, end.delta, end.rates, end.speed)


def test_the_textbook_s_craft_under_given_torques() -> None:
    """A minute at 0.01 s; the spacecraft's inertia told without the units or with them."""
    other = theirs(TEXTBOOK, 60.0)
    for includes_units in (False, True):
        end = ours(TEXTBOOK, 60.0, includes_units=includes_units)
        np.testing.assert_array_less(end.off(other), 1e-8)
    assert np.abs(end.delta - TEXTBOOK.delta).min() > 0.8
    misread = ours(TEXTBOOK._replace(hub=TEXTBOOK.hub - TEXTBOOK.held), 60.0)
    np.testing.assert_array_less(1e-4, misread.off(other))


@pytest.mark.slow
def test_the_textbook_s_craft_with_gimbal_rate_loops() -> None:
    """Larger motions: loops at 10 rad/s hold them near the same path, a minute at 0.01 s."""
    end = ours(SERVED, 60.0)
    assert np.linalg.norm(SERVED.omega) > 0.05 and np.abs(end.rates).max() > 0.8
    assert np.abs(end.speed - SERVED.speed).max() > 2.0
    np.testing.assert_array_less(end.off(theirs(SERVED, 60.0)), 1e-8)


@pytest.mark.slow
@pytest.mark.parametrize(("craft", "far"), [(AGILE, 1e-7), (PICO, 1e-9)], ids=["agile", "pico"])
def test_agile_craft_differ_by_the_steps_alone(craft: Craft, far: float) -> None:
    """A hundred N m s at 1 rad/s, and a pico-satellite: what differs falls as dt^4 does."""
    coarse, fine = (ours(craft, 10.0, dt).off(theirs(craft, 10.0, dt)) for dt in (0.01, 0.001))
    assert far < coarse.max() < 1e-5
    np.testing.assert_array_less(fine, 1e-10)
    assert coarse.max() / fine.max() > 1e3
