"""Dynamics of a step against MuJoCo: chassis, gimbal and rotor as bodies on hinges."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from nullmotion.rover import Chassis, Cmg, Rover, Site, peter
from nullmotion.rover import step_dynamics as step
from nullmotion.rover.step_energy import motor_powers, used_power
from nullmotion.rover.step_model import step_model

mujoco = pytest.importorskip("mujoco")

SHARE = 0.01  # of the mass that gimbal and rotor each get, at the mass centre


def odd_rover():
    """A rover without any symmetry."""
    rng = np.random.default_rng(7)
    chassis = Chassis.uniform(rng.normal(size=(4, 3)) * [1.0, 1.4, 0.8], 30.0)
    cmg = Cmg(
        gimbal_axis=rng.normal(size=3),
        spin_axis=rng.normal(size=3),
        momentum=60.0,
        rate_limit=2.0,
        acceleration_limit=20.0,
        inertia=np.array([0.7, 0.5, 0.4]),
        rotor_inertia=0.1,
        rotor_speed=600.0,
    )
    return Rover(chassis, cmg)


CASES = [
    (peter(), 1, Site()),
    (peter(), 2, Site(incline=0.5)),
    (peter(), 6, Site(gravity=9.81, incline=-0.3, heading=0.7)),
    (odd_rover(), 1, Site(incline=0.2, heading=-1.0)),
    (odd_rover(), 4, Site(gravity=1.62)),
]


def text(values):
    return " ".join(f"{v:.17g}" for v in np.ravel(values))


def inertial(mass, position, inertia):
    j = np.asarray(inertia)
    full = [j[0, 0], j[1, 1], j[2, 2], j[0, 1], j[0, 2], j[1, 2]]
    return f'<inertial mass="{text(mass)}" pos="{text(position)}" fullinertia="{text(full)}"/>'


def multibody(rover, frame, site):
    """The rover on a hinge along its edge; the world's axes are f, r, p."""
    axes, cmg, mass = frame.axes, rover.cmg, rover.mass
    s, _, o = (axes @ a for a in cmg.axes(0.0))
    com = -axes @ frame.point
    spinning = cmg.momentum / cmg.rotor_speed
    rotor = np.diag([spinning, 0.08, 0.08])
    gimbal = np.diag(cmg.inertia[[0, 2, 1]]) - rotor
    chassis = inertial(mass * (1 - 2 * SHARE), com, axes @ rover.chassis.inertia @ axes.T)
    frame_of_gimbal = f'pos="{text(com)}" xyaxes="{text([s, o])}"'
    return mujoco.MjModel.from_xml_string(f"""
<mujoco>
  <compiler angle="radian" autolimits="true" balanceinertia="false" boundmass="0"/>
  <option gravity="{text(site.vector)}"><flag contact="disable"/></option>
  <worldbody>
    <body name="chassis">
      <joint type="hinge" axis="0 1 0"/>{chassis}
      <body {frame_of_gimbal}>
        <joint type="hinge" axis="0 0 1"/>{inertial(mass * SHARE, np.zeros(3), gimbal)}
        <body>
          <joint type="hinge" axis="1 0 0"/>{inertial(mass * SHARE, np.zeros(3), rotor)}
        </body>
      </body>
    </body>
  </worldbody>
</mujoco>""")


def states(count):
    rng = np.random.default_rng(3)
    low, high = [0.0, -2.0, -3.2, -2.0, -20.0], [2.0, 2.0, 3.2, 2.0, 20.0]
    return [step.State(*rng.uniform(low, high).tolist()) for _ in range(count)]


def moved(model, rover, state, theta_ddot):
    """MuJoCo's data for a motion with the rotor at its speed."""
    data = mujoco.MjData(model)
    data.qpos[:] = [state.theta, state.delta, 0.4]
    data.qvel[:] = [state.theta_dot, state.delta_dot, rover.cmg.rotor_speed]
    data.qacc[:] = [theta_ddot, state.delta_ddot, 0.0]
    mujoco.mj_inverse(model, data)
    return data


@pytest.mark.parametrize(("rover", "edge", "site"), CASES)
def test_accelerations_and_motors_are_those_of_a_multibody_program(rover, edge, site):
    frame = rover.edge_frame(edge)
    ours = step_model(rover, frame, site)
    theirs = multibody(rover, frame, site)
    for state in states(20):
        theta_ddot = step.acceleration(ours, state)
        motor = moved(theirs, rover, state, theta_ddot).qfrc_inverse
        assert abs(motor[0] / ours.N) < 1e-8  # nothing drives the hinge at the edge
        gimbal, rotor = motor_powers(ours, state, theta_ddot)
        assert gimbal == pytest.approx(motor[1] * state.delta_dot, rel=1e-8, abs=1e-8)
        assert rotor == pytest.approx(motor[2] * rover.cmg.rotor_speed, rel=1e-8, abs=1e-8)
        share = rover.cmg.rotor_inertia * rover.cmg.rotor_speed / rover.cmg.momentum
        used = abs(motor[1] * state.delta_dot) + share * abs(motor[2] * rover.cmg.rotor_speed)
        assert used_power(ours, state, theta_ddot) == pytest.approx(used, rel=1e-8, abs=1e-8)


@pytest.mark.parametrize(("rover", "edge", "site"), CASES)
def test_accelerations_pointwise(rover, edge, site):
    """Forward dynamics too: the hinge free, gimbal and rotor with given accelerations."""
    frame = rover.edge_frame(edge)
    ours = step_model(rover, frame, site)
    theirs = multibody(rover, frame, site)
    for state in states(20):
        data = moved(theirs, rover, state, 0.0)
        mass = np.zeros((3, 3))
        mujoco.mj_fullM(theirs, data, mass)
        expected = -data.qfrc_inverse[0] / mass[0, 0]
        assert step.acceleration(ours, state) == pytest.approx(expected, rel=1e-8, abs=1e-8)


@pytest.mark.parametrize(("rover", "edge", "site"), CASES)
def test_margins_are_loads_on_the_spikes(rover, edge, site):
    frame = rover.edge_frame(edge)
    ours = step_model(rover, frame, site)
    theirs = multibody(rover, frame, site)
    for state in states(20):
        theta_ddot = step.acceleration(ours, state)
        data = moved(theirs, rover, state, theta_ddot)
        mujoco.mj_rnePostConstraint(theirs, data)
        torque, force = np.split(data.cfrc_int[1], 2)
        for spare, end in zip(
            step.thresholds(ours, state, theta_ddot).spare, (-0.5, 0.5), strict=True
        ):
            spike = np.array([0.0, end * frame.length, 0.0])
            about = torque + np.cross(data.subtree_com[1] - spike, force)
            sign = -np.sign(end)  # the other spike pushes up at a distance along r
            assert spare == pytest.approx(sign * about[0], rel=1e-8, abs=1e-7)


def test_the_base_rate_torque_matters():
    """Leaving h theta' (r x s) out moves the off-axis torque by far more than rounding."""
    rover = peter()
    frame = rover.edge_frame(1)
    massless = replace(rover, cmg=replace(rover.cmg, inertia=np.zeros(3)))
    ours = step_model(massless, frame, Site())
    still, turning = (step.State(0.6, rate, -1.7, -0.9, 0.0) for rate in (0.0, 1.0))
    torque = [step.thresholds(ours, s, 0.0).tau_off for s in (still, turning)]
    _, r, _ = np.eye(3)
    s = frame.rotation(0.6) @ rover.cmg.axes(-1.7)[0]
    assert torque[1] - torque[0] == pytest.approx(-115.0 * np.cross(r, s)[0], rel=1e-12)
    assert abs(torque[1] - torque[0]) > 10.0
