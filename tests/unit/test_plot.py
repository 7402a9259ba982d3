"""Figures: what panels say of a run, and files that come out right."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import nullmotion as nm
from nullmotion import rotation
from nullmotion.errors import InputError
from nullmotion.plot import attitude, compare_figure, palette, panels, run_figure
from nullmotion.plot.draw import sheet
from nullmotion.plot.events import marks as events_of
from nullmotion.plot.events import told
from nullmotion.plot.overlays import overlays
from nullmotion.plot.quantities import (
    axis_names,
    steady_direction,
    stuck_since,
    torque_fractions,
)
from nullmotion.plot.varied import varied_panels
from nullmotion.spacecraft import Disturbance, Event

STARTS = {".png": b"\x89PNG", ".pdf": b"%PDF", ".svg": b"<?xml"}


def turning(steps=60, dt=0.02, rate_limit=np.pi, array=None):
    """A run in which every gimbal turns evenly, and what follows from that."""
    array = array or nm.layouts.pyramid(rate_limit=rate_limit)
    t = np.arange(steps + 1) * dt
    pace = 0.5 * np.array([1.0, -1.0, 1.0, -1.0, 1.0])[: array.n]
    delta, rates = np.outer(t, pace), np.tile(pace, (steps + 1, 1))
    rates[-1] = np.nan
    torque = np.einsum("kmn,kn->km", array.jacobian(delta), rates)
    hdot = np.zeros((steps + 1, array.m))
    hdot[:, 0] = 2.0
    return SimpleNamespace(
        t=t,
        delta=delta,
        rates=rates,
        hdot=hdot,
        torque=torque,
        momentum=array.momentum(delta),
        measures={"sigma_min": np.ones(steps + 1), "sqrt_det_AAT": np.ones(steps + 1)},
        eram=np.ones_like(delta),
        metrics={"min_sigma_min": 1.0},
        stopped_at_s=None,
        stop_reason="end of run",
        status=[],
        backend="python",
        setup=SimpleNamespace(array=array, law=nm.laws.create("pi"), dt=dt, stop=()),
    )


def case(label, run, value=None):
    metrics = {} if run is None else {**run.metrics, "stopped_at_s": None}
    return SimpleNamespace(
        label=label, law="pi", information=(), trajectory=run, metrics=metrics, value=value
    )


@pytest.mark.parametrize(
    "suffix", [".png", *(pytest.param(s, marks=pytest.mark.slow) for s in STARTS if s != ".png")]
)
def test_files_are_what_their_suffix_says(tmp_path, suffix):
    path = run_figure(turning(), tmp_path / f"run{suffix}", title="Run")
    assert path.read_bytes().startswith(STARTS[suffix]) and list(tmp_path.iterdir()) == [path]
    comparison = SimpleNamespace(cases=(case("a", turning()), case("b", turning())), varied=None)
    path = compare_figure(comparison, tmp_path / f"compare{suffix}")
    assert path.read_bytes().startswith(STARTS[suffix])


def test_what_cannot_be_drawn_is_refused(tmp_path):
    with pytest.raises(InputError, match=r"\.png"):
        run_figure(turning(), tmp_path / "run.bmp")
    with pytest.raises(InputError, match="one case that ran"):
        compare_figure(SimpleNamespace(cases=(case("a", None),), varied=None), tmp_path / "c.png")
    assert not list(tmp_path.iterdir())


def test_matplotlib_waits_for_the_first_figure():
    code = "import sys, nullmotion.plot.figures; print('matplotlib' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "False"


def test_six_panels_of_the_field():
    run = turning()
    made = [make(run) for make in panels.LITERATURE_PANELS]
    assert [p.key for p in made] == [
        "torque",
        "momentum_norm",
        "rates",
        "angles",
        "residual",
        "measures",
    ]
    assert all("[" in p.y_title and p.y_title.endswith("]") for p in made)
    np.testing.assert_allclose(made[3].curves[1].y, np.degrees(run.delta[:, 1]))


def test_asked_torque_is_dashed_and_of_its_axis_colour():
    curves = panels.torque(turning()).curves
    for given, asked in zip(curves[::2], curves[1::2], strict=True):
        assert given.colour == asked.colour and given.dash == "solid" and asked.dash == "dash"


def test_rate_limit_is_drawn_when_near_and_said_when_far():
    near = panels.rates(turning(rate_limit=0.6))
    assert {round(level.value, 6) for level in near.levels} == {
        round(s * np.degrees(0.6), 6) for s in (1, -1)
    }
    far = panels.rates(turning(rate_limit=10.0))
    assert far.levels == () and "limit" in far.note
    assert panels.rates(turning(rate_limit=np.inf)).levels == ()


def test_normalisation_is_said_with_the_measures():
    assert "mean momentum" in panels.measures(turning()).note
    assert "mean momentum" in overlays([case("a", turning())])[1].note


def test_fractions_split_the_torque():
    run = turning()
    along, across = torque_fractions(run)
    whole = np.linalg.norm(run.torque, axis=1) / 2.0
    np.testing.assert_allclose(np.hypot(along, across)[:-1], whole[:-1], rtol=1e-12)


def test_two_torque_dimensions():
    run = turning(array=nm.layouts.planar(n=3, rate_limit=1.0))
    assert axis_names(run) == ["x", "y"]
    assert all(panel.curves for panel in panels.run_panels(run))


def test_direction_of_the_command():
    run = turning()
    np.testing.assert_allclose(steady_direction(run), [1, 0, 0])
    run.hdot[30:, 1] = 1.0
    assert steady_direction(run) is None
    assert overlays([case("a", run)])[0].y_title == "|h| [N m s]"
    run.hdot[:] = 0.0
    assert steady_direction(run) is None and stuck_since(run) is None


def test_stuck_is_judged_by_momentum_not_by_torque():
    run = turning(200)
    run.momentum = np.zeros_like(run.momentum)
    run.momentum[:, 0] = np.minimum(2.0 * run.t, 3.0)  # follows the command of 2 N m until 1.5 s
    run.momentum[::2, 0] += 1e-3  # and chatters
    assert stuck_since(run) == pytest.approx(1.5, abs=0.05)
    run.momentum[:, 0] = 2.0 * run.t
    assert stuck_since(run) is None


def test_cases_keep_their_colour_when_one_could_not_run():
    drawn = overlays([case("a", turning()), case("b", None), case("c", turning())])[0].curves
    assert [c.colour for c in drawn] == [palette.colour(0), palette.colour(2)]


def test_curves_over_a_varied_value_are_in_order():
    runs = [case("a", turning(), v) for v in (3.0, 1.0, 2.0)]
    for i, one in enumerate(runs):
        one.metrics["min_sigma_min"] = float(i)
    panel = next(
        p
        for p in varied_panels(SimpleNamespace(cases=runs, varied="k"))
        if p.key == "varied_min_sigma_min"
    )
    np.testing.assert_array_equal(panel.curves[0].x, [1.0, 2.0, 3.0])
    np.testing.assert_array_equal(panel.curves[0].y, [1.0, 2.0, 0.0])


def test_a_varied_value_may_be_a_word():
    runs = [case("a", turning(), v) for v in ("euler", "rk4")]
    panel = varied_panels(SimpleNamespace(cases=runs, varied="simulation.integrator"))[0]
    assert panel.ticks == ("euler", "rk4")
    np.testing.assert_array_equal(panel.curves[0].x, [0.0, 1.0])


def test_every_slot_is_seen_on_white_and_told_apart():
    for hue in palette.COLOURS:
        r, g, b = (int(hue[i : i + 2], 16) / 255 for i in (1, 3, 5))
        linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in (r, g, b)]
        luminance = np.dot([0.2126, 0.7152, 0.0722], linear)
        assert 1.05 / (luminance + 0.05) >= 3  # what WCAG asks of graphics
    pairs = {(palette.colour(i), palette.dash(i)) for i in range(35)}
    assert len(pairs) == 35


@pytest.fixture(scope="module")
def turned(slew):
    return slew(steps=100, events=(Event("stuck", 2, 3.0, detected_after=0.5),))


@pytest.mark.sampled(1)
def test_a_figure_of_an_attitude(tmp_path, turned):
    made = panels.figure_panels(turned)
    assert [p.key for p in made] == [
        "pointing_error",
        "attitude",
        "body_rate",
        "torque",
        "rates",
        "angles",
        "measures",
        "motor_torque",
    ]
    assert all("[" in p.y_title and p.y_title.endswith("]") for p in made)
    assert run_figure(turned, tmp_path / "run.png").read_bytes().startswith(STARTS[".png"])
    axes = sheet(made).axes[0]
    assert axes.get_yscale() == "log"
    assert [t.get_text() for t in axes.texts] == ["tolerance 0.1 deg", "CMG 3 stuck, found"]


def test_charts_of_an_attitude_show_the_run(turned):
    made = {p.key: p for p in panels.run_panels(turned)}
    np.testing.assert_allclose(
        made["pointing_error"].curves[0].y, np.degrees(turned.pointing_error)
    )
    asked = {c.label: c.y for c in made["attitude"].curves}
    np.testing.assert_allclose(asked["roll asked"], 30.0)
    np.testing.assert_allclose(asked["roll"][0], 0.0, atol=1e-9)
    power = np.abs(turned.motor_torque * turned.rates).sum(axis=1)
    np.testing.assert_array_equal(made["motor_power"].curves[0].y, power)
    assert "inertial_momentum" not in made  # nothing from outside changes it


def test_momentum_in_the_inertial_frame_is_drawn_when_a_torque_changes_it(slew):
    run = slew(steps=20, disturbance=Disturbance(constant=np.array([0.0, 0.0, 0.01])))
    panel = next(p for p in panels.run_panels(run) if p.key == "inertial_momentum")
    np.testing.assert_allclose(panel.curves[2].y[-1], 0.01, rtol=1e-3)  # 0.01 N m for 1 s


def test_measures_leave_stuck_cmgs_out(turned):
    array, least = turned.setup.array, turned.measures["sigma_min"]
    for k, gone in ((0, []), (int(np.flatnonzero(turned.t < 3.0)[-1]), []), (-1, [2])):
        left = np.delete(array.jacobian(turned.delta[k]), gone, axis=1) / array.mean_momentum
        assert least[k] == pytest.approx(np.linalg.svd(left, compute_uv=False)[-1], rel=1e-9)
    assert turned.metrics.get("min_sigma_min", least.min()) == pytest.approx(least.min(), rel=1e-9)


def test_angles_have_a_gap_where_they_turn_over(turned):
    yaw = np.radians([178.0, 179.0, -179.0, -178.0])
    q = np.array([rotation.from_euler_321((a, 0.0, 0.0)) for a in yaw])
    run = replace(turned, t=turned.t[:4], q_BN=q, reference=q)
    drawn = attitude.euler_angles(run).curves[0].y
    np.testing.assert_allclose(drawn, [178.0, 179.0, np.nan, -178.0])


def test_errors_near_zero_do_not_stretch_the_axis(turned):
    run = replace(turned, reference=turned.q_BN)
    panel = attitude.pointing_error(run)
    assert panel.curves[0].y.min() == attitude.LEAST_DEG and "drawn there" in panel.note


def test_names_of_marks_never_overlap(turned):
    def names(*events):
        run = replace(turned, setup=replace(turned.setup, events=events))
        return [(m.at, m.label, m.side) for m in events_of(run) if m.label]

    assert names(Event("stuck", 0, 1.0, detected_after=np.inf)) == [(1.0, "CMG 1 stuck", "right")]
    assert names(Event("slow", 0, 9.0, rate_limit=1.0)) == []
    assert names(Event("stuck", 0, 0.5, detected_after=4.0)) == [
        (0.5, "CMG 1 stuck", "right"),
        (4.5, "found", "left"),
    ]
    both = Event("stuck", 0, 1.0), Event("spin-down", 1, 4.0, detected_after=0.2)
    assert names(*both) == [(1.0, "CMG 1 stuck, CMG 2 spinning down, CMG 2 found", "right")]


def test_faults_in_words(turned):
    assert told(turned) == "CMG 3 stuck at t = 3 s, found at 3.5 s; 3 CMGs left"
    slow = (Event("slow", 0, 1.0, rate_limit=1.0),)
    assert told(replace(turned, setup=replace(turned.setup, events=slow))) == (
        "CMG 1 slow at t = 1 s, known at once"
    )
    late = (Event("stuck", 0, 1.0, detected_after=99.0),)
    assert "not found; 3 CMGs left" in told(
        replace(turned, setup=replace(turned.setup, events=late))
    )
    assert told(turning()) == ""


def test_overlays_of_attitudes(turned):
    made = overlays([case("a", turned), case("b", None)])
    assert [p.key for p in made] == [
        "pointing_error",
        "torque_missed",
        "sigma_min",
        "momentum",
        "largest_rate",
        "motor_torque",
    ]
    assert made[0].log and made[0].levels[0].value == pytest.approx(0.1)
    assert all(len(p.marks) == 2 for p in made)


def test_attitudes_over_a_varied_value(turned):
    runs = [case("a", turned, v) for v in (1.0, 2.0)]
    made = {p.key: p for p in varied_panels(SimpleNamespace(cases=runs, varied="k"))}
    assert "varied_settling_time_s" not in made  # neither settled
    assert made["varied_final_pointing_error_deg"].log


def test_labels_stay_inside_the_sheet():
    run = turning()
    names = ["a very long name of a steering law with its parameters", "b", "c"]
    figure = sheet(overlays([case(name, run) for name in names]), title="Title", common_legend=True)
    figure.draw_without_rendering()
    box = figure.get_tightbbox()
    width, height = figure.get_size_inches()
    assert (
        box.x0 >= -0.01 and box.y0 >= -0.01 and box.x1 <= width + 0.01 and box.y1 <= height + 0.01
    )
