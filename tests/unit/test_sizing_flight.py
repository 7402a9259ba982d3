"""Flights of sizing against flights of scenarios, which know nothing of sizing."""

from __future__ import annotations

import numpy as np
import pytest

import nullmotion as nm
from nullmotion import sizing
from nullmotion.array import layouts
from nullmotion.guarantee import torque_capability
from nullmotion.scenario.scenario import checked
from nullmotion.scenario.source import Source
from nullmotion.sizing import start
from nullmotion.sizing.axes import spread
from nullmotion.sizing.cases import NONE_FAILED, cases, multiplicity
from nullmotion.sizing.curve import Curve, Design, rates
from nullmotion.sizing.files import scenario_files
from nullmotion.sizing.geometry import Geometry
from nullmotion.sizing.slews import failing, lattice, nearby, searched
from nullmotion.sizing.trial import Fleet, Trial

LEAST = """[spacecraft]
inertia_kg_m2 = [[18.0, 0.5, 0.0], [0.5, 20.0, -0.3], [0.0, -0.3, 17.0]]
[slew]
angle_deg = 30.0
time_s = 10.0
[settling]
pointing_error_deg = 0.05
body_rate_deg_s = 100.0
"""
BIAS = "[disturbance]\nmomentum_Nms = [0.2, 0.1, -0.3]\ntorque_Nm = [0.005, 0.0, -0.01]\n"
LOST = "[failure]\nfailed_cmgs = 1\n"


def trial(text: str, layout: str, law: str, skew: float | None = None, coast: float = 0.4) -> Trial:
    r = sizing.load_requirement(text)
    return Trial(Fleet(r), Geometry(layout, skew, bool(r.failures)), law, coast)


def of_scenario(made: Trial, h0: float, rate: float, slew) -> float:
    """Return the settling time of a slew as its scenario has it; infinite for never."""
    files = scenario_files(made, h0, rate, slew)
    name = made.geometry.layout
    run = nm.simulate(checked(Source(files[f"{name}.toml"], files=files)))
    late = run.summary()["settling_time_s"]
    return np.inf if np.isnan(late) else late


SAME = [
    (LEAST, "box90", "sr", None, 0.88, 0.8),
    (LEAST + BIAS, "pyramid", "local-gradient", 0.5, 1.1, 0.9),
    (LEAST + LOST, "roof", "gsr", 0.7, 1.9, 0.6),
    (LEAST, "roof", "constraint", np.pi / 4, 0.85, 0.75),
    (LEAST + LOST, "roof6", "constraint", None, 0.8, 0.8),
]


@pytest.mark.sampled(3)
@pytest.mark.parametrize(("text", "layout", "law", "skew", "h0", "rate"), SAME)
def test_a_slew_settles_when_its_scenario_does(text, layout, law, skew, h0, rate):
    """The body turned in place of the axis, many runs in a kernel: the same motion."""
    made = trial(text, layout, law, skew)
    r, n = made.requirement, made.geometry.whole.n
    slews = cases(r, n, spread(60, r.axis, r.cone))
    late = made.settled(slews, np.array([h0]), np.array([rate]))[0]
    assert np.isfinite(late).any()
    for i in np.argsort(np.where(late < r.time, late, -1.0))[[-1, -7]]:  # late, but in time
        found = of_scenario(made, h0, rate, slews.picked(np.array([i])))
        assert found == pytest.approx(late[i], abs=1e-9)


def test_finer_steps_change_nothing():
    made = trial(LEAST.replace("100.0", "0.1"), "box90", "sr")
    slews = lattice(made.requirement, 4, 0.1, 30)
    coarse = made.settled(slews, np.array([0.84]), np.array([0.8]))
    fine = made.settled(slews, np.array([0.84]), np.array([0.8]), 4)
    assert coarse.max() > 9.5  # beyond the profile's end
    assert np.abs(fine - coarse).max() < 1.01 * made.requirement.period


def test_what_is_not_a_number_has_not_settled():
    made = trial(LEAST, "box90", "sr")
    slews = lattice(made.requirement, 4, 0.1, 100)
    with np.errstate(all="ignore"):
        late = made.settled(slews, np.array([np.inf, 1e-300]), np.array([1.0, 1.0]))
    assert np.isinf(late).all()


def test_designs_times_slews():
    made = trial(LEAST, "box90", "sr")
    slews = lattice(made.requirement, 4, 0.1, 50)
    h0, rate = np.array([0.6, 2.0, 0.9]), np.array([0.9, 0.9, 0.2])
    late = made.settled(slews, h0, rate)
    assert late.shape == (3, len(slews))
    one = made.settled(slews, h0[1:2], rate[1:2])
    assert np.array_equal(late[1:2], one)
    assert made.flies(slews, h0, rate).tolist() == [False, True, False]
    few = failing(made, Design(0.9, 0.2), slews)
    assert 0 < len(few) <= len(slews)
    assert made.settled(slews.picked(np.zeros(0, int)), h0, rate).shape == (3, 0)


def test_cases_are_axes_times_failures_times_momenta():
    text = LEAST + LOST + "[disturbance]\nmomentum_Nms = 0.5\n"
    r = sizing.load_requirement(text)
    assert multiplicity(r, 4) == 5 * 6
    axes = spread(3, r.axis, r.cone)
    found = cases(r, 4, axes)
    assert len(found) == 3 * 30
    assert np.linalg.norm(found.bias, axis=1) == pytest.approx(np.full(90, 0.5))
    assert set(found.failed.tolist()) == {NONE_FAILED, 0, 1, 2, 3}
    unit = axes[1] @ r.inertia / np.linalg.norm(axes[1] @ r.inertia)
    own = found.picked(np.flatnonzero((found.axis == axes[1]).all(axis=1)))
    assert (own.bias @ unit).max() == pytest.approx(0.5)
    assert len(np.unique(np.round(np.column_stack([own.failed, own.bias]), 9), axis=0)) == 30
    near = nearby(r, own, 4, np.random.default_rng(0))
    assert len(near) == 120 and np.array_equal(near.failed[::4], own.failed)


@pytest.mark.parametrize("layout", ["box90", "roof", "roof6", "pyramid", "orthogonal_pairs"])
def test_start_angles_hold_the_momentum(layout):
    array = layouts.create(layout)
    home = layouts.home(layout)
    wanted = 0.8 * spread(40, np.eye(3)[2], np.pi)
    delta, held = start.holding(array, home, wanted)
    assert held.all()
    assert array.momentum(delta) == pytest.approx(wanted, abs=1e-7)
    for i in range(array.n):
        left = array.without(i)
        rest = start.rest(left)
        assert rest is not None
        assert left.momentum(rest) == pytest.approx(np.zeros(3), abs=1e-7)
        assert torque_capability(left, rest) > 0.05


def test_starts_beyond_the_envelope_are_told():
    _, held = start.holding(layouts.box90(), layouts.home("box90"), np.array([[9.0, 0, 0]]))
    assert not held.any()
    made = trial(LEAST + "[disturbance]\nmomentum_Nms = [5.0, 0.0, 0.0]\n", "box90", "sr")
    slews = lattice(made.requirement, 4, 0.1, 100)
    assert np.isinf(made.settled(slews, np.array([0.5]), np.array([1.0]))).all()


def test_constraint_starts_hold_the_momentum_in_every_frame():
    for layout, skew in (("box90", None), ("roof", np.pi / 4), ("roof6", None)):
        geometry = Geometry(layout, skew, layout == "roof6", "constraint")
        wanted = 0.6 * spread(20, np.eye(3)[2], np.pi)
        for i, array in geometry.arrays.items():
            delta, held = geometry.held[i].starts(wanted)
            assert held.all()
            assert array.momentum(delta) == pytest.approx(wanted, abs=1e-9)
    assert not Geometry("roof", 0.7, False).held
    assert not Geometry("box90", None, True).held


def test_larger_arrays_at_higher_rates_and_for_heavier_bodies():
    """Momentum falls with the rate, and grows with the inertia as it should: in proportion."""
    made = trial(LEAST, "box90", "sr")
    slews = searched(made.requirement, made.geometry, 3)
    speeds = rates(made.requirement.gimbal_rates, 6)
    curve = Curve(made, slews, speeds, 0.01)
    assert (np.diff(curve.h0) <= 0.011 * curve.h0[:-1]).all()
    assert curve.worth == pytest.approx(curve.h0**2 * speeds)
    assert curve.best == pytest.approx(curve.knee.h0**2 * curve.knee.rate)
    heavy = LEAST.replace("[[18.0, 0.5, 0.0], [0.5, 20.0, -0.3], [0.0, -0.3, 17.0]]", "@")
    scaled = (3.0 * made.requirement.inertia).tolist()
    other = trial(heavy.replace("@", str(scaled)), "box90", "sr")
    assert Curve(other, slews, speeds, 0.01).h0 == pytest.approx(3.0 * curve.h0, rel=0.011)
    wide = trial(LEAST.replace("angle_deg = 30.0", "angle_deg = 36.0"), "box90", "sr")
    assert (Curve(wide, slews, speeds, 0.01).h0 > 1.05 * curve.h0).all()
    before = curve.h0.copy()
    curve.harden(lattice(made.requirement, 4, 0.2, 10))
    assert (curve.h0 >= before).all()
