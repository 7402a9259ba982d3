"""Preferred gimbal angles: the same momentum, never worse, on every piece of the self-motion."""

from __future__ import annotations

import numpy as np
import pytest

import nullmotion as nm
from nullmotion import laws, plan
from nullmotion.errors import InputError
from nullmotion.plan import preferred, self_motion
from nullmotion.sim import Setup

LAW = laws.create("sr", lambda0=0.5, mu=0.2, schedule="exponential")


def manoeuvre(array, start, hdot, **more):
    return Setup(array, LAW, start, np.asarray(hdot, float), dt=0.05, steps=40, **more)


@pytest.mark.parametrize("cost", ["papakonstantinou", "min-manipulability", "energy", "peak-rate"])
@pytest.mark.sampled(1)
def test_the_start_has_the_same_momentum_and_is_no_worse(cost):
    array = nm.layouts.pyramid(rate_limit=1.0)
    setup = manoeuvre(array, np.radians([-70.0, 0.0, 75.0, 0.0]), [0.6, 0.0, 0.0])
    found = plan.search(setup, "preferred", cost=cost, depth=3)
    wanted = array.momentum(setup.delta)
    np.testing.assert_allclose(array.momentum(found.delta), wanted, atol=1e-11)
    assert found.value >= found.baseline_value
    assert found.value >= found.certificate["reachable_value"] >= found.baseline_value
    rollouts = plan.prepared(setup, cost, 3)
    again = rollouts.values(np.zeros(3), found.delta[None])[0]
    assert again == pytest.approx(found.value, rel=1e-9)  # turned back by whole turns
    assert not found.proven and found.knots == (0.0,) * 3
    assert found.to_dict()["gimbal_deg"] == np.degrees(found.delta).tolist()


def test_no_start_of_a_fresh_draw_is_better():
    array = nm.layouts.pyramid(rate_limit=1.0)
    setup = manoeuvre(array, np.radians([-70.0, 0.0, 75.0, 0.0]), [0.6, 0.0, 0.0])
    rollouts = plan.prepared(setup, "min-manipulability", 3)
    found = preferred.search(rollouts)
    rng = np.random.default_rng(99)
    others = self_motion.drawn(array, array.momentum(setup.delta), 3000, rng)
    assert len(others) > 1000
    assert found.value >= rollouts.values(np.zeros(3), others).max() - 1e-3
    assert found.value > 10 * rollouts.values(np.zeros(3))[0]


def test_a_start_that_cannot_be_improved_is_kept():
    array = nm.layouts.pyramid()
    setup = manoeuvre(array, np.zeros(4), np.zeros(3))
    found = plan.search(setup, "preferred", cost="energy", depth=3)
    np.testing.assert_array_equal(found.delta, setup.delta)
    assert found.certificate["reachable"] and not found.remarks


def test_end_stops_are_kept():
    limit = np.radians(80.0)
    array = nm.layouts.pyramid(rate_limit=1.0, angle_limits=np.array([-limit, limit]))
    setup = manoeuvre(array, np.radians([-70.0, 0.0, 75.0, 0.0]), [0.6, 0.0, 0.0])
    found = plan.search(setup, "preferred", cost="min-manipulability", depth=3)
    assert (np.abs(found.delta) <= limit).all()


def test_surfaces_of_self_motion_are_walked(rng):
    array = nm.layouts.roof6()
    start = rng.uniform(-2, 2, 6)
    momentum = array.momentum(start)
    walked = self_motion.walked(array, start, momentum, 20, rng)
    assert len(walked) > 1000
    np.testing.assert_allclose(array.momentum(walked) - momentum, 0, atol=1e-11)
    first = np.abs(walked[: len(walked) // 20] - start).max()
    assert first < 2 * self_motion.STRIDE  # strides, not leaps


def test_no_strides_are_refused():
    array = nm.layouts.pyramid()
    setup = manoeuvre(array, np.zeros(4), np.zeros(3))
    with pytest.raises(InputError, match="starts"):
        plan.search(setup, "preferred", starts=0)
