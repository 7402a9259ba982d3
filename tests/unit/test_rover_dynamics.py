"""Equations of a step: settled formulas, energy, one source on floats, arrays and symbols."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from nullmotion.rover import Chassis, Rover, Site, peter
from nullmotion.rover import step_dynamics as step
from nullmotion.rover.step_energy import motor_powers, total_energy, used_power
from nullmotion.rover.step_model import from_numbers, step_model

ROVER = peter()
MASSLESS = replace(ROVER, cmg=replace(ROVER.cmg, inertia=np.zeros(3)))
D = 1 / (2 * 2**0.5)
ALPHA = np.arccos(1 / 3**0.5)


def model(edge=1, rover=ROVER, **site):
    return step_model(rover, rover.edge_frame(edge), Site(**site))


def random_states(rng, count=30):
    low, high = [0.0, -2.0, -3.2, -2.0, -20.0], [2.0, 2.0, 3.2, 2.0, 20.0]
    return [step.State(*rng.uniform(low, high).tolist()) for _ in range(count)]


@pytest.mark.parametrize("edge", range(1, 7))
@pytest.mark.parametrize("incline", [-0.4, 0.0, 0.9])
def test_gravity_about_the_edge(edge, incline):
    m = model(edge, gravity=3.711, incline=incline)
    theta = np.linspace(0.0, 1.9, 7)
    expected = -47 * 3.711 * D * np.sin(ALPHA + incline - theta)
    assert step.gravity_torque(m, theta) == pytest.approx(expected)


def test_uphill_aside_of_the_step():
    """Straight along the edge a slope only shifts the load from one spike to the other."""
    m = model(gravity=3.711, incline=0.3, heading=np.pi / 2)
    rest = step.State(0.0, 0.0, 0.0, 0.0, 0.0)
    weight = 47 * 3.711
    # with gravity alone the third spike's share is missing: both spikes bear cos(incline)
    spare = step.thresholds(m, rest, 0.0).spare
    assert np.mean(spare) == pytest.approx(weight * np.cos(0.3) / 2)
    height = D * np.cos(ALPHA)
    # uphill is towards b, so that a, below, bears more by the weight's arm
    assert spare[1] - spare[0] == pytest.approx(2 * weight * np.sin(0.3) * height)


def test_thresholds_reduce_to_the_normal_force(rng):
    """For PETER straight uphill both are (L/2) F_n: |tau_off| <= (L/2) F_n."""
    m = model(rover=MASSLESS, gravity=3.711, incline=0.5)
    for state in random_states(rng):
        theta_ddot = step.acceleration(m, state)
        limits = step.thresholds(m, state, theta_ddot)
        phi = ALPHA - state.theta  # angle of the mass centre before the normal
        up = D * (np.sin(phi) * theta_ddot - np.cos(phi) * state.theta_dot**2)
        F_n = 47 * (up + 3.711 * np.cos(0.5))
        assert limits.tau_DTa == pytest.approx(F_n / 2)
        assert limits.tau_DTb == pytest.approx(-F_n / 2)


def test_the_massless_cmg(rng):
    """T = h (delta' o + theta' r x s), in vectors."""
    m, frame = model(rover=MASSLESS), MASSLESS.edge_frame(1)
    for state in random_states(rng):
        s, _, o = ROVER.cmg.axes(state.delta)
        T = 115 * (state.delta_dot * o + state.theta_dot * np.cross(frame.r, s))
        expected = (step.gravity_torque(m, state.theta) - T @ frame.r) / (47 * (1 / 20 + 1 / 8))
        assert step.acceleration(m, state) == pytest.approx(expected)
        tau_off = -(frame.rotation(state.theta) @ T)[0]
        assert step.thresholds(m, state, expected).tau_off == pytest.approx(tau_off)


def test_motors_do_what_the_energy_gains(rng):
    """The powers are the derivative of the total energy along the motion."""
    odd = Chassis.uniform(rng.normal(size=(4, 3)), 20.0)
    for rover, edge in ((ROVER, 1), (ROVER, 2), (Rover(odd, ROVER.cmg), 3)):
        m = model(edge, rover, incline=0.4, heading=0.3)
        for state in random_states(rng, 10):
            theta_ddot = step.acceleration(m, state)
            dt = 1e-5

            def energy(t, s=state, a=theta_ddot, m=m):
                theta = s.theta + s.theta_dot * t + a * t**2 / 2
                delta = s.delta + s.delta_dot * t + s.delta_ddot * t**2 / 2
                rates = (s.theta_dot + a * t, s.delta_dot + s.delta_ddot * t)
                return total_energy(m, step.State(theta, rates[0], delta, rates[1], s.delta_ddot))

            rate = (energy(dt) - energy(-dt)) / (2 * dt)
            assert rate == pytest.approx(sum(motor_powers(m, state, theta_ddot)), abs=1e-5)


def test_published_rotor_term(rng):
    """Eq 88's rotor term is 0.14 * 800 |d(theta' r.s)/dt|."""
    m, frame = model(2), ROVER.edge_frame(2)
    for state in random_states(rng, 5):
        theta_ddot, dt = step.acceleration(m, state), 1e-6

        def spin(t, s=state, a=theta_ddot):
            axis = ROVER.cmg.axes(s.delta + s.delta_dot * t)[0]
            return (s.theta_dot + a * t) * (frame.r @ axis)

        rotor = 112.0 * abs(spin(dt) - spin(-dt)) / (2 * dt)
        gimbal = abs(motor_powers(m, state, theta_ddot)[0])
        assert used_power(m, state, theta_ddot) == pytest.approx(rotor + gimbal, rel=1e-6)


def test_one_source_on_floats_arrays_and_symbols(rng):
    ca = pytest.importorskip("casadi")
    m = model(4, incline=0.2, heading=0.5)
    assert from_numbers(m.numbers) == m
    x, p = ca.SX.sym("x", 5), ca.SX.sym("p", len(m.numbers))
    symbolic = from_numbers(p)
    state = step.State(*ca.vertsplit(x))
    acceleration = step.acceleration(symbolic, state)
    spare = step.thresholds(symbolic, state, acceleration).spare
    outputs = [acceleration, *spare, used_power(symbolic, state, acceleration)]
    compiled = ca.Function("step", [x, p], [ca.vertcat(*outputs)])
    states = random_states(rng)
    at_once = step.State(*np.array(states).T)
    together = step.acceleration(m, at_once)
    rows = [together, *step.thresholds(m, at_once, together).spare]
    rows.append(used_power(m, at_once, together))
    for state, row in zip(states, np.array(rows).T, strict=True):
        alone = step.acceleration(m, state)
        values = [alone, *step.thresholds(m, state, alone).spare, used_power(m, state, alone)]
        assert row == pytest.approx(values, rel=1e-12)
        assert np.asarray(compiled(list(state), m.numbers))[:, 0] == pytest.approx(
            values, rel=1e-10
        )
