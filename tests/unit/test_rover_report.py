"""Pages of the rover: one document, no network, what moves in them, and in a browser."""

from __future__ import annotations

import base64
import json
import shutil
from html.parser import HTMLParser
from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from nullmotion.report.rover import write_mission_report, write_step_report
from nullmotion.report.rover_mission_scene import contour
from nullmotion.report.rover_mission_scene import scene as mission_scene
from nullmotion.report.rover_step_events import happened, marks
from nullmotion.report.rover_step_panels import drive, gravity, step_panels
from nullmotion.report.rover_step_scene import scene, world
from nullmotion.rover import Chassis, Cmg, Gains, Rover, Settings, Site, peter, plan_step, track
from nullmotion.rover import step_dynamics as dynamics
from nullmotion.rover.landing import land
from nullmotion.rover.path_cost import StepCosts
from nullmotion.rover.path_mission import travel
from nullmotion.rover.step_model import step_model
from nullmotion.rover.terrain import HeightField
from nullmotion.rover.terrain_random import generated

pytestmark = pytest.mark.slow  # it simulates whole steps

EVIL = """<img src=x onerror="alert(1)"></script><script>alert('2')</script>&amp; $title"""
QUICK = Settings(nodes=(30, 60), start_durations=(2.5,))
CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")


@pytest.fixture(scope="module")
def step():
    plan = plan_step(peter(), 1, Site(incline=np.radians(30)), settings=QUICK)
    return SimpleNamespace(plan=plan, run=track(plan), landing=land(plan))


def alike(a, b, pitch, cross):
    """A cost at once."""
    one = np.ones(np.shape(pitch))
    return StepCosts(200 + 100 * pitch**2, 5 * one, 50 * one)


@pytest.fixture(scope="module")
def trip():
    field = generated(9.0, seed=2, rms_slope=np.radians(8))
    return SimpleNamespace(
        field=field, travel=travel(field, peter(), (1.5, 1.5), (7.0, 6.5), cost=alike)
    )


class Document(HTMLParser):
    """Elements and attributes, text, contents of scripts and styles."""

    def __init__(self, path):
        super().__init__()
        self.elements, self.open, self.text, self.blocks = [], [], "", []
        self.feed(path.read_text(encoding="utf-8"))
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

    def data(self, first):
        block = next(b for b in self.blocks if b.startswith(f'{{"{first}"'))
        return json.loads(block, parse_constant=lambda name: pytest.fail(f"{name} in JSON"))


def decoded(text, *shape):
    return np.frombuffer(base64.b64decode(text), "<f4").reshape(shape)


def pages(folder, step, trip):
    cube = Rover(
        Chassis.named("cube", 0.5, 20.0),
        Cmg(np.array([0, 0, 1.0]), np.array([1.0, 0, 0]), 60.0, 2.0, 20.0),
    )
    box = plan_step(cube, 1, Site(gravity=1.6), settings=QUICK)
    return [
        write_step_report(folder / "landed.html", step.plan, step.run, step.landing),
        write_step_report(folder / "run.html", step.plan, step.run),
        write_step_report(folder / "ground.html", step.plan, landing=step.landing),
        write_step_report(folder / "plan.html", step.plan),
        write_step_report(folder / "cube.html", box),
        write_mission_report(folder / "mission.html", trip.travel, trip.field, peter()),
        write_mission_report(folder / "bare.html", trip.travel, trip.field),
    ]


def test_pages_are_one_document_that_asks_for_nothing(tmp_path, step, trip):
    for path in pages(tmp_path, step, trip):
        document = Document(path)
        assert document.open == []
        names = [name for name, _ in document.elements]
        assert all(names.count(name) == 1 for name in ("html", "main", "h1", "canvas"))
        for name, attributes in document.elements:
            assert name not in ("iframe", "object", "embed", "img", "base")
            assert "src" not in attributes and attributes.get("href", "data:,") == "data:,"
            assert not any(key.startswith("on") for key in attributes)
        assert not any("@import" in b or "url(" in b for b in document.blocks[:2])
        ids = [a["id"] for _, a in document.elements if "id" in a]
        assert len(ids) == len(set(ids))
        figures = document.data("arrays")["figures"]
        places = [a["data-chart"] for _, a in document.elements if "data-chart" in a]
        assert sorted(places) == sorted(figures) and len(places) >= 6
        assert len({figure["group"] for figure in figures.values()}) == 1
        assert path.stat().st_size < 8_000_000


def test_what_is_said_of_a_step(tmp_path, step):
    text = Document(write_step_report(tmp_path / "a", step.plan, step.run, step.landing)).text
    assert f"Landed after {step.landing.landed_at:.3g} s" in text and "on rock" in text
    assert "uphill on 30 deg" in text and "PETER: a step over e1" in text
    assert f"{step.run.cost_of_travel:.4g}" in text and f"{step.landing.energy:.4g}" in text
    text = Document(write_step_report(tmp_path / "b", step.plan)).text
    assert f"{step.plan.least_margin:.3g} N m to spare" in text and "Events" not in text


def test_a_step_that_tips_is_told_and_marked(tmp_path, step):
    run = track(step.plan, Gains(4, 4, 200))
    assert run.outcome == "tipped"
    first = run.t[np.flatnonzero(run.margin < 0)[0]]
    text = Document(write_step_report(tmp_path / "a.html", step.plan, run)).text
    assert f"Tips at {first:.3g} s" in text and "as if the edge held" in text
    assert any(mark.label == "tipping" and mark.at == first for mark in marks(run, None))


def test_text_of_the_user_stays_text(tmp_path, step, trip):
    made = [
        write_step_report(tmp_path / "a.html", step.plan, step.run, None, EVIL),
        write_mission_report(tmp_path / "b.html", trip.travel, trip.field, peter(), EVIL),
    ]
    for path in made:
        document = Document(path)
        assert EVIL in document.text
        assert "img" not in [name for name, _ in document.elements]


def test_events_are_listed_in_order_and_marked_apart(step):
    told = happened(step.run, step.landing)
    assert [kind for _, kind, _ in told] == [e.kind for e in step.landing.events]
    assert [at for at, _, _ in told] == sorted(at for at, _, _ in told)
    named = marks(step.run, step.landing)
    assert {"departure", "landing"} <= {mark.label for mark in named}
    at = [mark.at for mark in named]
    assert all(b - a > 0.03 * step.landing.t[-1] for a, b in pairwise(at))
    assert {kind for _, kind, _ in happened(step.run, None)} == {"lift-off", "landing"}
    assert happened(None, None) == [] and marks(None, None) == ()


@pytest.mark.parametrize(("incline", "heading"), [(0.0, 0.0), (0.5, 0.0), (-0.4, 0.7)])
def test_world_axes_have_gravity_down(incline, heading):
    site = Site(2.0, incline, heading)
    W = world(site)
    np.testing.assert_allclose(W @ W.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(W) == pytest.approx(1.0)
    np.testing.assert_allclose(W @ site.vector, [0, 0, -2.0], atol=1e-12)
    assert W[0] @ [1.0, 0, 0] > 0 and abs(W[0] @ site.vector) < 1e-12


def test_the_animated_body_turns_about_its_edge(step):
    made, plan = scene(step.plan, step.run, None), step.plan
    k, W, frame = made["frames"], world(plan.site), plan.frame
    track_ = {key: decoded(text, k, -1) for key, text in made["plan"].items()}
    spikes = track_["centre"][:, None] + plan.rover.chassis.vertices @ track_["turn"].reshape(
        k, 3, 3
    ).transpose(0, 2, 1)
    a, b = frame.spikes
    half = frame.length / 2 * W[:, 1]
    np.testing.assert_allclose(spikes[:, a], np.broadcast_to(-half, (k, 3)), atol=1e-6)
    np.testing.assert_allclose(spikes[:, b], np.broadcast_to(half, (k, 3)), atol=1e-6)
    p = W[:, 2]
    heights = spikes @ p
    assert np.abs(heights[0, list(plan.rover.chassis.faces[frame.start_face])]).max() < 1e-6
    assert np.abs(heights[-1, list(plan.rover.chassis.faces[frame.end_face])]).max() < 1e-4
    assert heights.min() > -1e-4
    moved = Rotation.from_rotvec(W[:, 1] * track_["theta"][k // 2, 0])
    np.testing.assert_allclose(spikes[k // 2], moved.apply(spikes[0]), atol=1e-3)


def test_the_animated_landing_is_that_of_the_simulation(step):
    made, landing = scene(step.plan, step.run, step.landing), step.landing
    k, W = made["frames"], world(step.plan.site)
    track_ = {key: decoded(text, k, -1) for key, text in made["result"].items()}
    t = np.linspace(0.0, made["to"], k)
    spikes = track_["centre"][:, None] + step.plan.rover.chassis.vertices @ track_["turn"].reshape(
        k, 3, 3
    ).transpose(0, 2, 1)
    there = landing.spikes @ W.T
    for i in range(4):
        for axis in range(3):
            truth = np.interp(t, landing.t, there[:, i, axis])
            np.testing.assert_allclose(spikes[:, i, axis], truth, atol=2e-4)
    resting = track_["force"][-1].reshape(4, 3).sum(axis=0)
    np.testing.assert_allclose(resting, [0, 0, 1.0], atol=0.05)  # the ground carries the weight


def test_torques_in_the_charts(step):
    plan, run = step.plan, step.run
    theta = np.linspace(0.0, plan.frame.turn, 50)
    com = np.array([plan.frame.rotation(angle) @ -plan.frame.point for angle in theta])
    potential = -plan.rover.mass * com @ plan.site.vector
    slope = np.gradient(potential, theta, edge_order=2)
    np.testing.assert_allclose(-gravity(plan, theta), slope, atol=0.05)
    model = step_model(plan.rover, plan.frame, plan.site)._replace(A=(0.0, 0.0, 0.0))
    state = dynamics.State(run.theta, run.theta_dot, run.delta, run.delta_dot, run.delta_ddot)
    T = dynamics.cmg_torque(model, state, run.theta_ddot)
    exact = -dynamics.dot(T, dynamics.along(model, run.delta, 1))
    np.testing.assert_allclose(drive(plan, run), exact, atol=1e-9)


def test_charts_of_a_step(step):
    panels = {panel.key: panel for panel in step_panels(step.plan, step.run, step.landing)}
    names = [curve.label for curve in panels["theta"].curves]
    assert names == ["closed loop", "on the ground", "plan"]
    dashes = {curve.label: curve.dash for curve in panels["theta"].curves}
    assert dashes == {"plan": "dash", "closed loop": "solid", "on the ground": "solid"}
    for key in ("theta", "delta_dot"):
        curve = panels[key].curves[0]
        np.testing.assert_array_equal(curve.y, np.degrees(getattr(step.run, key)))
    assert {"error", "margin", "load", "drive"} <= set(panels)
    assert "load" not in {panel.key for panel in step_panels(step.plan, step.run, None)}


def test_the_scene_of_a_mission(trip):
    rover, made = peter(), mission_scene(trip.travel, trip.field, peter())
    n = trip.travel.steps
    assert made["steps"] == n and made["to"] == n and len(made["left"]) == n
    np.testing.assert_allclose(
        decoded(made["corners"], n + 1, 3, 3), trip.travel.corners, atol=1e-5
    )
    assert made["way"][0] == 0 and made["way"][-1] == pytest.approx(trip.travel.distance)
    assert made["energy"][-1] == pytest.approx(trip.travel.step_energy)
    weights = np.array(made["gimbal"])
    assert weights.sum() == pytest.approx(0, abs=1e-12)
    np.testing.assert_allclose(weights @ rover.chassis.vertices, rover.cmg.gimbal_axis, atol=1e-12)
    ground = made["ground"]
    heights = decoded(ground["heights"], ground["rows"], ground["columns"])
    np.testing.assert_allclose(heights, trip.field.heights, atol=1e-5)
    assert mission_scene(trip.travel, trip.field, None)["gimbal"] is None


def test_large_ground_is_thinned_and_holes_stay(trip):
    z = np.zeros((400, 300))
    z[100:200, 50:80] = np.nan
    ground = mission_scene(trip.travel, HeightField(z, 0.1), None)["ground"]
    heights = decoded(ground["heights"], ground["rows"], ground["columns"])
    assert max(heights.shape) <= 97 and np.isnan(heights).any() and (heights[0] == 0).all()


@pytest.mark.parametrize(("span", "wanted"), [(2.88, 0.5), (0.1, 0.01), (37.0, 5.0), (0.0, 1e-4)])
def test_contours_are_at_round_heights(span, wanted):
    assert contour(np.array([0.0, span])) == pytest.approx(wanted)


def test_a_mission_without_a_step(tmp_path, trip):
    field = trip.field
    stays = travel(field, peter(), (4.0, 4.0), (4.0, 4.0), cost=alike)
    assert stays.steps == 0
    document = Document(write_mission_report(tmp_path / "a.html", stays, field, peter()))
    assert "0 steps" in document.text and document.open == []


# --- in a browser ---


@pytest.fixture(scope="module")
def browser():
    playwright = pytest.importorskip("playwright.sync_api")
    if CHROMIUM is None:
        pytest.skip("no chromium on this machine")
    with playwright.sync_playwright() as driver:
        running = driver.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        yield running
        running.close()


@pytest.fixture(scope="module")
def files(tmp_path_factory, step, trip):
    folder = tmp_path_factory.mktemp("pages")
    return {
        "step": write_step_report(folder / "step.html", step.plan, step.run, step.landing),
        "mission": write_mission_report(folder / "trip.html", trip.travel, trip.field, peter()),
    }


def opened(browser, path, width=1280, **more):
    page = browser.new_page(viewport={"width": width, "height": 900}, **more)
    said, asked = [], []
    page.on("console", lambda message: said.append(message.text))
    page.on("pageerror", lambda error: said.append(str(error)))
    page.on("request", lambda request: asked.append(request.url))
    page.goto(path.as_uri())
    until(page, "document.getElementById('scene-says').textContent !== ''")
    return page, said, asked


def until(page, true):
    """Wait for a condition; the page's own policy forbids the driver to watch for it."""
    for _ in range(100):
        if page.evaluate(true):
            return
        page.wait_for_timeout(50)
    pytest.fail(f"never came true: {true}")


def clock(page):
    return float(page.evaluate("document.getElementById('clock').value"))


@pytest.mark.browser
@pytest.mark.parametrize("kind", ["step", "mission"])
@pytest.mark.parametrize("width", [390, 1280])
def test_it_draws_quietly_and_fits(browser, files, kind, width):
    page, said, asked = opened(browser, files[kind], width)
    assert asked == [files[kind].as_uri()] and said == []
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    colours = """() => { const c = document.getElementById('scene');
        const d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data, s = new Set();
        for (let i = 0; i < d.length; i += 4) s.add(d[i] << 16 | d[i + 1] << 8 | d[i + 2]);
        return s.size; }"""
    assert page.evaluate(colours) > 100
    for look in page.locator("[data-look]").all():
        look.click()
    assert said == []
    page.close()


@pytest.mark.browser
@pytest.mark.parametrize("kind", ["step", "mission"])
def test_keys_move_it_and_the_charts_follow(browser, files, kind):
    page, said, _ = opened(browser, files[kind])
    place = "[...document.querySelectorAll('.cursor')].map(c => parseFloat(c.style.left))"
    shown = "document.getElementById('cursor-time').textContent"
    until(page, f"parseFloat({shown}) === 0")
    left = page.evaluate(place)[0]
    assert page.evaluate(place) == pytest.approx([left] * len(page.evaluate(place)))
    page.keyboard.press("ArrowRight")
    first = clock(page)
    assert first > 0
    page.keyboard.press("Shift+ArrowRight")
    assert clock(page) > first + 0.5
    until(page, f"{place}.every(x => x > {left + 5})")
    now = clock(page)
    page.keyboard.press("Space")
    until(page, f"document.getElementById('clock').value > {now + 0.3}")
    assert page.inner_text("#play") == "Pause"
    page.keyboard.press("Space")
    assert page.inner_text("#play") == "Play"
    page.focus("#clock")
    page.keyboard.press("End")
    assert clock(page) == pytest.approx(float(page.get_attribute("#clock", "max")))
    plot = page.locator(".plot").first
    plot.scroll_into_view_if_needed()
    box = plot.bounding_box()
    page.mouse.move(box["x"] + box["width"] / 2, box["y"] + 100)
    until(
        page, "document.getElementById('clock').value < document.getElementById('clock').max * .8"
    )
    assert said == []
    page.close()


@pytest.mark.browser
def test_an_event_goes_to_its_instant(browser, files, step):
    page, _, _ = opened(browser, files["step"])
    page.locator("[data-at]").last.click()
    assert clock(page) == pytest.approx(step.landing.events[-1].t, abs=1e-3)
    page.close()


@pytest.mark.browser
def test_who_wants_less_motion_sees_stills(browser, files):
    page, _, _ = opened(browser, files["step"], reduced_motion="reduce")
    page.keyboard.press("Space")
    page.wait_for_timeout(500)
    assert clock(page) == 0
    until(page, "document.getElementById('clock').value > 0.3")
    page.close()
