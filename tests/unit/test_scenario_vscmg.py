"""Scenario files of variable-speed CMGs: what they become, what is refused, what is stored."""

from __future__ import annotations

import json
import re
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import nullmotion as nm
from nullmotion.errors import InputError, UnsupportedArrayError
from nullmotion.plot.events import told
from nullmotion.scenario import ScenarioError, load_scenario, momentum_budget, rerun, store
from nullmotion.scenario.build import setup
from nullmotion.sim import wheel_summary

TEXT = """\
[array]
layout = "pyramid"
wheel_inertia_kg_m2 = 1e-3
wheel_speed_rad_s = 200.0
wheel_torque_limit_Nm = 0.01
rate_limit_deg_s = 90.0
[vscmg]
spin_inertia_kg_m2 = 2e-3
transverse_inertia_kg_m2 = 1.5e-3
gimbal_inertia_kg_m2 = 1.5e-3
drive = "torque"
[spacecraft]
inertia_kg_m2 = [0.5, 0.6, 0.7]
q_BN = [0.9, 0.1, 0.4, 0.1]
[controller]
name = "adaptive"
[law]
name = "vscmg-weighted"
[mission]
kind = "startup"
[simulation]
duration_s = 0.5
"""
RATE = """\
[array]
layout = "pyramid"
wheel_inertia_kg_m2 = 1e-3
wheel_speed_rad_s = 200.0
[law]
name = "vscmg-weighted"
[mission]
hdot_Nm = [0.01, 0.0, 0.0]
[simulation]
duration_s = 0.2
"""
INERTIA, SPEED = "wheel_inertia_kg_m2 = 1e-3\n", "wheel_speed_rad_s = 200.0\n"
LAW, KIND = 'name = "vscmg-weighted"', 'kind = "startup"'
END = "duration_s = 0.5"
EVENT = '[[event]]\nkind = "{}"\ncmg = 1\nat_s = 0.1\n'


def changed(*pairs: tuple[str, str], text: str = TEXT) -> str:
    """Return the text with parts replaced."""
    for old, new in pairs:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    return text


def refused(text: str, values: dict[str, Any] | None = None) -> list[Any]:
    """Return the problems of a text that is refused."""
    with pytest.raises(ScenarioError) as caught:
        load_scenario(text, values)
    return list(caught.value.problems)


def test_a_startup_is_built_in_si():
    text = changed(
        ("[vscmg]\n", "[vscmg]\ngimbal_torque_limit_Nm = [0.1, 0.2, 0.3, 0.4]\n"),
        ("rate_limit", "wheel_speed_limit_rpm = 3000\nwheel_power_limit_W = 2.0\nrate_limit"),
        ('"torque"', '"torque"\ngimbal_bandwidth_rad_s = 30\nwheel_friction_Nm = 1e-5'),
    )
    made = setup(load_scenario(text))
    wheels, units = made.array.wheels, made.units
    assert np.allclose(made.array.h0, 0.2)
    assert np.allclose(wheels.inertia, 1e-3) and np.allclose(wheels.torque_limit, 0.01)
    assert np.allclose(wheels.speed_limit, 100 * np.pi) and np.allclose(wheels.power_limit, 2.0)
    assert np.allclose(units.gimbal_torque_limit, [0.1, 0.2, 0.3, 0.4])
    assert units.drive == "torque" and units.terms == "all" and units.inertia_includes_units
    assert np.allclose(units.gimbal_bandwidth, 30) and np.allclose(units.wheel_friction, 1e-5)
    assert np.allclose(units.spin_inertia, 2e-3) and np.allclose(units.gimbal_inertia, 1.5e-3)
    assert np.array_equal(made.wheel_speed, np.zeros(4))
    start = np.array([0.9, 0.1, 0.4, 0.1])
    assert np.allclose(made.target, start / np.linalg.norm(start))  # the attitude is held
    tolerances = {m.name: m.tolerance for m in made.metrics if hasattr(m, "tolerance")}
    assert tolerances["wheel_settling_s"] == 0.02 and tolerances["momentum_settling_s"] == 0.02


@pytest.mark.parametrize(
    "lines",
    [
        "wheel_inertia_kg_m2 = 1e-3\nwheel_speed_rpm = 1909.8593171027440\n",
        "wheel_inertia_kg_m2 = 1e-3\nh0_Nms = 0.2\n",
        "wheel_inertia_kg_m2 = [1e-3, 1e-3, 1e-3, 1e-3]\nh0_Nms = [0.2, 0.2, 0.2, 0.2]\n",
    ],
)
def test_the_design_speed_has_several_forms(lines):
    made = setup(load_scenario(changed((INERTIA + SPEED, lines))))
    assert np.allclose(made.array.h0, 0.2)
    assert np.allclose(made.array.design_speed, 200.0)


def test_wheels_of_constant_speed_stay_what_they_were():
    text = changed((LAW, 'name = "sr"'), text=RATE)
    made = setup(load_scenario(text))
    assert made.wheel_speed is None and not made.variable_speed
    assert nm.simulate(load_scenario(text)).wheel_speed is None


def test_wheel_speeds_at_the_start():
    assert np.allclose(setup(load_scenario(RATE)).wheel_speed, 200.0)  # those of the design
    values = {"initial.wheel_speed_rad_s": -30.0}
    assert np.allclose(setup(load_scenario(RATE, values)).wheel_speed, -30.0)
    values = {"array.failed_cmgs": [1], "initial.wheel_speed_rad_s": [1.0, 2.0, 3.0, 4.0]}
    made = setup(load_scenario(RATE, values))
    assert made.wheel_speed.tolist() == [1.0, 3.0, 4.0] and made.array.wheels.inertia.size == 3


def test_the_real_wheels_are_off_as_their_momenta_are():
    made = setup(load_scenario(TEXT, {"plant.h0_error": 0.2, "plant.seed": 3}))
    known, real = made.array, made.true_array
    share = real.h0 / known.h0
    assert np.ptp(share) > 0.01 and np.all(np.abs(share - 1) <= 0.2)
    assert np.allclose(real.wheels.inertia / known.wheels.inertia, share)
    assert np.allclose(real.design_speed, 200.0)
    assert np.array_equal(real.wheels.torque_limit, known.wheels.torque_limit)


BAD = [  # replacements, line, key, what the message must say
    ([(INERTIA, ""), (SPEED, "h0_Nms = 0.2\n")], 4, "array.wheel_torque_limit_Nm",
     "only together with wheel_inertia_kg_m2"),
    ([(SPEED, "")], 3, "array.wheel_inertia_kg_m2", "only together with wheel_speed_rpm"),
    ([(SPEED, SPEED + "wheel_speed_rpm = 100\n")], 5, "array.wheel_speed_rpm", "give one of"),
    ([(SPEED, SPEED + "h0_Nms = 1.0\n")], 5, "array.h0_Nms", "either h0_Nms or"),
    ([(SPEED, "wheel_speed_rad_s = 0\n")], 4, "array.wheel_speed_rad_s", "with momentum"),
    ([(INERTIA, "wheel_inertia_kg_m2 = [1e-3, 1e-3]\n")], 3, "array.wheel_inertia_kg_m2", "4"),
    ([("0.01\n", "[0.01, 0.01]\n")], 5, "array.wheel_torque_limit_Nm", "4"),
    ([("0.01\n", "-0.01\n")], 5, "array.wheel_torque_limit_Nm", "at least 0"),
    ([("0.01\n", "0.01\nwheel_speed_limit_rpm = 1000\n")], 6, "array.wheel_speed_limit_rpm",
     "1909.86 rpm"),
    ([("0.01\n", "0.01\nangle_limits_deg = [-90, 90]\n")], 6, "array.angle_limits_deg",
     'vscmg.drive = "rate"'),
    ([("spin_inertia_kg_m2 = 2e-3", "spin_inertia_kg_m2 = -1")], 8, "vscmg.spin_inertia_kg_m2",
     "at least 0"),
    ([("spin_inertia_kg_m2 = 2e-3", "spin_inertia_kg_m2 = 5e-4")], 8, "vscmg.spin_inertia_kg_m2",
     "the wheel's own"),
    ([("spin_inertia_kg_m2 = 2e-3", "spin_inertia_kg_m2 = [1, 2]")], 8,
     "vscmg.spin_inertia_kg_m2", "one number or 4"),
    ([("spin_inertia_kg_m2 = 2e-3", "spin_inertia_g_m2 = 2")], 8, "vscmg.spin_inertia_g_m2",
     "spin_inertia_kg_m2"),
    ([("gimbal_inertia_kg_m2 = 1.5e-3", "gimbal_inertia_kg_m2 = 0.0")], 10,
     "vscmg.gimbal_inertia_kg_m2", "above 0"),
    ([("transverse_inertia_kg_m2 = 1.5e-3\n", "")], 7, "vscmg.transverse_inertia_kg_m2",
     "missing"),
    ([('"torque"', '"belt"')], 11, "vscmg.drive", "'rate' or 'torque'"),
    ([('"torque"', '"torque"\nterms = "published"')], 12, "vscmg.terms", "'all'"),
    ([('"torque"', '"torque"\ngimbal_bandwith_rad_s = 1')], 12, "vscmg.gimbal_bandwith_rad_s",
     "gimbal_bandwidth_rad_s"),
    ([("[0.5, 0.6, 0.7]", "[0.001, 0.001, 0.001]")], 13, "spacecraft.inertia_kg_m2",
     "units' own inertia"),
    ([("[controller]", "[servo]\n[controller]")], 15, "servo", "[vscmg]"),
    ([("[controller]", "[reaction_wheel]\n[controller]")], 15, "reaction_wheel", "only beside"),
    ([(LAW, 'name = "sr"')], 18, "law.name", "vscmg-weighted"),
    ([(LAW, LAW + "\nwheel_speed_rad_s = 150.0")], 19, "law.wheel_speed_rad_s", "200 rad/s"),
    ([(KIND, KIND + "\nslew_time_s = 5.0")], 21, "mission.slew_time_s", "target_q_BN"),
    ([(KIND, KIND + "\nwheel_tolerance = 0")], 21, "mission.wheel_tolerance", "above 0"),
    ([(KIND, KIND + "\nhdot_Nm = [1, 0, 0]")], 21, "mission.hdot_Nm", '"momentum-rate"'),
    ([(END, END + '\nintegrator = "euler"')], 23, "simulation.integrator", "'rk4'"),
    ([(END, END + "\n[initial]\nwheel_speed_rad_s = [0, 0]")], 24, "initial.wheel_speed_rad_s",
     "one number or 4"),
    ([("0.01\n", "0.01\nwheel_speed_limit_rpm = 2000\n"),
      (END, END + "\n[initial]\nwheel_speed_rad_s = 300")], 25, "initial.wheel_speed_rad_s",
     "within array.wheel_speed_limit_rpm"),
    ([(END, END + "\n" + EVENT.format("spin-down"))], 24, "event[0].kind", "'wheel-dead'"),
    ([(END, END + "\n" + EVENT.format("stuck"))], 24, "event[0].kind", 'vscmg.drive = "rate"'),
]  # fmt: skip


@pytest.mark.parametrize(("pairs", "line", "key", "says"), BAD)
def test_what_cannot_be_is_told_with_key_value_allowed_file_and_line(
    pairs, line, key, says, tmp_path
):
    file = tmp_path / "s.toml"
    file.write_text(changed(*pairs), encoding="utf-8")
    problems = refused(file)
    found = [p for p in problems if p.key.startswith(key)]
    assert len(found) == 1, "\n".join(map(str, problems))
    assert found[0].where == f"{file}:{line}" and says in found[0].allowed


def test_a_startup_needs_wheels():
    text = changed((INERTIA, ""), (SPEED, "h0_Nms = 0.2\n"), ("wheel_torque_limit_Nm = 0.01\n", ""))
    found = {p.key: p.allowed for p in refused(text)}
    assert "array.wheel_inertia_kg_m2" in found["mission.kind"]
    assert "array.wheel_inertia_kg_m2" in found["vscmg"]


def test_a_startup_needs_a_spacecraft():
    text = changed(("hdot_Nm = [0.01, 0.0, 0.0]", 'kind = "startup"'), text=RATE)
    assert {p.key for p in refused(text)} == {"spacecraft", "controller"}
    assert next(p.key for p in refused(RATE + "[vscmg]\n")) == "vscmg"


def test_what_is_only_for_changing_wheel_speeds():
    still = changed((LAW, 'name = "sr"'), text=RATE)
    for extra, key in (
        ("[initial]\nwheel_speed_rad_s = 1.0\n", "initial.wheel_speed_rad_s"),
        (EVENT.format("wheel-dead"), "event[0].kind"),
        ("[requirements]\nwheel_settling_s_below = 1\n", "requirements.wheel_settling_s_below"),
        ("[simulation.stop]\nwheel_speed_error_below = 1\n",
         "simulation.stop.wheel_speed_error_below"),
    ):  # fmt: skip
        assert [p.key for p in refused(still + extra)] == [key]
        load_scenario(RATE + extra)


def test_a_law_that_does_not_turn_wheels_leaves_them_at_their_speed():
    text = changed((LAW, 'name = "sr"'), (KIND, 'kind = "attitude"\ntarget_q_BN = [1, 0, 0, 0]'))
    run = nm.simulate(load_scenario(text), "python")
    assert np.allclose(run.wheel_speed[0], 200.0)
    # their motors are not asked for anything: speeds change as body and gimbals turn under them
    assert np.abs(run.wheel_speed - 200.0).max() < 0.5
    assert np.nanmax(np.abs(run.rates)) > 0.01


def test_without_wheels_the_law_says_what_it_needs():
    text = changed((INERTIA + SPEED, ""), text=RATE)
    with pytest.raises(UnsupportedArrayError, match="variable-speed wheels"):
        setup(load_scenario(text))


def test_metrics_of_wheels_need_wheels():
    with pytest.raises(InputError, match="wheel_speed_error.*no variable wheel speeds"):
        setup(load_scenario(changed((LAW, 'name = "sr"'), text=RATE)), ("wheel_speed_error",))


# ---- the momentum budget


def test_the_budget_is_that_of_the_run():
    values = {
        "spacecraft.omega_BN_B": [0.02, -0.03, 0.01],
        "initial.wheel_speed_rad_s": [10.0, -20.0, 30.0, 5.0],
        "disturbance.constant_Nm": [1e-3, 2e-3, 0.0],
        "mission.target_q_BN": [0.6, 0.0, 0.8, 0.0],
    }
    scenario = load_scenario(TEXT, values)
    run = nm.simulate(scenario, "python")
    found = momentum_budget.budget(scenario, setup(scenario).array)
    assert np.allclose(found.start, run.inertial_momentum[0], rtol=1e-12)
    C = Rotation.from_quat([0.0, 0.8, 0.0, 0.6]).as_matrix()  # from B to N
    outside = C @ np.array([1e-3, 2e-3, 0.0]) * 0.5
    assert np.allclose(found.outside, outside)
    assert found.needed == pytest.approx(np.linalg.norm(found.start + outside))
    told = store.summary(run, scenario)["momentum_budget"]
    assert told["needed_Nms"] == pytest.approx(found.needed)
    assert told["share"] == pytest.approx(found.needed / found.available)


@pytest.mark.parametrize("layout", ["pyramid", "roof", "box90", "roof6"])
def test_what_an_array_holds_is_never_more_than_its_bound(layout, rng):
    array = nm.layouts.create(layout, h0=0.7)
    for direction in rng.normal(size=(20, 3)):
        unit = direction / np.linalg.norm(direction)
        # each rotor turned as far along as it goes: reached, the other components aside
        best = np.arctan2(array.transverse_axes @ unit, array.spin_axes @ unit)
        delta = np.vstack([best, best + rng.normal(size=(200, array.n))])
        along = array.momentum(delta) @ array.torque_axes @ unit
        bound = momentum_budget.held_at_most(array, direction)
        assert along.max() <= bound * (1 + 1e-12)
        assert along[0] == pytest.approx(bound, rel=1e-9)


def test_a_startup_that_the_array_cannot_hold_is_refused_with_both_numbers():
    problem = refused(TEXT, {"spacecraft.omega_BN_B": [1.4, 0.0, 0.0]})[0]
    assert problem.key == "spacecraft.omega_BN_B"
    needed = float(re.search(r"momentum: ([\d.]+) N m s", problem.allowed)[1])
    held = float(re.search(r"at most ([\d.]+) N m s", problem.allowed)[1])
    assert needed == pytest.approx(0.7, rel=1e-3)  # J_x omega_x, all on board
    array = setup(load_scenario(TEXT)).array
    along = np.sqrt(1 - (array.gimbal_axes @ [1.0, 0.0, 0.0]) ** 2)
    assert held == pytest.approx(1.02 * 0.2 * along.sum(), rel=1e-3)
    load_scenario(TEXT, {"spacecraft.omega_BN_B": [0.99 * held / 0.5, 0.0, 0.0]})


def test_a_torque_that_adds_up_to_too_much_is_refused():
    values = {"disturbance.constant_Nm": [0.0, 0.0, 2.0]}  # 1 N m s in half a second
    assert refused(TEXT, values)[0].key == "disturbance.constant_Nm"
    # nothing is refused where it may still work out
    load_scenario(TEXT, values | {"desaturation.torque_limit_Nm": 2.0})
    load_scenario(TEXT, values | {"disturbance.altitude_km": 400.0})
    load_scenario(TEXT, values | {"mission.kind": "attitude", "mission.target_q_BN": [1, 0, 0, 0]})
    turned = {"mission.target_q_BN": [1, 0, 0, 0], "disturbance.constant_Nm": [0.0, 0.0, 1.5]}
    load_scenario(TEXT, turned)  # its direction in N changes on the way


# ---- runs


def test_a_startup_says_whether_it_is_complete():
    early = load_scenario(TEXT)
    assert "startup-incomplete" in nm.simulate(early, "python").status
    at_speed = {"initial.wheel_speed_rad_s": 199.0}
    assert "startup-incomplete" not in nm.simulate(load_scenario(TEXT, at_speed), "python").status
    off = at_speed | {"mission.target_q_BN": [1.0, 0.0, 0.0, 0.0]}  # no time to turn
    assert "startup-incomplete" in nm.simulate(load_scenario(TEXT, off), "python").status
    as_attitude = {"mission.kind": "attitude", "mission.target_q_BN": [1.0, 0.0, 0.0, 0.0]}
    flown = nm.simulate(load_scenario(TEXT, as_attitude), "python")
    assert "startup-incomplete" not in flown.status


@pytest.fixture(scope="module")
def limited():
    """A startup that meets its limits of torque, power and gimbal rate."""
    values = {
        "simulation.duration_s": 3.0,
        "array.wheel_torque_limit_Nm": 2e-3,
        "array.wheel_power_limit_W": 0.01,
        "array.rate_limit_deg_s": 4.0,
        "law.k_m": 60.0,
        "mission.target_q_BN": [1.0, 0.0, 0.0, 0.0],
        "vscmg.drive": "rate",
    }
    scenario = load_scenario(TEXT, values)
    return scenario, nm.simulate(scenario)


def test_what_was_limited_and_when_is_that_of_the_history(limited):
    _, run = limited
    found = wheel_summary.limits(run)
    used = 1e-3 * np.abs(run.wheel_acceleration[:-1])
    assert used.max() <= 2e-3 * (1 + 1e-9)
    full = (used > 0.9995 * 2e-3).any(axis=1)
    assert found["wheel_torque"]["first_s"] == pytest.approx(run.t[np.argmax(full)], abs=0.011)
    power = (used * np.abs(run.wheel_speed[:-1])).max(axis=1)
    assert power.max() <= 0.0101 and ("wheel_power" in found) == bool(power.max() > 0.00999)
    cut = run.limited[:-1] > 0
    assert found["torque"]["share"] == pytest.approx(cut.mean())
    assert found["torque"]["first_s"] == run.t[np.argmax(cut)]
    assert found["torque"]["last_s"] == run.t[:-1][cut][-1]
    rates = np.abs(run.rates[:-1]) / np.radians(4.0)
    assert rates.max() <= 1 + 1e-9
    assert ("gimbal_rate" in found) == bool(rates.max() > 0.9999)
    assert "wheel_speed" not in found and "torque-cut" in run.status


def test_spans_of_marks():
    t = np.arange(7.0)
    marks = np.array([True, False, True, True, False, True])
    assert wheel_summary.spans(t, marks) == [(0.0, 1.0), (2.0, 4.0), (5.0, 6.0)]
    assert wheel_summary.spans(t, ~marks & False) == []


def test_a_run_is_stored_with_names_and_units_and_comes_out_again(limited, tmp_path):
    xarray = pytest.importorskip("xarray")
    scenario, run = limited
    store.write(run, scenario, tmp_path / "r", csv=True)
    with xarray.open_dataset(tmp_path / "r" / "trajectory.nc") as data:
        units = {"wheel_speed": "rad s-1", "wheel_acceleration": "rad s-2", "limited": "1"}
        units |= {"wheel_motor_torque": "N m", "estimated_inertia": "kg m2"}
        for name, unit in units.items():
            assert data[name].attrs["units"] == unit and data[name].attrs["long_name"]
        assert np.array_equal(data["wheel_speed"], run.wheel_speed)
        by_name = data["estimated_inertia"].sel(inertia_part="J_yy")
        assert np.array_equal(by_name, run.estimates[:, 1])
        third = data["estimated_unit_inertia"][:, 2]
        assert data["unit_inertia_part"].values.tolist()[2] == "Jg_2"
        assert np.array_equal(third, run.estimates[:, 12])
        assert np.allclose(data["design_wheel_speed"], 200.0)
        assert "motor_work" not in data and "Wheel speeds change" in data.attrs["conventions"]
    told = run.to_xarray()
    assert told["estimated_inertia"].sel(inertia_part="Js-Jt_3").dims == ("time",)
    head = (tmp_path / "r" / "trajectory.csv").read_text().partition("\n")[0].split(",")
    assert {"wheel_speed_3_rad_s", "estimated_inertia_J_xy_kg_m2", "limited"} <= set(head)
    summary = json.loads((tmp_path / "r" / "summary.json").read_text())
    assert summary["wheels"]["final_speed_rad_s"] == run.wheel_speed[-1].tolist()
    assert summary["wheels"]["wheel_settling_s"] is None
    assert set(summary["limited"]) == set(wheel_summary.limits(run))
    assert {"momentum_budget", "lyapunov"} <= set(summary)
    again = rerun.read(tmp_path / "r")
    assert rerun.verdict(again, nm.simulate(again.scenario())) == "identical, bit for bit"


def test_motor_work_is_stored_of_motors(tmp_path):
    run = nm.simulate(load_scenario(TEXT), "python")
    assert run.to_xarray()["motor_work"].attrs["units"] == "J"


def test_a_dead_wheel_motor_in_words():
    text = changed((END, END + "\n" + EVENT.format("wheel-dead") + "detected_after_s = 0.2\n"))
    run = nm.simulate(load_scenario(text), "python")
    assert told(run) == "CMG 2's wheel motor dead at t = 0.1 s, found at 0.3 s"
    late = run.wheel_motor_torque[12:-1]
    assert np.abs(late[:, 1]).max() == 0 < np.abs(late[:, 0]).max()


# ---- many runs


@pytest.mark.parametrize(
    "values",
    [
        {"inertia_kg_m2": [[0.5, 0.6, 0.7], [0.6, 0.6, 0.9]]},
        {"vscmg.spin_inertia_kg_m2": [2e-3, 2.5e-3]},
        {"initial.wheel_speed_rad_s": [0.0, -20.0]},
        {"initial.wheel_speed_rad_s": [[0.0, 0.0, 0.0, 0.0], [10.0, 200.0, 5.0, -3.0]]},
        {"array.wheel_speed_rad_s": [200.0, 150.0]},
        {"wheel_torque_limit_Nm": [0.01, 0.002]},
        {"gimbal_deg": [[0.0, 0.0, 0.0, 0.0], [10.0, -20.0, 30.0, 40.0]]},
        {"q_BN": [[1.0, 0.0, 0.0, 0.0], [0.0, 0.6, 0.8, 0.0]]},
        {"omega_BN_B": [[0.0, 0.0, 0.0], [0.02, -0.01, 0.03]]},
        {"vscmg.drive": ["torque", "rate"]},
    ],
)
@pytest.mark.sampled(3)
def test_any_value_varies_by_key(values):
    base = load_scenario(TEXT, {"simulation.duration_s": 0.1})
    batch = nm.simulate_batch(base, ["wheel_speed_error"], **values)
    sections = {"inertia_kg_m2": "spacecraft", "q_BN": "spacecraft", "omega_BN_B": "spacecraft"}
    sections |= {"wheel_torque_limit_Nm": "array", "gimbal_deg": "initial"}
    dotted = {k: f"{sections[k]}.{k}" if k in sections else k for k in values}
    one = nm.simulate(base.with_values({dotted[k]: v[1] for k, v in values.items()}), "python")
    assert np.allclose(batch.final_wheel_speed[1], one.wheel_speed[-1], rtol=1e-9, atol=1e-9)
    assert np.allclose(batch.final_q_BN[1], one.q_BN[-1], atol=1e-12)
    error = one.metrics["final_wheel_speed_error"]
    assert batch["final_wheel_speed_error"][1] == pytest.approx(error, rel=1e-9)


def test_a_batch_tells_which_startups_are_incomplete():
    base = load_scenario(TEXT, {"simulation.duration_s": 0.1})
    speeds = {"initial.wheel_speed_rad_s": [0.0, 199.0]}
    batch = nm.simulate_batch(base, ["wheel_speed_error"], **speeds)
    assert batch.status["startup-incomplete"].tolist() == [True, False]


def test_a_batch_refuses_what_one_run_would():
    rates = [[0.0, 0.0, 0.0], [1.4, 0.0, 0.0]]
    with pytest.raises(InputError, match=r"run 1: spacecraft.omega_BN_B.*holds at most"):
        nm.simulate_batch(load_scenario(TEXT), omega_BN_B=rates)


# ---- the library

LIBRARY = {  # name: latest time of attitude and wheels, least and greatest peak of gimbal rates
    "kim2014-case1": (20.0, 598.0, 25.0, 25.0),
    "kim2014-case2": (20.0, 238.0, 1.0, 24.9),
    "vscmg-startup": (40.0, 250.0, 0.1, 5.0),
    "vscmg-startup-roof": (40.0, 250.0, 0.1, 5.0),
    "vscmg-tumble": (40.0, 250.0, 0.1, 5.0),
    "vscmg-disturbed": (80.0, 250.0, 0.1, 5.0),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", LIBRARY)
def test_the_startups_of_the_library_settle(name):
    attitude, wheels, low, high = LIBRARY[name]
    run = nm.simulate(name)
    m = run.metrics
    assert m["settling_time_s"] < attitude and m["wheel_settling_s"] < wheels
    assert m["final_pointing_error_deg"] < 1.0 and m["final_wheel_speed_error"] < 0.02
    assert low - 1e-9 <= np.nanmax(np.abs(run.rates)) <= high * (1 + 1e-3)
    assert "startup-incomplete" not in run.status
    limit = run.setup.array.wheels.torque_limit
    assert np.all(np.nanmax(np.abs(run.wheel_motor_torque), axis=0) <= limit * (1 + 1e-9))


def test_the_papers_reference_is_its_sine():
    made = setup(load_scenario("kim2014-case1"))
    t = np.arange(len(made.reference)) * made.dt
    assert made.array.h0[0] == pytest.approx(0.139) and made.delta[0] == pytest.approx(0.5498)
    rate = 0.004 * np.sin(2 * np.pi * t / 2000)
    assert np.abs(made.reference[:, 4] - rate).max() < 1e-6
    half = 0.5 * 0.004 * 2000 / (2 * np.pi) * (1 - np.cos(2 * np.pi * t / 2000))
    assert np.abs(made.reference[:, 1] - np.sin(half)).max() < 1e-5
