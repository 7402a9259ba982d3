"""Pages: one document, no network, nothing of the user's taken for HTML, sizes, verdicts."""

from __future__ import annotations

import base64
import json
import subprocess
import sys
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import nullmotion as nm
from nullmotion.campaign.cases import parameters_kind
from nullmotion.errors import NullmotionError
from nullmotion.report import compare_report, page, run_report
from nullmotion.report.findings import findings
from nullmotion.report.markup import Markup, tag
from nullmotion.report.ranking import Column, best
from nullmotion.report.results import KINDS
from nullmotion.report.thin import thinned
from nullmotion.report.verdict import verdict
from nullmotion.report.wording import meaning, number, percent, quantity
from nullmotion.spacecraft import Event, Servo

EVIL = """<img src=x onerror="alert(1)"></script><script>alert('2')</script>&amp; $title"""


def flown(hdot=(1.0, 0.0, 0.0), steps=400, dt=0.01, law="pseudo-inverse", stopped=None, repeat=1):
    """A run by a plain Euler loop, as the time loop would hand it over."""
    array = nm.layouts.pyramid(skew=np.radians(54.73), rate_limit=np.pi)
    made = nm.laws.create(law)
    asked = np.array(hdot, float)
    delta, rates = np.zeros((steps + 1, 4)), np.full((steps + 1, 4), np.nan)
    state = made.init(array, delta[0])
    for k in range(steps):
        seen = nm.Observation(delta=delta[k], hdot=asked, t=k * dt, period=dt)
        wanted, state = made.step(array, seen, state)
        rates[k] = array.limited(wanted)
        delta[k + 1] = delta[k] + dt * rates[k]
    delta, rates = np.tile(delta, (repeat, 1)), np.tile(rates, (repeat, 1))
    jacobian = array.jacobian(delta)
    s = np.linalg.svd(jacobian, compute_uv=False)
    return SimpleNamespace(
        t=np.arange(len(delta)) * dt,
        delta=delta,
        rates=rates,
        hdot=np.tile(asked, (len(delta), 1)),
        torque=np.einsum("kmn,kn->km", jacobian, rates),
        momentum=array.momentum(delta),
        measures={
            "sigma_min": s[:, -1],
            "sqrt_det_AAT": s.prod(axis=1),
            "momentum_state": 1.0 + s[:, -1],
        },
        eram=np.abs(np.cos(delta)) / 2,
        metrics={
            "min_sigma_min": float(s.min()),
            "max_off_axis_torque_fraction": 0.0123,
            "max_new_thing_s": np.nan,
        },
        stopped_at_s=stopped,
        stop_reason="momentum_state below 0.2" if stopped else "end of run",
        status=[],
        backend="python",
        instruction_set="",
        setup=SimpleNamespace(
            array=array,
            law=made,
            dt=dt,
            plant=None,
            stop=(SimpleNamespace(metric=SimpleNamespace(name="momentum_state"), threshold=0.2),),
        ),
    )


@pytest.fixture(scope="module")
def stuck():
    return flown()


@pytest.fixture(scope="module")
def good():
    return flown((1.0, 1.0, 1.0), 150)


def case(label, run, reason="", value=None, law="pseudo-inverse"):
    metrics = {} if run is None else {**run.metrics, "stopped_at_s": run.stopped_at_s}
    return SimpleNamespace(
        label=label,
        law=law,
        parameters_kind="defaults",
        information=(),
        trajectory=run,
        reason=reason,
        metrics=metrics,
        value=value,
    )


class Document(HTMLParser):
    """What a browser would see: elements, attributes, text, script contents."""

    def __init__(self, content: str) -> None:
        super().__init__()
        self.elements: list[tuple[str, dict]] = []
        self.open: list[str] = []
        self.text, self.blocks = "", []
        self.feed(content)
        self.close()

    def handle_starttag(self, name, attributes):
        self.elements.append((name, dict(attributes)))
        if name in ("script", "style"):
            self.blocks.append("")
        if name not in ("meta", "link", "input", "br"):
            self.open.append(name)

    def handle_endtag(self, name):
        assert self.open.pop() == name

    def handle_data(self, data):
        if self.open and self.open[-1] in ("script", "style"):
            self.blocks[-1] += data
        else:
            self.text += data

    def data(self):
        block = next(b for b in self.blocks if b.startswith('{"arrays"'))
        return json.loads(block, parse_constant=lambda name: pytest.fail(f"{name} in JSON"))


def read(path: Path) -> Document:
    return Document(path.read_text(encoding="utf-8"))


def pages(tmp_path, stuck, good):
    comparison = SimpleNamespace(
        cases=(case("one", good), case("two", stuck), case("three", None, "needs a preview")),
        varied=None,
    )
    varied = SimpleNamespace(
        cases=tuple(case(label, good, value=v) for v in (40.0, 50.0) for label in "ab"),
        varied="array.skew_deg",
    )
    return [
        run_report(stuck, tmp_path / "run.html", "Run", "[law]"),
        compare_report(comparison, tmp_path / "compare.html", "Compare", "[law]"),
        compare_report(varied, tmp_path / "varied.html", "Varied"),
    ]


def test_pages_are_one_document_that_asks_for_nothing(tmp_path, stuck, good):
    for path in pages(tmp_path, stuck, good):
        document = read(path)
        assert document.open == []
        names = [name for name, _ in document.elements]
        assert (
            names.count("html")
            == names.count("body")
            == names.count("main")
            == names.count("h1")
            == 1
        )
        for name, attributes in document.elements:
            assert name not in ("iframe", "object", "embed", "img", "base")
            assert "src" not in attributes and "srcset" not in attributes
            assert attributes.get("href", "data:,") == "data:,"
            assert not any(key.startswith("on") for key in attributes)
        style = next(b for b in document.blocks if "color-scheme" in b)
        assert "@import" not in style and "url(" not in style
        policy = next(
            a["content"] for n, a in document.elements if n == "meta" and "http-equiv" in a
        )
        assert policy.startswith("default-src 'none'") and "http" not in policy
        assert path.stat().st_size < 8_000_000


def test_every_chart_has_its_place_and_its_numbers(tmp_path, stuck, good):
    for path in pages(tmp_path, stuck, good):
        document = read(path)
        data = document.data()
        places = [a["data-chart"] for _, a in document.elements if "data-chart" in a]
        assert sorted(places) == sorted(data["figures"]) and len(places) >= 2
        ids = [a["id"] for _, a in document.elements if "id" in a]
        assert len(ids) == len(set(ids))


def test_numbers_in_a_page_are_those_of_the_run(tmp_path, stuck):
    data = read(run_report(stuck, tmp_path / "run.html", "Run")).data()
    trace = data["figures"]["angles"]["traces"][2]
    kind, coded = data["arrays"][trace["y"]].split(":")
    drawn = np.frombuffer(base64.b64decode(coded), f"<{kind}")
    assert trace["name"] == "CMG 3"
    np.testing.assert_allclose(drawn, np.degrees(stuck.delta[:, 2]), rtol=1e-6)


def test_text_of_the_user_stays_text(tmp_path, good):
    hostile = SimpleNamespace(
        **{**vars(good), "stop_reason": EVIL, "stopped_at_s": 1.5, "status": [EVIL]}
    )
    run = read(run_report(hostile, tmp_path / "run.html", EVIL, EVIL))
    comparison = SimpleNamespace(
        cases=(case(EVIL, hostile), case("b", None, EVIL, law=EVIL)), varied=None
    )
    compared = read(compare_report(comparison, tmp_path / "compare.html", EVIL, EVIL))
    varied = SimpleNamespace(cases=(case(EVIL, good, value=EVIL),), varied=EVIL)
    over = read(compare_report(varied, tmp_path / "varied.html", EVIL))
    for document, scripts in ((run, 5), (compared, 5), (over, 3)):
        names = [name for name, _ in document.elements]
        assert "img" not in names and names.count("script") == scripts
        assert EVIL in document.text
        assert not any("onerror" in a for _, a in document.elements)
    assert compared.data()["figures"]["sigma_min"]["traces"][0]["name"] == EVIL


def test_a_long_run_stays_small_and_keeps_its_extremes(tmp_path, good):
    run = SimpleNamespace(**vars(flown((1.0, 1.0, 1.0), 100, repeat=1000)))
    run.torque[54_321, 1] = 77.0
    path = run_report(run, tmp_path / "long.html", "Long")
    assert path.stat().st_size < 8_000_000
    document = read(path)
    assert "extremes kept" in document.text
    data = document.data()
    trace = next(t for t in data["figures"]["torque"]["traces"] if t["name"] == "y given")
    drawn = np.frombuffer(base64.b64decode(data["arrays"][trace["y"]].partition(":")[2]), "<f4")
    assert np.nanmax(drawn) == np.float32(77.0) and len(drawn) < 5000


def test_thinning_keeps_ends_extremes_and_gaps():
    x = np.arange(100_003.0)
    y = np.sin(x / 3000)
    y[1234], y[77_777], y[50_000:50_003] = 9.0, -8.0, np.nan
    kept_x, kept_y = thinned(x, y, 1000)
    assert len(kept_x) <= 1010 and np.all(np.diff(kept_x) > 0)
    assert kept_x[0] == 0 and kept_x[-1] == x[-1]
    assert np.nanmax(kept_y) == 9.0 and np.nanmin(kept_y) == -8.0 and np.isnan(kept_y).any()
    np.testing.assert_array_equal(kept_y, y[kept_x.astype(int)])
    assert (
        thinned(x[:50], y[:50], 1000)[0] is not None and len(thinned(x[:50], y[:50], 1000)[0]) == 50
    )


def test_thinning_keeps_gaps_of_not_a_number_alone():
    x = np.arange(10_000.0)
    kept_x, kept_y = thinned(x, np.full(10_000, np.nan), 100)
    assert np.isnan(kept_y).all() and kept_x[-1] == 9999


def test_verdicts(stuck, good):
    said = verdict(stuck)
    assert said.words.startswith("Stuck: delivers no torque from 1.1") and not said.useful
    assert verdict(good).words == "Ran to the end (1.5 s)"
    stopped = SimpleNamespace(
        **{**vars(good), "stopped_at_s": 1.5, "stop_reason": "momentum_state below 0.2"}
    )
    assert verdict(stopped).words == "Stopped at 1.5 s: momentum state below 0.2"
    used_up = SimpleNamespace(**{**vars(stuck), "metrics": {"final_momentum_state": 0.05}})
    assert (
        verdict(used_up).words.startswith("Saturated: momentum used up") and verdict(used_up).useful
    )
    broken = SimpleNamespace(
        **{**vars(good), "delta": np.where(good.t[:, None] > 1.0, np.nan, good.delta)}
    )
    assert verdict(broken).words == "Failed: not a number from 1.01 s on"


def test_a_run_without_command_is_shown(tmp_path):
    run = flown((0.0, 0.0, 0.0), 20)
    assert "Ran to the end" in read(run_report(run, tmp_path / "still.html", "Still")).text


def test_a_run_that_broke_is_shown(tmp_path):
    run = flown((1.0, 1.0, 1.0), 50)
    for history in (
        run.delta,
        run.rates,
        run.torque,
        run.momentum,
        run.eram,
        *run.measures.values(),
    ):
        history[20:] = np.nan
    run.torque[10] = np.inf
    document = read(run_report(run, tmp_path / "broken.html", "Broken"))
    assert "Failed: not a number from 0.2 s on" in document.text


def test_a_comparison_where_nothing_ran_is_a_table(tmp_path):
    nothing = SimpleNamespace(cases=(case("a", None, "needs four CMGs"),), varied=None)
    document = read(compare_report(nothing, tmp_path / "none.html", "None"))
    assert "needs four CMGs" in document.text
    assert not any(name == "script" for name, _ in document.elements)


REQUIREMENTS = [
    {"name": "settling_time_s_below", "limit": 30.0, "value": 16.0, "margin": 14.0, "passed": True},
    {
        "name": "max_motor_torque_Nm_below",
        "limit": 0.1,
        "value": 0.2,
        "margin": -0.1,
        "passed": False,
    },
    {
        "name": "final_pointing_error_deg_above",
        "limit": 0.0,
        "value": None,
        "margin": None,
        "passed": False,
    },
]


@pytest.fixture(scope="module")
def turned(slew):
    return slew()


@pytest.fixture(scope="module")
def faulty(slew):
    return slew(steps=100, events=(Event("stuck", 1, 1.0, detected_after=0.5),))


def test_a_page_of_an_attitude_leads_with_the_pointing_error(tmp_path, turned):
    document = read(run_report(turned, tmp_path / "run.html", "Slew", "", REQUIREMENTS))
    figures = document.data()["figures"]
    assert list(figures)[:4] == ["pointing_error", "attitude", "body_rate", "torque"]
    assert {"rates", "angles", "measures", "momentum", "motor_torque", "motor_power"} <= {*figures}
    assert not {"torque_error", "residual", "state"} & {*figures}
    error = figures["pointing_error"]["layout"]
    assert error["yaxis"]["type"] == "log"
    assert error["shapes"][0]["y0"] == pytest.approx(0.1)
    assert error["annotations"][0]["y"] == pytest.approx(-1)
    names = [trace["name"] for trace in figures["attitude"]["traces"]]
    assert names == ["yaw", "yaw asked", "pitch", "pitch asked", "roll", "roll asked"]
    settled = number(turned.metrics["settling_time_s"])
    for words in (
        f"Settled within 0.1 deg in {settled} s",
        "asked to turn by 30 deg, under quaternion feedback",
        "No singular encounter",
        "Requirements passed: 1/3",
        "Peak body rate",
        "Rate-saturated",
    ):
        assert words in document.text


def test_requirements_are_told_by_sign_and_word(tmp_path, turned):
    text = read(run_report(turned, tmp_path / "run.html", "Slew", "", REQUIREMENTS)).text
    assert text.count("✓ passed") == 1 and text.count("✗ failed") == 2
    assert "14 s (46.7 %)" in text and "−0.1 N m (−100 %)" in text
    assert "requirement" not in read(run_report(turned, tmp_path / "run.html", "Slew")).text.lower()


def test_a_stuck_cmg_is_said_and_marked(tmp_path, faulty):
    document = read(run_report(faulty, tmp_path / "run.html", "Fault"))
    left = number(np.degrees(faulty.pointing_error[-1]))
    assert (
        "CMG 2 stuck at t = 1 s, found at 1.5 s; 3 CMGs left; "
        f"not settled within 0.1 deg: {left} deg left at the end"
    ) in document.text
    for figure in document.data()["figures"].values():
        upright = [s["x0"] for s in figure["layout"]["shapes"] if s.get("yref") == "paper"]
        assert upright == [1.0, 1.5]
        above = [a["text"] for a in figure["layout"]["annotations"] if a.get("yref") == "paper"]
        assert above == ["CMG 2 stuck, found"]


def test_verdicts_on_an_attitude(turned, faulty):
    assert verdict(turned).tone == "done" and not verdict(faulty).useful
    metrics = {**faulty.metrics, "settling_time_s": np.nan, "final_pointing_error_deg": 3.2}
    stopped = replace(faulty, metrics=metrics, stopped_at_s=5.0, stop_reason="sigma_min below 0.1")
    assert verdict(stopped).words == (
        "Stopped at 5 s: sigma min below 0.1; not settled within 0.1 deg: 3.2 deg left at the end"
    )
    held = replace(turned, metrics={**turned.metrics, "settling_time_s": 0.0})
    assert verdict(held).words == "Always within 0.1 deg"
    unmeasured = replace(turned, metrics={}, setup=replace(turned.setup, metrics=()))
    assert verdict(unmeasured).words.startswith("Ran to the end (20 s); 0.01")
    broken = replace(turned, q_BN=np.where(turned.t[:, None] > 10, np.nan, turned.q_BN))
    assert verdict(broken).words == "Failed: not a number from 10.05 s on"


def test_an_attitude_that_broke_is_shown(tmp_path, faulty):
    with np.errstate(all="ignore"):
        lost = np.where(faulty.t[:, None] > 2, np.nan, 1.0)
        names = ("q_BN", "omega_BN_B", "delta", "rates", "rates_asked", "motor_torque", "hdot")
        broken = replace(faulty, **{name: lost * getattr(faulty, name) for name in names})
        document = read(run_report(broken, tmp_path / "broken.html", "Broken"))
    assert "not a number from 2.05 s on" in document.text


def test_what_saturated_is_said(slew):
    run = slew(steps=40, array=nm.layouts.pyramid(rate_limit=0.02))
    said = findings(run)
    assert any(s.startswith("The law asked for more than the rate limit for") for s in said)
    strained = replace(run, setup=replace(run.setup, servo=Servo(inertia=1e-3, torque_limit=1e-9)))
    assert any(
        s.startswith("A gimbal motor gave all of its torque for 2 s") for s in findings(strained)
    )


def test_a_comparison_of_attitudes_has_its_own_columns(tmp_path, turned, faulty):
    cases = [case("good", turned), case("bad", faulty), case("none", None, "needs more")]
    for one, results in zip(cases, (REQUIREMENTS[:1], REQUIREMENTS[1:], ()), strict=True):
        one.summary = {"requirements": list(results)}
    comparison = SimpleNamespace(cases=tuple(cases), varied=None)
    document = read(compare_report(comparison, tmp_path / "c.html", "C"))
    for words in ("1 settled, 1 not settled, 1 could not run", "Settling time [s]", "✓ 16 s"):
        assert words in document.text
    assert "Off-axis torque" not in document.text
    assert "A stuck CMG does not count" in document.text
    assert list(document.data()["figures"])[:2] == ["pointing_error", "torque_missed"]


def test_best_values_are_those_of_cases_that_did_their_job():
    low, high = Column("x", "x", "low"), Column("x", "x", "high")
    assert best(low, [3.0, 1.0, 2.0], [True, False, True]) == [False, False, True]
    assert best(high, [3.0, 3.0 + 1e-9, None], [True, True, True]) == [False, False, False]
    assert best(high, [3.0, 3.0 + 1e-9, 1.0], [True] * 3) == [True, True, False]
    assert best(Column("x", "x"), [1.0, 2.0], [True, True]) == [False, False]


def test_best_is_said_in_words_not_by_colour_alone(tmp_path, good):
    other = SimpleNamespace(**{**vars(good), "metrics": {**good.metrics, "min_sigma_min": 0.001}})
    comparison = SimpleNamespace(cases=(case("a", good), case("b", other)), varied=None)
    text = read(compare_report(comparison, tmp_path / "c.html", "C")).text
    assert "★" in text and "(best)" in text


@pytest.mark.parametrize(
    ("value", "written"),
    [
        (0.0, "0"),
        (1 / 3, "0.3333"),
        (-2.5, "−2.5"),
        (1.25e-7, "1.25×10⁻⁷"),
        (np.float64(180.0), "180"),
        (None, "–"),
        (np.nan, "–"),
        (np.inf, "∞"),
        ("text", "text"),
    ],
)
def test_numbers_as_written(value, written):
    assert number(value) == written


def test_shares_as_written():
    assert [percent(v) for v in (0.0, 1e-9, 0.1234, None)] == ["0", "< 0.001", "12.3", "–"]


def test_meaning_of_a_key():
    assert meaning("min_sigma_min").words == "least singular value, least over the run"
    assert meaning("max_new_thing_rad_s").unit == "rad/s"
    assert meaning("anything").words == "anything"
    assert meaning("gimbal_travel_rad")[:2] == ("gimbal travel", "rad")
    assert quantity(np.nan, "s", "settling_time_s") == ("not settled", "")
    assert quantity(2.0, "s", "settling_time_s") == ("2", "s")


def test_markup_escapes_what_is_not_markup():
    assert (
        tag("p", "<b>", Markup("<i></i>"), class_='"') == '<p class="&quot;">&lt;b&gt;<i></i></p>'
    )
    assert tag("input", checked=True, hidden=False, id=None) == "<input checked>"


def test_a_failed_write_leaves_the_old_file(tmp_path, monkeypatch):
    target = tmp_path / "page.html"
    target.write_text("old")
    monkeypatch.setattr("os.replace", lambda *_: (_ for _ in ()).throw(OSError("full")))
    with pytest.raises(OSError, match="full"):
        page.write(target, "new")
    assert target.read_text() == "old" and list(tmp_path.iterdir()) == [target]


def test_missing_plotly_is_said(monkeypatch):
    monkeypatch.setattr(page, "find_spec", lambda _: None)
    page._plotly.cache_clear()
    with pytest.raises(NullmotionError, match="plotly"):
        page._plotly()
    page._plotly.cache_clear()


def test_pages_need_no_heavy_import():
    heavy = "('plotly', 'matplotlib', 'xarray')"
    code = f"import sys, nullmotion.report; print([m for m in {heavy} if m in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_every_kind_of_parameters_has_its_words():
    for given in ((), ("as_published",), ("mu",), ("as_published", "mu")):
        section = SimpleNamespace(model_fields_set={"name", *given})
        section.as_published = "as_published" in given
        assert parameters_kind(section) in KINDS
