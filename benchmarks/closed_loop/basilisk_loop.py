"""Basilisk's closed loop on the same spacecraft and pyramid, C and C++ modules only.

Chain at 0.01 s: spacecraft with four VSCMGs (RK4) -> simpleNav -> inertial3D -> attTrackingError
-> mrpFeedback -> vscmgVelocitySteering -> vscmgGimbalRateServo -> VSCMGStateEffector. No Python
runs inside the loop. Setting up and initialising are not timed.

It is not the same computation, so its states are not compared with the others' (the attitude error
must only fall), and its time is an order of magnitude, not a ratio of like with like. Its model is
richer: each VSCMG is a gimbal and a wheel with mass and inertia, whose speeds, gimbal angles and
gimbal rates are states driven by motor torques and coupled back into hub rotation and translation
(back-substitution); the hub also translates; every module passes time-stamped messages. Its
steering is a weighted pseudo-inverse over gimbal rates and wheel accelerations (no null motion, no
SVD, no rate limit), so one figure stands beside all three laws. It computes one run at a time.
"""

from __future__ import annotations

import time

import numpy as np
import workload as w
from Basilisk.architecture import messaging
from Basilisk.fswAlgorithms import (
    attTrackingError,
    inertial3D,
    mrpFeedback,
    vscmgGimbalRateServo,
    vscmgVelocitySteering,
)
from Basilisk.simulation import simpleNav, spacecraft, svIntegrators, vscmgStateEffector
from Basilisk.utilities import SimulationBaseClass, fswSetupVSCMGs, macros

WHEEL_SPEED = 600.0  # rad/s; the wheel's inertia follows from h0
INERTIAS = {"IW1": w.H0 / WHEEL_SPEED, "IW2": 1e-3, "IW3": 1e-3, "IG1": 2e-3, "IG2": 2e-3}
GIMBAL_BANDWIDTH = 50.0  # 1/s, stable at a 0.01 s control period
SIGMA_START = [0.1, 0.15, -0.1]  # about 47 deg


def column(values: np.ndarray | list[float]) -> list[list[float]]:
    """A 3 x 1 nested list, as Basilisk's matrix setters want."""
    return [[float(x)] for x in values]


def wheel(i: int) -> vscmgStateEffector.VSCMGConfigMsgPayload:
    """CMG i as a balanced VSCMG at the hub's centre of mass, without limits or friction."""
    unit = vscmgStateEffector.VSCMGConfigMsgPayload()
    unit.rGB_B = column([0, 0, 0])
    unit.gsHat0_B = column(w.SPIN_AXES[i])
    unit.gtHat0_B = column(w.CROSS_AXES[i])
    unit.ggHat_B = column(w.GIMBAL_AXES[i])
    unit.rGcG_G = column([0, 0, 0])
    unit.VSCMGModel = 0
    unit.Omega, unit.gamma, unit.gammaDot = WHEEL_SPEED, 0.0, 0.0
    unit.massW = unit.massG = 1.0
    unit.IG3 = 2e-3
    for name, value in INERTIAS.items():
        setattr(unit, name, value)
    for name in ("u_s_max", "u_s_min", "u_g_max", "u_g_min", "Omega_max", "gammaDot_max"):
        setattr(unit, name, -1)
    unit.wheelLinearFrictionRatio = unit.gimbalLinearFrictionRatio = -1
    return unit


def array_message() -> messaging.VSCMGArrayConfigMsg:
    """The array as the flight modules know it."""
    fswSetupVSCMGs.clearSetup()
    for i in range(4):
        fswSetupVSCMGs.create(
            w.SPIN_AXES[i], w.CROSS_AXES[i], w.GIMBAL_AXES[i],
            INERTIAS["IG1"], INERTIAS["IG2"], 2e-3,
            INERTIAS["IW1"], INERTIAS["IW2"], INERTIAS["IW3"],
            WHEEL_SPEED, 0.0, 0.0,
        )  # fmt: skip
    return fswSetupVSCMGs.writeConfigMessage()


class Loop:
    """The simulation, ready to be continued for any number of steps."""

    def __init__(self) -> None:
        self.sim = SimulationBaseClass.SimBaseClass()
        self.period = macros.sec2nano(w.DT)
        self.sim.CreateNewProcess("process").addTask(self.sim.CreateNewTask("task", self.period))
        self.keep: list[object] = []
        self.plant()
        self.flight_software()
        self.done = 0
        self.sim.InitializeSimulation()

    def add(self, module: object, tag: str, priority: int) -> None:
        """Put a module in the task; higher priorities run first."""
        module.ModelTag = tag  # type: ignore[attr-defined]
        self.sim.AddModelToTask("task", module, priority)
        self.keep.append(module)

    def plant(self) -> None:
        """Spacecraft, VSCMGs, navigation."""
        self.body = spacecraft.Spacecraft()
        self.body.hub.mHub = 200.0
        self.body.hub.r_BcB_B = column([0, 0, 0])
        self.body.hub.IHubPntBc_B = np.diag(w.INERTIA).tolist()
        self.body.hub.sigma_BNInit = column(SIGMA_START)
        self.body.hub.omega_BN_BInit = column([0, 0, 0])
        integrator = svIntegrators.svIntegratorRK4(self.body)
        self.body.setIntegrator(integrator)
        self.cmgs = vscmgStateEffector.VSCMGStateEffector()
        units = [wheel(i) for i in range(4)]
        for unit in units:
            self.cmgs.AddVSCMG(unit)
        self.body.addStateEffector(self.cmgs)
        self.nav = simpleNav.SimpleNav()
        self.nav.scStateInMsg.subscribeTo(self.body.scStateOutMsg)
        self.keep += [integrator, *units]
        self.add(self.cmgs, "cmgs", 20)
        self.add(self.body, "spacecraft", 19)
        self.add(self.nav, "nav", 18)

    def flight_software(self) -> None:
        """Guidance, quaternion-like feedback on MRPs, velocity steering, gimbal servo."""
        reference = inertial3D.inertial3D()
        reference.sigma_R0N = [0.0, 0.0, 0.0]
        error = attTrackingError.attTrackingError()
        error.attNavInMsg.subscribeTo(self.nav.attOutMsg)
        error.attRefInMsg.subscribeTo(reference.attRefOutMsg)
        control = mrpFeedback.mrpFeedback()
        control.K, control.P, control.Ki, control.integralLimit = 2 * w.KP, w.KW, -1.0, 0.0
        control.guidInMsg.subscribeTo(error.attGuidOutMsg)
        body = messaging.VehicleConfigMsgPayload(ISCPntB_B=np.diag(w.INERTIA).ravel().tolist())
        vehicle, array = messaging.VehicleConfigMsg().write(body), array_message()
        control.vehConfigInMsg.subscribeTo(vehicle)
        steering = vscmgVelocitySteering.VscmgVelocitySteering()
        steering.setMu(10.0)
        steering.setW0_s([2.0] * 4)
        steering.setW_g([1.0] * 4)
        steering.vscmgParamsInMsg.subscribeTo(array)
        steering.vehControlInMsg.subscribeTo(control.cmdTorqueOutMsg)
        steering.attNavInMsg.subscribeTo(self.nav.attOutMsg)
        steering.attGuideInMsg.subscribeTo(error.attGuidOutMsg)
        steering.speedsInMsg.subscribeTo(self.cmgs.speedOutMsg)
        servo = vscmgGimbalRateServo.VscmgGimbalRateServo()
        servo.setK_gammaDot(GIMBAL_BANDWIDTH)
        servo.vsmcgParamsInMsg.subscribeTo(array)
        servo.vscmgRefStatesInMsg.subscribeTo(steering.vscmgRefStatesOutMsg)
        servo.attInMsg.subscribeTo(self.nav.attOutMsg)
        servo.speedsInMsg.subscribeTo(self.cmgs.speedOutMsg)
        servo.cmdsOutMsg.write(messaging.VSCMGArrayTorqueMsgPayload())  # until it first runs
        self.cmgs.cmdsInMsg.subscribeTo(servo.cmdsOutMsg)
        self.keep += [vehicle, array]
        for i, (tag, module) in enumerate(
            {"reference": reference, "error": error, "control": control,
             "steering": steering, "servo": servo}.items()
        ):  # fmt: skip
            self.add(module, tag, 15 - i)

    def advance(self, steps: int) -> float:
        """Continue for ``steps`` periods; the seconds it took."""
        self.done += steps
        self.sim.ConfigureStopTime(self.period * self.done)
        start = time.perf_counter()
        self.sim.ExecuteSimulation()
        return time.perf_counter() - start

    def attitude_error(self) -> float:
        """Norm of sigma_BN: the MRPs of the pointing error."""
        return float(np.linalg.norm(self.body.scStateOutMsg.read().sigma_BN))

    def gimbal_angles(self) -> np.ndarray:
        """Gimbal angles now, rad."""
        return np.array(self.cmgs.speedOutMsg.read().gimbalAngles[:4])


def check() -> float:
    """Fly 20 s: the pointing error must fall below a tenth. Returns the ratio."""
    loop = Loop()
    loop.advance(2000)
    ratio = loop.attitude_error() / float(np.linalg.norm(SIGMA_START))
    if not (ratio < 0.1 and np.abs(loop.gimbal_angles()).max() > 0.01):
        raise RuntimeError(f"Basilisk's loop does not point: error ratio {ratio:.3g}")
    return ratio
