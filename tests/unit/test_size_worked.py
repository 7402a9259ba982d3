"""The worked cases of sizing, flown again through `nm.simulate_batch`'s own kernels."""

from __future__ import annotations

import numpy as np
import pytest

import nullmotion as nm
from nullmotion import sizing


@pytest.mark.slow
@pytest.mark.parametrize("case", ["agile-100kg", "imager-1500kg"])
def test_designs_fly_and_smaller_ones_do_not(case: str) -> None:
    """Every layout: flown, and not with 5 % less momentum, gimbal rate or both."""
    found = sizing.size(case)
    assert found.complete and {row.layout for row in found.rows} == set(found.requirement.layouts)
    for row in found.rows:
        assert row.status == "sized" and row.flown, row.layout
        assert row.smaller_by_5_percent == {"h0": False, "gimbal_rate": False, "both": False}
    certified = {row.layout for row in found.rows if row.certified is not None}
    assert {"box90", "roof6"} <= certified


def test_bad_requirements_name_key_value_and_allowed() -> None:
    """With file and line."""
    good = (
        "[spacecraft]\ninertia_kg_m2 = [1.0, 1.0, 1.0]\n[slew]\nangle_deg = 30.0\ntime_s = 10.0\n"
    )
    sizing.load_requirement(good)
    for text, words in (
        (good.replace("30.0", "-3"), ("angle_deg", "-3")),
        (good.replace("time_s", "time_m"), ("time_m",)),
        (good + "[failure]\nfailed_cmgs = 3\n", ("failed_cmgs", "3")),
        (good + '[array]\nlayouts = ["piramid"]\n', ("piramid", "pyramid")),
        (good.replace("[1.0, 1.0, 1.0]", "[1.0, 1.0, 5.0]"), ("inertia",)),
        (good + '[law]\nbox90 = "vcbsea"\n', ("vcbsea", "vcbsae")),
    ):
        with pytest.raises(nm.NullmotionError) as error:
            sizing.load_requirement(text)
        assert all(word in str(error.value) for word in words), str(error.value)


def test_profile_and_demand_against_hand_formulas() -> None:
    """A trapezoid of rate: peak rate angle/(T (1 - r)), and its angle and rest at the end."""
    from nullmotion.sizing.profile import RateProfile

    profile = RateProfile(np.radians(30.0), 10.0, coast=0.4, smoothing=0.0)
    times = np.linspace(0, 10, 20001)
    angle, rate, acceleration = profile.at(times)
    assert angle[-1] == pytest.approx(np.radians(30.0), rel=1e-12) and abs(rate[-1]) < 1e-12
    assert rate.max() == pytest.approx(np.radians(30.0) / (10.0 * 0.7), rel=1e-9)
    assert np.trapezoid(rate, times) == pytest.approx(np.radians(30.0), rel=1e-6)
    assert np.abs(acceleration).max() == pytest.approx(rate.max() / 3.0, rel=1e-6)
