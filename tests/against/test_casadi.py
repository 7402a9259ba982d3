"""Derivatives of a run against CasADi, from formulas written again here."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import nullmotion as nm
from nullmotion import tree
from nullmotion.compile.kernel import LoopKernel
from nullmotion.compile.loop_tangent import differentiated
from nullmotion.sim import Setup
from nullmotion.sim.stages import loop
from nullmotion.sim.state import parameters

ca = pytest.importorskip("casadi")

BETA, DT, STEPS, LIMIT, DAMPING = np.radians(54.73), 0.1, 40, np.radians(50.0), 0.3
START, COMMAND = np.array([0.2, -0.1, 0.3, 0.05]), np.array([0.3, 0.1, -0.2])
KNOTS = np.array([0.4, 0.9, -0.3, 0.2, -0.8, 0.1])


def jacobian(d):
    """The pyramid's Jacobian, entry by entry."""
    cb, sb = np.cos(BETA), np.sin(BETA)
    s, c = ca.sin(d), ca.cos(d)
    rows = [
        ca.horzcat(-cb * c[0], s[1], cb * c[2], -s[3]),
        ca.horzcat(-s[0], -cb * c[1], s[2], cb * c[3]),
        ca.horzcat(sb * c[0], sb * c[1], sb * c[2], sb * c[3]),
    ]
    return ca.vertcat(*rows)


def minors(a):
    """Signed minors, along which no torque comes."""
    columns = [[j for j in range(4) if j != i] for i in range(4)]
    return ca.vertcat(*[(-1) ** i * ca.det(a[:, keep]) for i, keep in enumerate(columns)])


def final_angles(knots):
    """Return the gimbal angles after damped steering with planned null motion."""
    d = ca.SX(START)
    for k in range(STEPS):
        a = jacobian(d)
        place = k * (len(KNOTS) - 1) / STEPS
        i, share = int(place), place - int(place)
        size = (1 - share) * knots[i] + share * knots[i + 1]
        rates = a.T @ ca.solve(a @ a.T + DAMPING * ca.SX.eye(3), COMMAND)
        rates = rates + 4 * 0.7 * size * minors(a)
        excess = ca.mmax(ca.fabs(rates)) / LIMIT
        d = d + DT * rates / ca.fmax(excess, 1.0)
    return d


def test_a_run_has_the_derivatives_of_casadi():
    array = nm.layouts.pyramid(skew=BETA, h0=1.0, rate_limit=LIMIT)
    law = nm.laws.create(
        "follow-plan",
        base="sr",
        base_parameters={"schedule": "constant", "lambda0": DAMPING},
        knots=tuple(KNOTS),
        duration_s=STEPS * DT,
        k_max=0.7,
    )
    setup = Setup(array, law, START, COMMAND, dt=DT, steps=STEPS, integrator="euler")
    own = parameters(setup)
    leaves = tree.flatten(own)
    knots = [leaves.index(k) for k in KNOTS]
    chosen = tuple(i in knots for i in range(len(leaves)))
    what = replace(loop(setup, chosen), outputs=lambda s, p: s.delta)
    kernel = LoopKernel(differentiated(what, chosen), width=8)
    values = np.zeros((12, 8))
    values[:6], values[6:, :6] = KNOTS[:, None], np.eye(6)
    state, none = np.zeros((kernel.carried, 8)), np.zeros((1, 0))
    out = np.zeros((kernel.outputs + len(kernel.flags), 8))
    kernel.run(state, values, none, none, out, 0, 8, 0, STEPS, True)

    symbols = ca.SX.sym("k", 6)
    angles = final_angles(symbols)
    truth = ca.Function("f", [symbols], [angles, ca.jacobian(angles, symbols)])(KNOTS)
    assert np.allclose(out[:4, 0], np.array(truth[0]).ravel(), atol=1e-12)
    np.testing.assert_allclose(out[4:8, :6], np.array(truth[1]), rtol=1e-9, atol=1e-10)
