"""The contact simulation's equations against Lagrange's, by CasADi, and against MuJoCo's."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from nullmotion.rover import Chassis, Cmg, Rover, Site
from nullmotion.rover.contact_field import Field
from nullmotion.rover.contact_signals import Setting
from nullmotion.rover.contact_state import Machine
from nullmotion.rover.ground import Ground

ca = pytest.importorskip("casadi")

AXIAL, ACROSS = 0.11, 0.07  # the rotor's inertia, part of the CMG's
SITE = Site(gravity=3.7, incline=0.4, heading=0.7)
GRIP = 0.01  # of the weight
CARRYING = np.array([1.0, 1.0, 0.0, 1.0, 1.0])


def rover() -> Rover:
    """A rover without any symmetry."""
    spikes = [[0, 0, 0], [0.9, 0.1, 0], [0.3, 1.1, 0.1], [0.4, 0.3, 0.8], [0.9, 0.9, 0.7]]
    chassis = Chassis.uniform(np.array(spikes), mass=40.0)
    cmg = Cmg([0.3, -0.5, 0.8], [0.9, 0.3, 0.1], 115.0, 2.0, 20.0, [0.55, 0.36, 0.45])
    return Rover(chassis, cmg)


def prescribed(told: Any, numbers: Any, measured: Any) -> Any:
    return told[0]


def field(ground: Ground, delta_ddot: float) -> Field:
    it = rover()
    setting = Setting(
        Machine.of(it, SITE),
        ground.numbers(it.mass * SITE.gravity),
        np.array([1.0, 0.0, 0.0, 0.0]),
        np.array([0.0, 1.0, 0.0]),
        (),
    )
    return Field(prescribed, lambda t: [delta_ddot], setting, it.chassis.vertices, CARRYING)


# Lagrange


def turn(axis: Any, angle: Any) -> Any:
    """Rodrigues' rotation."""
    n = ca.skew(ca.DM(axis))
    return ca.SX.eye(3) + ca.sin(angle) * n + (1 - ca.cos(angle)) * n @ n


def rates(R: Any, y: Any, y_dot: Any) -> Any:
    """Angular velocity of a body in its own axes."""
    R_dot = ca.reshape(ca.jtimes(ca.vec(R), y, y_dot), 3, 3)
    return ca.inv_skew(R.T @ R_dot)


def pushes(ground: Ground, place: Any, velocity: Any, weight: float, carries: float) -> Any:
    """The law of Table 3 with a friction cone."""
    load = carries * (-ground.stiffness * place[2] - ground.damping * velocity[2])
    speed = ca.sqrt(velocity[0] ** 2 + velocity[1] ** 2)
    drag = ground.drag * ca.fmin(1, ca.fmax(0, load) / (GRIP * weight))
    if ground.friction is not None:
        drag = drag * ca.fmin(1, ground.friction * ca.fmax(0, load) / (ground.drag * speed))
    return ca.vertcat(-drag * velocity[0], -drag * velocity[1], load)


@cache
def lagrange(ground: Ground) -> Any:
    """Accelerations of mass centre and body from energies alone, and their Jacobian.

    The state z is p, Euler's angles, v, omega in body axes, delta, delta'.
    """
    it = rover()
    cmg, mass = it.cmg, it.mass
    s0, g, o0 = cmg.axes(0.0)
    frame = np.array([s0, g, o0])
    y, y_dot, delta_ddot = ca.SX.sym("y", 8), ca.SX.sym("y_dot", 8), ca.SX.sym("a")
    R = turn([0, 0, 1], y[3]) @ turn([0, 1, 0], y[4]) @ turn([1, 0, 0], y[5])
    gimbal = R @ turn(g, y[6])
    rotor = gimbal @ turn(s0, y[7])
    own = np.diag([AXIAL, ACROSS, ACROSS])
    T = mass * ca.sumsqr(y_dot[:3]) / 2
    for turned, inertia in (
        (R, it.chassis.inertia),
        (gimbal, frame.T @ (np.diag(cmg.inertia) - own) @ frame),
        (rotor, frame.T @ own @ frame),
    ):
        w = rates(turned, y, y_dot)
        T += w.T @ ca.DM(inertia) @ w / 2
    V = -mass * ca.dot(ca.DM(SITE.vector), y[:3])
    p = ca.gradient(T, y_dot)
    M = ca.jacobian(p, y_dot)
    bias = ca.jtimes(p, y, y_dot) - ca.gradient(T, y) + ca.gradient(V, y)
    Q = ca.SX.zeros(8)
    for spike, carries in zip(it.chassis.vertices, CARRYING, strict=True):
        place = y[:3] + R @ ca.DM(spike)
        force = pushes(ground, place, ca.jtimes(place, y, y_dot), mass * SITE.gravity, carries)
        Q += ca.jacobian(place, y).T @ force
    known = ca.vertcat(delta_ddot, 0)
    y_ddot = ca.solve(M[:6, :6], (Q - bias)[:6] - M[:6, 6:] @ known)
    omega = rates(R, y, y_dot)
    omega_dot = ca.jtimes(omega, y, y_dot) + ca.jacobian(omega, y_dot[:6]) @ y_ddot
    return _of_state(y, y_dot, delta_ddot, ca.vertcat(y_ddot[:3], omega_dot), omega)


def _of_state(y: Any, y_dot: Any, delta_ddot: Any, found: Any, omega: Any) -> Any:
    z = ca.SX.sym("z", 14)
    W = ca.jacobian(omega, y_dot[3:6])
    turning = ca.solve(ca.substitute(W, y[3:6], z[3:6]), z[9:12])
    new_y = ca.vertcat(z[:6], z[12], 0.3)
    spin = rover().cmg.momentum / AXIAL
    new_rates = ca.vertcat(z[6:9], turning, z[13], spin)
    a = ca.substitute(found, ca.vertcat(y, y_dot), ca.vertcat(new_y, new_rates))
    half = z[3:6] / 2
    q = _product(
        _product(
            ca.vertcat(ca.cos(half[0]), 0, 0, ca.sin(half[0])),
            ca.vertcat(ca.cos(half[1]), 0, ca.sin(half[1]), 0),
        ),
        ca.vertcat(ca.cos(half[2]), ca.sin(half[2]), 0, 0),
    )
    x = ca.vertcat(z[:3], q, z[6:])
    return ca.Function("lagrange", [z, delta_ddot], [a, ca.jacobian(a, z), x, ca.jacobian(x, z)])


def _product(p: Any, q: Any) -> Any:
    scalar = p[0] * q[0] - ca.dot(p[1:], q[1:])
    return ca.vertcat(scalar, p[0] * q[1:] + q[0] * p[1:] + ca.cross(p[1:], q[1:]))


GROUNDS = [Ground(), Ground(1e4, 1e3, 1e4, 0.5), Ground(1e5, 0.0, 0.0)]


def states(rng: np.random.Generator, count: int) -> np.ndarray:
    """States with the spikes near the ground, some above and some below."""
    z = rng.normal(size=(count, 14))
    z[:, 2] = rng.uniform(-0.3, 0.3, size=count)
    z[:, 6:9] *= 0.1
    return z


@pytest.mark.parametrize("ground", GROUNDS, ids=["rock", "soft", "elastic"])
def test_accelerations_follow_from_lagrange(ground: Ground, rng: np.random.Generator):
    for z in states(rng, 20):
        delta_ddot = float(rng.normal())
        a, _, x, _ = (np.array(v) for v in lagrange(ground)(z, delta_ddot))
        found = field(ground, delta_ddot).change(0.0, x[:, 0])
        np.testing.assert_allclose(found[7:13], a[:, 0], rtol=1e-8, atol=1e-8 * np.abs(a).max())
        np.testing.assert_array_equal(found[:3], z[6:9])
        np.testing.assert_array_equal(found[13:], [z[13], delta_ddot])
        turned = Rotation.from_quat(x[3:7, 0], scalar_first=True)
        ahead = x[3:7, 0] + 1e-6 * found[3:7]
        small = turned.inv() * Rotation.from_quat(ahead, scalar_first=True)
        np.testing.assert_allclose(small.as_rotvec(), 1e-6 * z[9:12], atol=1e-11)


@pytest.mark.parametrize("ground", GROUNDS, ids=["rock", "soft", "elastic"])
def test_the_jacobian_is_casadis(ground: Ground, rng: np.random.Generator):
    for z in states(rng, 20):
        _, wanted, x, along = (np.array(v) for v in lagrange(ground)(z, 0.7))
        found = field(ground, 0.7).slopes(0.0, x[:, 0])[7:13] @ along
        scale = np.abs(wanted).max(axis=1, keepdims=True) + 1e-9 * np.abs(wanted).max()
        assert (np.abs(found - wanted) / scale).max() < 1e-8


# MuJoCo


def text(values: Any) -> str:
    return " ".join(f"{v:.17g}" for v in np.ravel(values))


def inertial(mass: float, inertia: Any) -> str:
    rows, columns = [0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]
    full = text(np.asarray(inertia)[rows, columns])
    return f'<inertial mass="{text(mass)}" pos="0 0 0" fullinertia="{full}"/>'


def multibody(mj: Any) -> Any:
    """The same rover as a free hub, a gimbal and a rotor, joined by hinges in the mass centre."""
    it = rover()
    cmg, light = it.cmg, 1e-3 * it.mass
    s, _, o = cmg.axes(0.0)
    spun = np.diag([AXIAL, ACROSS, ACROSS])
    gimbal = np.diag(cmg.inertia[[0, 2, 1]]) - spun
    return mj.MjModel.from_xml_string(f"""
<mujoco>
  <compiler angle="radian" balanceinertia="false" boundmass="0"/>
  <option gravity="{text(SITE.vector)}"><flag contact="disable"/></option>
  <worldbody>
    <body>
      <freejoint/>{inertial(it.mass - 2 * light, it.chassis.inertia)}
      <body xyaxes="{text([s, o])}">
        <joint type="hinge" axis="0 0 1"/>{inertial(light, gimbal)}
        <body>
          <joint type="hinge" axis="1 0 0"/>{inertial(light, spun)}
        </body>
      </body>
    </body>
  </worldbody>
</mujoco>""")


@pytest.mark.parametrize("ground", GROUNDS, ids=["rock", "soft", "elastic"])
def test_accelerations_agree_with_mujoco(ground: Ground, rng: np.random.Generator):
    mj = pytest.importorskip("mujoco")
    it, model = rover(), multibody(mj)
    data, mass, along = mj.MjData(model), np.zeros((8, 8)), np.zeros((3, 8))
    for z in states(rng, 20):
        delta_ddot = float(rng.normal())
        x = np.array(lagrange(ground)(z, delta_ddot)[2])[:, 0]
        data.qpos[:] = [*x[:7], x[13], 0.3]
        data.qvel[:] = [*x[7:13], x[14], it.cmg.momentum / AXIAL]
        data.qacc[:] = [*np.zeros(6), delta_ddot, 0.0]
        mj.mj_inverse(model, data)
        mj.mj_fullM(model, data, mass)
        push = -data.qfrc_inverse
        for spike, carries in zip(it.chassis.vertices, CARRYING, strict=True):
            place = x[:3] + data.xmat[1].reshape(3, 3) @ spike
            mj.mj_jac(model, data, along, None, place, 1)
            force = pushes(ground, place, along @ data.qvel, it.mass * SITE.gravity, carries)
            push += along.T @ np.array(ca.DM(force))[:, 0]
        wanted = np.linalg.solve(mass[:6, :6], push[:6])
        found = field(ground, delta_ddot).change(0.0, x)[7:13]
        np.testing.assert_allclose(found, wanted, rtol=1e-8, atol=1e-8 * np.abs(wanted).max())
