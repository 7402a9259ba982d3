"""Planning a step: the ten published ones, limits, failures, interruption."""

from __future__ import annotations

import signal
from dataclasses import replace

import numpy as np
import pytest

from nullmotion.errors import InputError
from nullmotion.rover import Chassis, Cmg, PlanError, Rover, Settings, Site, peter, plan_step
from nullmotion.rover import step_dynamics as step
from nullmotion.rover.dense import interpolated, interpolated_at
from nullmotion.rover.spread import energy_spread
from nullmotion.rover.step_model import step_model

pytest.importorskip("casadi")

ROVER = peter()
INCLINES = (0.0, 15.0, 30.0, 45.0, np.degrees(np.arccos(1 / 3**0.5)))
TABLE4 = {1: (5.6, 6.7, 6.6, 8.3, 10.7), 2: (19.2, 18.0, 16.5, 13.6, 12.3)}


def planned(edge, degrees, **options):
    return plan_step(ROVER, edge, Site(incline=np.radians(degrees)), **options)


@pytest.fixture(scope="module")
def uphill():
    return planned(1, 15.0)


@pytest.fixture(scope="module")
def published():
    """The ten steps of Table 4."""
    return {edge: [planned(edge, degrees) for degrees in INCLINES] for edge in TABLE4}


def on_dense_grid(plan):
    t = np.linspace(0.0, plan.duration, 10 * (len(plan.t) - 1) + 1)
    return t, interpolated(plan.x, plan.duration, t)


def check(plan, settings=None):
    """Every row of Table 1, on the dense grid, with equations of motion from SciPy's integrator."""
    from scipy.integrate import solve_ivp

    settings = settings or Settings()
    model = step_model(plan.rover, plan.frame, plan.site)
    _, x = on_dense_grid(plan)
    state = step.State(x[0], x[1], x[3], x[4], x[5])
    limits = step.thresholds(model, state, step.acceleration(model, state))
    assert np.min(limits.spare) > 0  # 1
    assert np.min(limits.spare) == pytest.approx(plan.least_margin)
    assert limits.tau_DTa.min() > 0 and limits.tau_DTb.max() < 0  # 2
    assert 0 < plan.duration <= settings.longest + 1e-6  # 3
    assert np.abs(x[4]).max() <= plan.rover.cmg.rate_limit + 1e-6  # 4
    assert np.abs(x[5]).max() <= settings.acceleration + 1e-6  # 5
    drive = step.authority(model, x[3])
    assert np.abs(drive).min() > settings.authority - 2e-3  # 6
    assert (np.sign(drive) == plan.branch).all()
    assert x[:2, 0] == pytest.approx([0, 0], abs=1e-6)  # 7
    assert x[:2, -1] == pytest.approx([plan.frame.turn, 0], abs=1e-6)  # 8
    assert np.abs(x[1]).max() <= settings.body_rate + 1e-3  # 9
    for k in range(0, len(plan.t) - 5, len(plan.t) // 8):
        piece = plan.t[k : k + 5]

        def rates(time, y):
            delta, delta_dot, delta_ddot = interpolated(plan.x, plan.duration, time)[3:]
            return [y[1], step.acceleration(model, step.State(*y, delta, delta_dot, delta_ddot))]

        found = solve_ivp(rates, piece[[0, -1]], plan.x[:2, k], rtol=1e-9, atol=1e-10)
        assert found.y[:, -1] == pytest.approx(plan.x[:2, k + 4], abs=5e-4)


def test_a_step_uphill(uphill):
    check(uphill)
    assert (uphill.frame.edge, uphill.branch) == (1, 1)
    assert len(uphill.t) >= 239 and uphill.margin.shape == uphill.t.shape
    assert uphill.cost_of_travel == pytest.approx(uphill.energy / 47 * 3**0.5)


@pytest.mark.sampled(1)
@pytest.mark.parametrize(("edge", "face"), [(3, 0), (1, 3), (4, 1), (4, 2), (6, 1), (6, 3)])
def test_both_signs_are_tried(uphill, edge, face):
    """The better branch has the sign of r . g; between mirrored edges only the branch differs."""
    other = planned(edge, 15.0, face=face)
    assert other.branch == np.sign(other.frame.r @ ROVER.cmg.gimbal_axis)
    assert other.least_margin == pytest.approx(uphill.least_margin, rel=1e-3)


@pytest.mark.slow
def test_the_ten_published_steps(published):
    plans = [plan for row in published.values() for plan in row]
    assert sum(plan.seconds for plan in plans) < 60.0
    for plan in plans:
        check(plan)


@pytest.mark.slow
def test_energies_of_table_4(published):
    costs = [plan.cost_of_travel for plan in published[1]]
    assert costs == pytest.approx(TABLE4[1], rel=0.35)
    assert costs[-1] >= 1.4 * costs[0]


@pytest.mark.slow
def test_the_spread_over_solver_settings():
    """The energy is not fixed by Eq 84: the margins of e2 agree, its energies do not."""
    spread = energy_spread(ROVER, 2, Site(incline=np.radians(15.0)))
    costs, margins = spread.costs, [plan.least_margin for plan in spread.plans]
    assert len(costs) == len(spread.settings)
    assert np.ptp(margins) < 0.02 * max(margins)
    assert costs[-1] > 1.1 * costs[0]


def test_interpolation_is_the_collocation(uphill):
    t, x = on_dense_grid(uphill)
    assert x[:, ::10] == pytest.approx(uphill.x, abs=1e-6)
    rows = uphill.x.T.tolist()
    for k in (0, 7, 333, len(t) - 1):
        assert interpolated_at(rows, uphill.duration, float(t[k])) == pytest.approx(x[:, k])
    for angle, rate in ((0, 1), (1, 2), (3, 4), (4, 5)):
        slope = np.gradient(x[angle], t, edge_order=2)
        assert slope == pytest.approx(x[rate], abs=0.02 * np.abs(x[rate]).max() + 1e-3)
    after = interpolated(uphill.x, uphill.duration, uphill.duration + 1.0)
    assert after[[0, 3]] == pytest.approx(uphill.x[[0, 3], -1]) and not after[[1, 2, 4, 5]].any()


def test_other_rovers_and_places():
    """A cube on the Moon with a CMG of its own."""
    chassis = Chassis.named("cube", edge_length=0.5, mass=20.0)
    cmg = Cmg(chassis.gimbal_axis(), np.array([1.0, 0, 0]), 12.0, 2.0, 20.0)
    plan = plan_step(Rover(chassis, cmg), 2, Site(gravity=1.62, incline=0.1))
    check(plan)
    assert plan.energy > 0 and plan.frame.turn == pytest.approx(np.pi / 2)


def test_a_slope_too_steep_says_by_how_much():
    with pytest.raises(PlanError, match=r"off-axis torque.*violated by .* N m") as caught:
        planned(1, 70.0)
    (violation,) = caught.value.violations
    assert violation.value < 0 and violation.amount == -violation.value


@pytest.mark.slow
@pytest.mark.parametrize(
    ("rover", "settings", "name"),
    [
        (replace(ROVER, cmg=replace(ROVER.cmg, rate_limit=0.2)), Settings(), "gimbal rate"),
        (ROVER, Settings(longest=1.0), "time of the step"),
        (ROVER, Settings(acceleration=0.05), "gimbal acceleration"),
        (ROVER, Settings(authority=0.9), "singular orientation: |o.r| ="),
        (ROVER, Settings(body_rate=0.05), "body rate"),
    ],
)
def test_a_failed_solve_names_the_limit(rover, settings, name):
    site = Site(incline=0.3)
    with pytest.raises(PlanError) as caught:
        plan_step(rover, 1, site, settings=settings)
    worst = caught.value.violations[0]
    assert worst.name == name and worst.amount > 0


def test_progress_and_a_way_out():
    shares = []
    planned(2, 0.0, progress=shares.append)
    assert shares[-1] == 1.0 and len(shares) > 20
    assert all(0 <= share <= 1 for share in shares)
    assert (np.diff(shares) >= -1e-12).all()

    def stop(share):
        if share > 0.1:
            signal.raise_signal(signal.SIGINT)

    with pytest.raises(KeyboardInterrupt):
        planned(2, 0.0, progress=stop)
    assert planned(2, 0.0).least_margin > 0  # the program is as good as before


@pytest.mark.parametrize(
    ("settings", "key"),
    [
        ({"nodes": (5, 120)}, "nodes"),
        ({"regularisation": 0.0}, "regularisation"),
        ({"start_durations": ()}, "start_durations"),
        ({"shortest": 11.0}, "longest"),
        ({"authority": 1.0}, "authority"),
    ],
)
def test_settings_that_make_no_sense_are_refused(settings, key):
    with pytest.raises(InputError) as caught:
        Settings(**settings)
    assert caught.value.key == key


def test_an_edge_that_is_not_there_is_refused():
    with pytest.raises(InputError, match="1 to 6"):
        planned(7, 0.0)
