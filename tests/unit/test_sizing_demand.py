"""What slews ask of an array: the profile, momentum and torque, bounds, axes."""

from __future__ import annotations

import numpy as np
import pytest

import nullmotion as nm
from nullmotion import rotation, sizing
from nullmotion.scenario.scenario import checked
from nullmotion.scenario.source import Source
from nullmotion.sizing import axes, boundary, certified
from nullmotion.sizing.cases import cases
from nullmotion.sizing.demand import demand
from nullmotion.sizing.files import scenario_files
from nullmotion.sizing.geometry import Geometry
from nullmotion.sizing.profile import RateProfile
from nullmotion.sizing.trial import Fleet, Trial

J = np.array([[18.0, 0.5, 0.0], [0.5, 20.0, -0.3], [0.0, -0.3, 17.0]])
NONE = np.zeros(3)


@pytest.mark.parametrize("coast", [0.0, 0.3, 0.8])
@pytest.mark.parametrize("smoothing", [0.0, 0.5, 1.0])
def test_profile_is_its_own_integral(coast, smoothing):
    profile = RateProfile(0.5, 8.0, coast, smoothing)
    t = np.linspace(-1.0, 9.0, 100_001)
    angle, rate, acceleration = profile.at(t)
    step = t[1] - t[0]
    assert np.abs(np.cumsum(rate) * step - angle).max() < 1e-4
    assert np.abs(np.cumsum(acceleration) * step - rate).max() < 1e-4
    assert (angle[0], rate[0], rate[-1]) == pytest.approx((0, 0, 0), abs=1e-12)
    assert angle[-1] == pytest.approx(0.5, rel=1e-12)
    assert rate.max() == pytest.approx(profile.peak_rate, rel=1e-9)
    assert acceleration.max() == pytest.approx(profile.peak_acceleration, rel=1e-3)
    coasting = np.mean((rate > 0.9999 * rate.max()) & (t > 0) & (t < 8)) * 10 / 8
    assert coasting == pytest.approx(coast, abs=0.02)


def test_peaks_by_hand():
    """A trapezoid of thirds: 1.5 angle / T and 4.5 angle / T^2, a triangle: 2 and 4."""
    third, triangle = RateProfile(1.0, 2.0, 1 / 3, 0.0), RateProfile(1.0, 2.0, 0.0, 0.0)
    assert (third.peak_rate, third.peak_acceleration) == pytest.approx((1.5 / 2, 4.5 / 4))
    assert (triangle.peak_rate, triangle.peak_acceleration) == pytest.approx((2.0 / 2, 4.0 / 4))


def test_the_reference_is_a_rotation_about_the_axis():
    axis = np.array([0.6, 0.0, 0.8])
    rows = RateProfile(0.5, 8.0).reference([0.0, 4.0, 8.0], axis)
    assert rows[0] == pytest.approx([1.0, *[0.0] * 9])
    assert rows[2, :4] == pytest.approx([np.cos(0.25), *(np.sin(0.25) * axis)])
    assert rows[1, 4:7] == pytest.approx(RateProfile(0.5, 8.0).peak_rate * axis)
    assert rows[2, 4:] == pytest.approx(np.zeros(6), abs=1e-15)


def test_without_bias_the_array_takes_the_body_s_momentum():
    profile, e = RateProfile(0.5, 8.0), axes.spread(20, np.eye(3)[2], np.pi)
    found = demand(profile, J, e, np.zeros((20, 3)), NONE)
    _, rate, acceleration = profile.at(found.t)
    assert np.abs(found.momentum + rate[None, :, None] * (e @ J)[:, None]).max() < 1e-12
    assert np.abs(found.torque + acceleration[None, :, None] * (e @ J)[:, None]).max() < 1e-12


def test_torque_is_the_rate_of_momentum_and_angular_momentum_is_kept():
    profile, e = RateProfile(0.5, 8.0, 0.3, 1.0), axes.spread(5, np.eye(3)[2], np.pi)
    bias, torque = np.tile([0.3, -0.2, 0.5], (5, 1)), np.array([0.01, 0.02, -0.03])
    found = demand(profile, J, e, bias, torque)
    slope = np.gradient(found.momentum, found.t, axis=1, edge_order=2)
    assert np.abs(slope - found.torque).max() < 1e-2 * found.torques.max()  # kinks
    angle, rate, _ = profile.at(found.t)
    for i in range(5):
        half = np.multiply.outer(0.5 * angle, np.ones(3))
        q = np.concatenate([np.cos(half[:, :1]), np.sin(half) * e[i]], axis=1)
        C = np.array([rotation.matrix(one) for one in q])
        H = np.einsum("kji,kj->ki", C, found.momentum[i] + np.outer(rate, J @ e[i]))  # in N
        pushed = np.einsum("kji,j->ki", C, torque)
        given = 0.5 * (pushed[1:] + pushed[:-1]) * (found.t[1] - found.t[0])
        kept = bias[i] + np.concatenate([np.zeros((1, 3)), np.cumsum(given, axis=0)])
        assert np.abs(H - kept).max() < 1e-9


def test_the_flown_array_holds_what_was_demanded():
    """With more than enough array the closed loop follows the profile, demand included."""
    r = sizing.load_requirement(
        "[spacecraft]\ninertia_kg_m2 = [18.0, 20.0, 17.0]\n[slew]\nangle_deg = 30.0\n"
        "time_s = 10.0\n[disturbance]\nmomentum_Nms = [0.2, 0.1, -0.3]\n"
    )
    trial = Trial(Fleet(r), Geometry("box90", None, False), "sr", 0.4)
    slew = cases(r, 4, np.array([[0.6, 0.0, 0.8]]))
    files = scenario_files(trial, 20.0, 2.0, slew)
    run = nm.simulate(checked(Source(files["box90.toml"], files=files)))
    asked = demand(trial.profile, r.inertia, slew.axis, slew.bias, NONE)
    for part in range(3):
        h = np.interp(asked.t, run.t, run.momentum[:, part])
        assert np.abs(h - asked.momentum[0, :, part]).max() < 0.01


def test_bounds_hold_for_every_axis():
    for cone in (180.0, 70.0, 25.0, 0.0):
        text = (
            f"[spacecraft]\ninertia_kg_m2 = {J.tolist()}\n[slew]\nangle_deg = 30.0\ntime_s = 10.0\n"
            f"axis = [1.0, 2.0, 2.0]\ncone_half_angle_deg = {cone}\n"
            "[disturbance]\nmomentum_Nms = 0.4\ntorque_Nm = [0.01, 0.0, 0.02]\n"
        )
        r = sizing.load_requirement(text)
        profile = RateProfile(r.angle, r.profile_time)
        e = axes.spread(500, r.axis, r.cone)
        largest = certified.largest_inertia(r.inertia, r.axis, r.cone)
        reached = np.linalg.norm(e @ J, axis=1).max()
        assert reached <= largest * (1 + 1e-12) and largest < 1.02 * reached
        bound = certified.demand_bound(r, profile)
        away = np.random.default_rng(0).normal(size=(len(e), 3))
        away *= 0.4 / np.linalg.norm(away, axis=1, keepdims=True)
        asked = demand(profile, r.inertia, e, away, r.torque)
        for most, values in ((bound.momentum, asked.momenta), (bound.torque, asked.torques)):
            fine = np.interp(asked.t, np.linspace(0, profile.time, len(most)), most)
            assert (values <= fine * (1 + 1e-6) + 1e-9).all()


def test_axes_are_even_and_lie_in_the_cone():
    middle = np.array([2.0, -1.0, 2.0]) / 3
    e = axes.spread(400, middle, np.radians(30))
    angle = np.degrees(np.arccos(e @ middle))
    assert np.linalg.norm(e, axis=1) == pytest.approx(np.ones(400))
    assert angle.max() < 30.0 and angle.max() > 29.0
    assert np.mean(angle < 15) == pytest.approx(
        (1 - np.cos(0.2618)) / (1 - np.cos(0.5236)), abs=0.01
    )
    whole = axes.spread(400, middle, np.pi)
    assert np.abs(whole.mean(axis=0)).max() < 0.01
    other = axes.spread(400, middle, np.pi, 0.3)
    assert (whole @ other.T).max() < 1 - 1e-6
    assert np.array_equal(axes.spread(400, middle, 0.0), middle[None])
    close = axes.near(e[:10], 5, 0.05, np.random.default_rng(0))
    assert (np.sum(close * np.repeat(e[:10], 5, axis=0), axis=1) >= np.cos(0.05) - 1e-12).all()


def test_weak_axes_hold_the_gimbal_axes_turned_by_the_inertia():
    array = nm.layouts.pyramid()
    found = axes.weak(array, J)
    assert np.linalg.norm(found, axis=1) == pytest.approx(np.ones(len(found)))
    for g in array.gimbal_axes:
        momentum = found @ J
        momentum /= np.linalg.norm(momentum, axis=1, keepdims=True)
        assert (momentum @ g).max() == pytest.approx(1.0)
        assert (momentum @ g).min() == pytest.approx(-1.0)
    assert len(np.unique(np.round(found, 6), axis=0)) == len(found)


def test_frames_turn_axes_to_x():
    e = axes.spread(50, np.eye(3)[0], np.pi)
    C = axes.frames(e)
    assert np.einsum("kij,kj->ki", C, e) == pytest.approx(np.tile([1.0, 0, 0], (50, 1)))
    assert np.linalg.det(C) == pytest.approx(np.ones(50))


def test_boundaries_are_found_from_above_and_below():
    edges = np.array([1.0, 3.0, 0.2])

    def holds(values, lanes):
        return values >= edges[lanes]

    for start in (1.0, 5.0):
        found = boundary.least(holds, np.full(3, start), 1.25, 1e-3)
        assert (found >= edges).all() and (found <= edges * 1.0011).all()
    never = boundary.least(lambda v, _: np.zeros(len(v), bool), np.ones(2), 1.25, 1e-3)
    assert np.isinf(never).all()
    assert boundary.least(holds, np.full(3, 5.0), 1.25, 1e-3, 2.0) == pytest.approx(
        [2, 3, 2], rel=2e-3
    )


def test_what_holds_below_a_gap_is_not_found():
    found = boundary.least(
        lambda v, _: (v >= 2.0) | ((v > 0.5) & (v < 1.0)), np.array([3.0]), 1.2, 1e-3
    )
    assert found[0] == pytest.approx(2.0, rel=2e-3)


def test_ctrl_c_in_a_proof_is_passed_on():
    class Slow:
        def certificate(self, radius, torque_capability):
            return type("Broken", (), {"reason": certified.INTERRUPTED})()

    with pytest.raises(KeyboardInterrupt):
        certified.proofs(Slow(), [certified.Claim(0.5, 0.5)])


def test_claims_cover_the_demand_in_balls():
    t = np.linspace(0.0, 1.0, 101)
    bound = certified.Bound(2.0 * t, 3.0 * (1.0 - t) + 0.1)
    found = certified.claims(bound, h0=4.0, rate=2.0)
    radii = [claim.radius for claim in found]
    assert radii == sorted(radii) and radii[-1] == pytest.approx(2.0 / 4.0)
    for h, torque in zip(*bound, strict=True):
        own = next(claim for claim in found if h / 4.0 <= claim.radius * (1 + 1e-12))
        assert torque <= 4.0 * 2.0 * own.capability * (1 + 1e-9)
