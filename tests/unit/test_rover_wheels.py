"""Rovers with reaction wheels, impulsive and versine steps, and the CMG rover's versine."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp
from scipy.optimize import linprog

from nullmotion.errors import InputError
from nullmotion.rover.chassis import Chassis
from nullmotion.rover.fly_step import track
from nullmotion.rover.impulsive import impulsive_step
from nullmotion.rover.polyhedron import NAMES
from nullmotion.rover.rover import Site, peter
from nullmotion.rover.step_dynamics import State, acceleration
from nullmotion.rover.step_model import step_model
from nullmotion.rover.versine import Versine, verdict
from nullmotion.rover.versine_cmg import cmg_versine
from nullmotion.rover.versine_plan import versine_plan
from nullmotion.rover.versine_wheels import versine_step
from nullmotion.rover.wheels import WheelRover, hedgehog, hypothesised, stays

TEN = Site(incline=np.radians(10.0))
MOON = 1.62


def heavy() -> WheelRover:
    """A rover that no paper has: an octahedron with large wheels."""
    return WheelRover(Chassis.named("octahedron", 0.7, 31.0), 0.02)


def turning(rover, edge, site):
    """N, M and the mass centre's height above the edge by theta, from rotated corners alone."""
    frame = rover.chassis.edge_frame(edge)
    lever = -frame.point
    lever = lever - (lever @ frame.r) * frame.r
    N = frame.r @ rover.chassis.inertia @ frame.r + rover.mass * lever @ lever
    down = frame.axes.T @ site.vector / site.gravity

    level, ahead = -lever @ down, -np.cross(frame.r, lever) @ down

    def height(theta):
        return level * np.cos(theta) + ahead * np.sin(theta)

    return N, height


def test_hedgehog_and_its_variant_hold_the_same_sphere():
    cube, other = hedgehog(), hypothesised()
    assert cube.chassis.inertia == pytest.approx(np.eye(3) * 18.75 * 0.25**2 / 6)
    assert other.chassis.inertia == pytest.approx(cube.chassis.inertia)
    assert other.chassis.edge_frame(1).length == pytest.approx(0.61, abs=0.005)
    for rover in (cube, other):
        chassis = rover.chassis
        gaps = [
            -(chassis.vertices[face[0]] @ chassis.up(i)) for i, face in enumerate(chassis.faces)
        ]
        assert gaps == pytest.approx([0.125] * len(gaps))


@pytest.mark.parametrize("make", [hedgehog, hypothesised, heavy])
@pytest.mark.parametrize("slope", [-20.0, 0.0, 17.0, 30.0])
@pytest.mark.parametrize("gravity", [3.711, MOON])
def test_an_impulsive_step_just_gets_over(make, slope, gravity):
    rover, site = make(), Site(gravity, np.radians(slope), heading=0.2)
    step = impulsive_step(rover, 2, site)
    N, height = turning(rover, 2, site)

    def fall(t, y):
        climb = (height(y[0] + 1e-6) - height(y[0] - 1e-6)) / 2e-6
        return [y[1], -rover.mass * gravity * climb / N]

    angles = np.linspace(0, 3, 1_000_001)
    top = angles[np.argmax(height(angles))]

    def passed(t, y):
        return y[1] if y[0] < top else top + 0.1 - y[0]

    def highest(share):
        passed.terminal = True
        start = [0, share * step.momentum / N]
        found = solve_ivp(fall, (0, 8), start, events=passed, rtol=1e-8, atol=1e-9)
        return found.y[0].max()

    assert highest(0.999) < top < highest(1.001)
    assert step.lift == pytest.approx(rover.mass * gravity * (height(top) - height(0)), rel=1e-6)
    assert step.energy == pytest.approx(step.momentum**2 / 2 / rover.wheel_inertia)
    assert step.cost_of_travel == pytest.approx(step.energy / rover.mass / step.distance)


@pytest.mark.parametrize("make", [hedgehog, hypothesised, heavy])
@pytest.mark.parametrize("slope", [-12.0, 0.0, 33.0])
def test_a_versine_balances_energy_and_follows_lagrange(make, slope):
    rover, site = make(), Site(2.9, np.radians(slope), heading=-0.15)
    found, step = versine_step(rover, 1, site, rate=1.3), Versine.over(np.pi / 3, 1.0)
    N, height = turning(rover, 1, site)
    I, t = rover.wheel_inertia, found.step.t
    rise = height(found.step.theta[-1]) - height(0)
    wheel = 0.5 * I * (found.speed + found.step.theta_dot)[-1] ** 2
    assert found.work == pytest.approx(wheel + rover.mass * 2.9 * rise, rel=1e-7, abs=1e-9)
    # d/dt dL/dtheta' of L = (N - I) theta'^2/2 + I (theta' + psi')^2/2 - M g z is dL/dtheta
    total = (N - I) * found.step.theta_dot + I * (found.step.theta_dot + found.speed)
    force = -(height(found.step.theta + 1e-6) - height(found.step.theta - 1e-6)) / 2e-6
    slope_of_total = np.gradient(total, t)[2:-2]
    assert slope_of_total == pytest.approx(rover.mass * 2.9 * force[2:-2], abs=2e-3)
    # each wheel is driven alone: sum |T r_i . w r_i|
    r = rover.chassis.edge_frame(1).r
    power = np.abs(np.outer(found.torque, r) * np.outer(found.speed, r)).sum(axis=1)
    assert found.energy == pytest.approx(np.trapezoid(power, t), rel=1e-5)
    assert step.theta[-1] == pytest.approx(np.pi / 3) and np.abs(step.theta_dot).max() <= 1.0


def test_a_versine_is_a_versine():
    step = Versine.over(1.9, 0.8, 20_001)
    assert np.gradient(step.theta, step.t)[1:-1] == pytest.approx(step.theta_dot[1:-1], abs=1e-6)
    assert np.gradient(step.theta_dot, step.t)[1:-1] == pytest.approx(
        step.theta_ddot[1:-1], abs=1e-6
    )
    assert step.theta[[0, -1]] == pytest.approx([0, 1.9]) and step.theta_dot.max() <= 0.8
    with pytest.raises(InputError, match="rate_rad_s"):
        Versine.over(1.9, 0.0)


def test_a_wheel_that_is_too_slow_stalls_the_step():
    free = versine_step(hedgehog(), 1, TEN)
    limit = 0.6 * np.abs(free.speed).max()
    slow = WheelRover(hedgehog().chassis, 0.00095, speed_limit=limit)
    found = versine_step(slow, 1, TEN)
    assert free.outcome == "landed" and found.outcome == "stalled"
    assert "rad/s" in found.verdict.reason and 0 < found.verdict.time < free.step.t[-1]
    weak = WheelRover(hedgehog().chassis, 0.00095, torque_limit=1e-3)
    assert "N m" in versine_step(weak, 1, TEN).verdict.reason
    assert impulsive_step(slow, 1, TEN).outcome == "landed"
    spun = impulsive_step(hedgehog(), 1, TEN).wheel_speed
    slower = WheelRover(hedgehog().chassis, 0.00095, speed_limit=0.9 * spun)
    assert impulsive_step(slower, 1, TEN).outcome == "stalled"


def test_a_fast_wheel_versine_lifts_off():
    slow, fast = (versine_step(hedgehog(), 1, TEN, rate) for rate in (3.0, 8.0))
    assert slow.outcome == "landed" and fast.outcome == "lifted off"
    # the ground would have to pull: the mass centre's own acceleration, by differences
    for found in (slow, fast):
        theta, t = found.step.theta, found.step.t
        d, a = 0.25 / np.sqrt(2), np.pi / 4
        rising = np.gradient(np.gradient(d * np.cos(a - theta), t), t)[3:-3]
        load = 18.75 * (3.711 * np.cos(np.radians(10)) + rising)
        assert (load.min() < 0) == (found.outcome == "lifted off")
        assert found.spare.sum(axis=0)[3:-3] / 0.25 == pytest.approx(load, rel=1e-3, abs=0.02)


def test_weight_aside_tips():
    tilted = Site(3.711, np.radians(20), heading=np.pi / 2)
    found = versine_step(hypothesised(), 1, tilted, rate=3.6)
    assert found.outcome == "tipped" and "spike" in found.verdict.reason


@pytest.mark.parametrize("name", NAMES)
def test_stays_as_its_shadow_says(name, rng):
    chassis = Chassis.named(name, 0.8, 3.0)
    answers = []
    for _ in range(60):
        face = int(rng.integers(len(chassis.faces)))
        up, points = chassis.up(face), chassis.vertices[list(chassis.faces[face])]
        lean = rng.normal(size=3)
        gravity = -up + rng.uniform(0, 3.0) * (lean - (lean @ up) * up) / np.linalg.norm(lean)
        shadow = gravity * (points[0] @ up) / (gravity @ up)  # along gravity onto the ground
        table = np.vstack([points.T, np.ones(len(points))])
        held = linprog(np.zeros(len(points)), A_eq=table, b_eq=[*shadow, 1.0]).status == 0
        answers.append(held)
        assert stays(chassis, face, gravity) == held
    assert any(answers) and not all(answers)


def test_refusals():
    for step in (impulsive_step, versine_step):
        with pytest.raises(InputError, match="45 deg") as caught:
            step(hedgehog(), 1, Site(incline=np.radians(46)))
        assert caught.value.key == "incline_deg"
        step(hypothesised(), 1, Site(incline=np.arctan(np.sqrt(2))))
        with pytest.raises(InputError, match="edge"):
            step(hedgehog(), 13)
    with pytest.raises(InputError, match="wheel_inertia"):
        WheelRover(Chassis.named("cube"), 0.0)
    with pytest.raises(InputError, match="own inertia"):
        WheelRover(Chassis.named("cube", 0.1, 1.0), 1.0)
    with pytest.raises(InputError, match="speed_limit"):
        WheelRover(Chassis.named("cube"), 0.001, speed_limit=-1.0)


CASES = [(1, 0.2), (1, 0.3), (2, 0.2), (1, 1.0), (1, 2.0), (2, 1.0), (2, 2.0), (2, 4.0)]


@pytest.mark.parametrize(("edge", "rate"), CASES)
def test_versines_of_the_cmg_rover_on_ten_degrees(edge, rate):
    found = cmg_versine(peter(), edge, TEN, rate)
    slow, fast = rate < 0.5, (edge, rate) in ((1, 1.0), (1, 2.0), (2, 4.0))
    assert found.outcome == ("stalled" if slow else "tipped" if fast else "landed")
    assert found.verdict.reason if slow or fast else not found.verdict.reason
    # in closed loop a step that stalls never gets over the edge; one that tips goes through
    run = track(versine_plan(peter(), edge, TEN, rate))
    assert (run.theta.max() < np.radians(60)) == slow
    assert slow or run.theta[-1] > np.radians(108)
    assert (run.margin.min() < 0) == (slow or fast)


@pytest.mark.parametrize("edge", [1, 2])
def test_a_slow_versine_asks_for_more_momentum_than_there_is(edge):
    rover = peter()
    frame, h = rover.edge_frame(edge), 115.0
    N = rover.chassis.inertia_about_edge(edge)
    available = 2 * h * np.sqrt(1 - (frame.r @ rover.cmg.gimbal_axis) ** 2)
    half, weight = frame.turn / 2, 47 * 3.711 * frame.com_distance
    for rate in (0.2, 0.3, 0.4, 0.5, 0.7):
        A = rate / half

        def pull(t, A=A):
            return weight * np.sin(half + TEN.incline - half * (1 - np.cos(A * t)))

        times = np.linspace(0, np.pi / A, 200)
        given = [quad(pull, 0, t)[0] + N * rate * np.sin(A * t) for t in times]
        outcome = cmg_versine(rover, edge, TEN, rate).outcome
        if np.ptp(given) > 1.02 * available:
            assert outcome == "stalled"
        if np.ptp(given) < 0.8 * available:
            assert outcome != "stalled"


def test_the_gimbal_of_a_versine_drives_the_full_dynamics():
    rover, site = peter(), Site(MOON, np.radians(-5.0))
    found = cmg_versine(rover, 2, site, 0.9)
    assert found.outcome == "landed" and (found.margin >= 0).all()
    model, step = step_model(rover, rover.edge_frame(2), site), found.step
    swing = np.gradient(found.delta_dot, step.t)
    assert np.gradient(found.delta, step.t)[1:-1] == pytest.approx(found.delta_dot[1:-1], abs=2e-4)
    state = State(step.theta, step.theta_dot, found.delta, found.delta_dot, swing)
    assert acceleration(model, state) == pytest.approx(step.theta_ddot, abs=1e-6)


def test_too_fast_for_the_gimbal():
    slow_gimbal = peter()
    object.__setattr__(slow_gimbal.cmg, "rate_limit", 0.7)
    found = cmg_versine(slow_gimbal, 2, TEN, 2.0)
    assert found.outcome == "fell behind" and "0.7 rad/s" in found.verdict.reason


def test_first_thing_that_goes_wrong_counts():
    step = Versine.over(1.0, 1.0, 5)
    fine, never = np.ones(5), np.zeros(5, bool)
    late = np.array([1.0, 1, 1, -1, -1])
    assert verdict(step, never, (fine, fine), "").outcome == "landed"
    assert verdict(step, never, (fine * 2, late), "").reason.startswith("spike a")
    assert verdict(step, never, (late, fine * 2), "").reason.startswith("spike b")
    assert verdict(step, never, (late, late), "").outcome == "lifted off"
    short = np.array([0, 0, 1, 1, 1], bool)
    found = verdict(step, short, (late, fine), "power")
    assert (found.outcome, found.reason) == ("stalled", "power")
    assert found.time == pytest.approx(step.t[2]) and found.angle == pytest.approx(step.theta[2])
