"""Allocation by quadratic programs: matrices, reference solvers, limits, fall-backs."""

from __future__ import annotations

from dataclasses import replace

import clarabel
import numpy as np
import pytest
from scipy import sparse

import nullmotion as nm
from nullmotion.allocation.blocks import blocks
from nullmotion.allocation.compiled import evaluate
from nullmotion.allocation.exclusion import exclusion
from nullmotion.law import Observation

RATE = 1.5


@pytest.fixture(scope="module")
def triangle():
    return nm.layouts.create("triangle", h0=2.0, rate_limit=RATE)


def law(**parameters):
    return nm.laws.create("allocation-mpc", **parameters)


def observed(array, rng, moves=5, near=False):
    """Return a random observation, near a singular line if asked."""
    delta = rng.uniform(-9, 9, array.n)
    if near:
        line = nm.singular_lines.nearest(array, delta)
        delta = line.delta_s + 0.3 * (delta - line.delta_s) / line.distance
    preview = rng.normal(size=(moves, array.m)) * 2.0
    rates = rng.uniform(-RATE, RATE, array.n)
    return Observation(delta, preview[0], 0.0, 0.1, delta_dot=rates, preview=preview)


def planned(steering, array, rng):
    """Return a memory with a plan from somewhere."""
    memory = steering.init(array, np.zeros(array.n))
    plan = rng.uniform(-RATE, RATE, memory.plan.shape)
    return memory._replace(plan=plan, planned=len(plan) - 1)


def paper_cost(steering, array, obs, memory, rates):
    """Return Eq 42 as it stands, the moves followed one after another."""
    h0, T = array.mean_momentum, obs.period
    near = exclusion(array, obs.delta, memory.normal)
    gamma, phi = obs.delta.copy(), obs.delta.copy()
    before, cost = obs.delta_dot, 0.0
    for x, p, wanted in zip(rates, memory.plan, obs.preview, strict=True):
        middle = phi + 0.5 * T * p if steering.midpoint else phi
        own = 0.5 * T * (x - p) if steering.midpoint else 0.0
        slope = np.stack(
            [
                (array.jacobian(middle + e) - array.jacobian(middle - e)) @ p / 2e-6
                for e in 1e-6 * np.eye(array.n)
            ],
            axis=1,
        )
        hdot = array.jacobian(middle) @ x + slope @ (gamma - phi + own)
        gamma, phi = gamma + T * x, phi + T * p
        eta = steering.kappa * (steering.kappa - near.normal @ (gamma - obs.delta) - near.distance)
        cost += 0.5 * steering.H * np.sum(((hdot - wanted) / h0) ** 2)
        cost += 0.5 * steering.U * x @ x + 0.5 * steering.M * (x - before) @ (x - before)
        cost += 0.5 * steering.rho * max(eta, 0.0) ** 2
        before = x
    return cost


@pytest.mark.slow
@pytest.mark.parametrize("midpoint", [False, True])
def test_program_is_equation_42(triangle, rng, midpoint):
    steering = law(midpoint=midpoint)
    obs = observed(triangle, rng, near=True)
    memory = planned(steering, triangle, rng)
    made = steering.program(triangle, obs, memory)[0]
    costs = []
    for _ in range(4):
        rates = rng.uniform(-RATE, RATE, (5, 3))
        eta = (made.A[-5:, :15] @ rates.ravel()) - made.upper[-5:]
        x = np.concatenate([rates.ravel(), np.maximum(eta, 0.0)])
        costs.append((made.cost(x), paper_cost(steering, triangle, obs, memory, rates)))
    ours, theirs = np.array(costs).T
    np.testing.assert_allclose(np.diff(ours), np.diff(theirs), rtol=1e-6, atol=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("layout", ["triangle", "pyramid"])
def test_compiled_blocks_are_those_of_the_source(layout, rng):
    array = nm.layouts.create(layout, h0=2.0)
    zero, delta = np.zeros(array.n), rng.uniform(-30, 30, array.n)
    plan, wanted = rng.normal(size=(4, array.n)), rng.normal(size=(4, array.m))
    weight = rng.uniform(1, 2, array.m)
    for midpoint in (False, True):
        found, line = evaluate(array, delta, plan, 2.0 * wanted, weight, 0.1, midpoint)
        spin, transverse = array.rotor_momenta(zero) / 2.0, array.unit_jacobian(zero).T
        plain = blocks(spin, transverse, delta, plan, wanted, weight, 0.1, midpoint)
        for a, b in zip(found, plain, strict=True):
            np.testing.assert_allclose(a, b, atol=1e-12)
    assert (line is None) == (layout == "pyramid")


def reference(problem):
    """Return the solution by Clarabel at its tightest, as a separate program."""
    n = problem.variables
    rows = np.concatenate([np.eye(n), problem.A])
    above = np.concatenate([problem.x_upper, problem.upper])
    below = np.concatenate([problem.x_lower, problem.lower])
    has = np.isfinite(above), np.isfinite(below)
    A = np.concatenate([rows[has[0]], -rows[has[1]]])
    b = np.concatenate([above[has[0]], -below[has[1]]])
    settings = clarabel.DefaultSettings()
    settings.verbose = False
    settings.tol_gap_abs = settings.tol_gap_rel = settings.tol_feas = 1e-12
    cones = [clarabel.NonnegativeConeT(len(b))]
    H = sparse.triu(sparse.csc_matrix(problem.H), format="csc")
    solver = clarabel.DefaultSolver(H, problem.g, sparse.csc_matrix(A), b, cones, settings)
    return np.array(solver.solve().x)


@pytest.mark.parametrize("moves", [1, 5, 12])
def test_objective_and_rates_against_another_solver(triangle, rng, moves):
    steering = law(N_p=moves, acceleration_limit_rad_s2=7.0)
    active = 0
    for _ in range(20):
        obs = observed(triangle, rng, moves, near=True)
        memory = planned(steering, triangle, rng)
        problem = steering.program(triangle, obs, memory)[0]
        rates, after = steering.step(triangle, obs, memory)
        assert sum(after.counts().values()) == 0
        x = reference(problem)
        ours = nm.qp.solve(problem)
        scale = abs(problem.cost(x)) + 1e-12
        assert abs(problem.cost(ours.x) - problem.cost(x)) <= 1e-7 * scale
        np.testing.assert_allclose(rates, x[:3], atol=1e-4)
        active += x[-1] > 1e-3
    assert active > 3  # the term of the distance takes part


@pytest.mark.parametrize("name", ["allocation-mpc", "action-governor"])
def test_limits_are_kept(triangle, rng, name):
    array = nm.layouts.create(
        "triangle", h0=2.0, rate_limit=RATE, angle_limits=[[-2.0, 2.0], [-1.0, 1.0], [-3.0, 3.0]]
    )
    steering = nm.laws.create(name, acceleration_limit_rad_s2=7.0)
    delta, rates, state = np.zeros(3), np.zeros(3), steering.init(array, np.zeros(3))
    for k in range(80):
        hdot = 2.0 * np.array([np.cos(0.1 * k), np.sin(0.1 * k)])
        obs = Observation(delta, hdot, 0.1 * k, 0.1, delta_dot=rates)
        found, state = steering.step(array, obs, state)
        delta = delta + 0.1 * found
        assert (np.abs(found) <= RATE + 1e-9).all()
        stopped = np.abs(delta) >= array.angle_limits[:, 1] - 1e-6
        assert (np.abs(found - rates) <= 0.7 + 1e-9)[~stopped].all()
        assert (np.abs(delta) <= array.angle_limits[:, 1] + 1e-9).all()
        rates = found


def test_the_governor_gives_the_torque_and_turns_away(triangle):
    governor = nm.laws.create("action-governor", kappa=1.0)
    line = nm.singular_lines.nearest(triangle, [0.2, 0.5, -0.4])
    away = np.array([1.0, -1.0, 0.0]) / np.sqrt(2)
    delta, hdot = line.delta_s + 0.5 * away, np.array([0.1, -0.2])
    memory = governor.init(triangle, delta)
    rates, _ = governor.step(triangle, Observation(delta, hdot, 0.0, 0.1), memory)
    np.testing.assert_allclose(triangle.jacobian(delta) @ rates, hdot, atol=1e-9)
    plain = np.linalg.pinv(triangle.jacobian(delta)) @ hdot
    normal = exclusion(triangle, delta, away).normal
    assert normal @ rates > normal @ plain + 1e-3
    far = governor.step(triangle, Observation(np.zeros(3), hdot, 0.0, 0.1), memory)[0]
    np.testing.assert_allclose(far, np.linalg.pinv(triangle.jacobian(np.zeros(3))) @ hdot)


def test_without_time_the_plan_and_then_the_inverse_stand_in(triangle, rng):
    steering = law(N_p=3, time_limit_s=1e-9)
    calm = law(N_p=3)
    obs = replace(observed(triangle, rng, 3), delta_dot=np.zeros(3))
    _, memory = calm.step(triangle, obs, calm.init(triangle, obs.delta))
    plan = memory.plan.copy()
    for k in range(2):
        rates, memory = steering.step(triangle, obs, memory)
        np.testing.assert_allclose(rates, plan[k], atol=1e-12)
    rates, memory = steering.step(triangle, obs, memory)
    least = np.linalg.pinv(triangle.jacobian(obs.delta)) @ obs.hdot
    np.testing.assert_allclose(rates, np.clip(least, -RATE, RATE), atol=1e-9)
    assert memory.counts() == {"fell_back_to_plan": 2, "fell_back_to_inverse": 1}


def test_at_a_singular_line_the_last_direction_stays(triangle):
    steering = law()
    delta = np.array([0.0, 2 * np.pi / 3, -2 * np.pi / 3])
    normal = np.array([1.0, -1.0, 0.0]) / np.sqrt(2)
    memory = steering.init(triangle, delta)._replace(normal=normal)
    obs = Observation(delta, np.zeros(2), 0.0, 0.1, delta_dot=np.zeros(3))
    rates, after = steering.step(triangle, obs, memory)
    np.testing.assert_allclose(after.normal, normal)
    assert normal @ rates > 0.1
    fresh = steering.step(triangle, obs, steering.init(triangle, delta))
    np.testing.assert_allclose(fresh[0], 0.0, atol=1e-9)  # no side is nearer than the other


def test_what_is_refused(triangle):
    for key, value in {"N_p": 0, "H": -1.0, "kappa": 0.0, "solver": "simplex"}.items():
        with pytest.raises(nm.InputError, match=f"law.{key}"):
            law(**{key: value})
    assert "weights" in law(U=(1.0, 2.0)).supports(triangle)
    assert law(U=(1.0, 2.0, 3.0), H=(1.0, 2.0)).supports(triangle) == ""
    assert "null motion" in law().supports(nm.layouts.create("pyramid", n=3))
