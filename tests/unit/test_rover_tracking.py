"""The step in closed loop, and the gimbal on its way to the start."""

from __future__ import annotations

import numpy as np
import pytest

from nullmotion.errors import InputError
from nullmotion.rover import Gains, Site, initialise, peter, plan_step, track
from nullmotion.rover.limits import base_edges, rest_torque, static_spare

pytest.importorskip("casadi")

ROVER = peter()
INCLINES = (0.0, 15.0, 30.0, 45.0, np.degrees(np.arccos(1 / 3**0.5)))
PRINTED = (5.6, 6.7, 6.6, 8.3, 10.7)  # Table 4, e1


def planned(edge, degrees):
    return plan_step(ROVER, edge, Site(incline=np.radians(degrees)))


@pytest.fixture(scope="module")
def steep():
    return planned(1, 45.0)


def check(run):
    """Limits, error, margin and energy of a run that succeeds."""
    assert run.outcome == "landed"
    assert np.abs(run.delta_dot).max() <= 2.0 + 1e-6
    assert np.abs(run.delta_ddot).max() <= 20.0 + 1e-6
    assert run.delta_dot[0] == 0.0
    assert run.max_angle_error < 0.05
    assert run.margin.min() > 0 and run.least_margin > 0 and run.least_static_margin > 0
    assert run.energy_balance < 1e-5
    assert run.theta[-1] == pytest.approx(run.plan.frame.turn, abs=0.01)
    assert 0 < run.lift_off < 0.1 and not run.theta[~run.turning].any()
    for value, rate in ((run.theta, run.theta_dot), (run.delta, run.delta_dot)):
        change = np.concatenate([[0.0], np.cumsum(np.diff(run.t) * (rate[1:] + rate[:-1]) / 2)])
        assert value - value[0] == pytest.approx(change, abs=1e-4)


def test_a_steep_step_in_closed_loop(steep):
    run = track(steep)
    check(run)
    assert run.energy == pytest.approx(steep.energy, rel=0.03)
    assert run.cost_of_travel == pytest.approx(run.energy / (47 / 3**0.5))


@pytest.mark.slow
def test_the_ten_published_steps_in_closed_loop():
    costs = []
    for edge in (1, 2):
        for degrees in INCLINES:
            run = track(planned(edge, degrees))
            check(run)
            costs.append(run.cost_of_travel)
    assert costs[:5] == pytest.approx(PRINTED, rel=0.35)
    assert costs[4] >= 1.4 * costs[0]


@pytest.mark.slow
def test_weak_gains_tip_the_rover():
    run = track(planned(1, 30.0), Gains(kp=4.0, kd=4.0))
    assert run.outcome == "tipped" and run.margin.min() < 0
    assert run.energy_balance < 1e-5


def test_gravity_alone_does_not_move_the_rover_at_rest(steep):
    """Until the torque about the edge exceeds gravity's, the body lies on its face."""
    run = track(steep)
    rest = ~run.turning
    pull = rest_torque(ROVER, run.delta, run.delta_dot, run.delta_ddot) @ steep.frame.r
    held = -47 * 3.711 / (2 * 2**0.5) * np.sin(np.arccos(1 / 3**0.5) + steep.site.incline)
    assert (-pull[rest] + held < 1e-6).all()
    first = np.argmax(run.turning)
    assert -pull[first] + held == pytest.approx(0.0, abs=0.05)


@pytest.mark.parametrize("delta", [-3.0, 0.0, 1.0, 2.5])
@pytest.mark.parametrize("share", [0.3, 1.0])
def test_the_gimbal_gets_to_the_start_below_the_threshold(steep, delta, share):
    moved = initialise(steep, delta, share)
    assert moved.delta[0] == delta and moved.delta_dot[0] == 0.0
    turns = (moved.delta[-1] - steep.delta[0]) / (2 * np.pi)
    assert turns == pytest.approx(round(turns), abs=1e-5)
    assert abs(moved.delta_dot[-1]) < 1e-4
    assert np.abs(moved.delta_dot).max() <= 2.0 and np.abs(moved.delta_ddot).max() <= 20.0
    assert moved.spare.min() > (1 - share) * moved.threshold
    assert moved.duration < 60.0  # the pause that Section 5.6.2 assumes


def test_the_static_threshold():
    """At rest gravity holds PETER with M g times the mass centre's distance from the edge."""
    frame = ROVER.edge_frame(1)
    spare = static_spare(ROVER, frame, Site(gravity=3.711), np.zeros(3))
    assert spare == pytest.approx(47 * 3.711 / (2 * 3**0.5))
    assert base_edges(ROVER, 0) == [1, 2, 3]
    # a torque on the body about an edge tips it over this edge
    pushed = static_spare(ROVER, frame, Site(gravity=3.711), -10.0 * frame.r)
    assert pushed == pytest.approx(spare - 10.0)


def test_what_makes_no_sense_is_refused(steep):
    with pytest.raises(InputError, match="share"):
        initialise(steep, 0.0, share=1.5)
    with pytest.raises(InputError, match="kp"):
        Gains(kp=0.0)
