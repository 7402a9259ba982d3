"""The atlas in a real browser: drawn soon, without a request, by keys alone, and true."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

import nullmotion as nm
from nullmotion import sim
from nullmotion.plot.atlas_view import Ball, Motion, Scene, scene
from nullmotion.report import page, run_report
from nullmotion.report.atlas import Atlas
from nullmotion.report.charts import Charts

pytestmark = pytest.mark.browser

ARRAY = nm.layouts.pyramid(skew=np.radians(54.73))
BALLS = (
    Ball("omnidirectional", "Largest reachable ball", 2.5, "#008a65", "solid"),
    Ball("impassable", "Nearest impassable point", 1.155, "#a3230a", "dash"),
)
TIMES = np.linspace(0.0, 8.0, 200)
TURNED = np.stack([np.sin(TIMES * f) for f in (0.3, 0.5, 0.7, 0.9)], axis=1)
SURFACE = "#atlas-space canvas:nth-of-type(2)"
SLOWEST_S = 3.0


def written(path: Path, shown: Scene) -> Path:
    atlas = Atlas(shown)
    parts = [atlas.section()]
    path.write_text(page.document("Atlas", parts, Charts(), page.versions(), *atlas.extras()))
    return path


@pytest.fixture(scope="module")
def atlas_file(tmp_path_factory) -> Path:
    sigma = np.linalg.svd(ARRAY.unit_jacobian(TURNED), compute_uv=False)[:, -1]
    turning = Motion("turning", TIMES, TURNED, ARRAY.momentum(TURNED), sigma)
    still = Motion("still", TIMES, 0 * TURNED, 0 * ARRAY.momentum(TURNED), colour="#0072b2")
    shown = scene(ARRAY, balls=BALLS, motions=(turning, still))
    return written(tmp_path_factory.mktemp("atlas") / "atlas.html", shown)


def told(page, key: str) -> str:
    return page.locator(f'[data-told="{key}"]').inner_text().replace("−", "-")


def numbers(text: str) -> list[float]:
    return [float(v) for v in re.findall(r"-?\d+(?:\.\d+)?(?:e-?\d+)?", text)]


def settled(page) -> None:
    page.wait_for_timeout(350)


def drawing(page, canvas: str = SURFACE) -> np.ndarray:
    """The pixels of a picture, coarse, (k, 4)."""
    settled(page)
    values = page.locator(canvas).evaluate(
        """canvas => {
          const small = document.createElement("canvas");
          small.width = 96; small.height = 96;
          const context = small.getContext("2d");
          context.drawImage(canvas, 0, 0, 96, 96);
          return [...context.getImageData(0, 0, 96, 96).data];
        }"""
    )
    return np.array(values, float).reshape(-1, 4)


def differ(one: np.ndarray, other: np.ndarray) -> float:
    return float(np.abs(one - other).mean())


@pytest.mark.parametrize("width", [390, 1280])
def test_it_is_drawn_soon_quietly_and_fits(opened, atlas_file, width):
    assert atlas_file.stat().st_size < 8_000_000
    page = opened(atlas_file, width)
    drawn = page.evaluate("performance.getEntriesByName('atlas-drawn')[0].startTime")
    assert drawn < 1000 * SLOWEST_S
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    picture = drawing(page)
    assert 0.2 < (picture[:, 3] > 0).mean() < 0.9
    for box in page.locator("#atlas canvas").all():
        if box.is_visible():
            assert box.bounding_box()["width"] <= width


def test_types_are_switched_by_the_space_key(opened, atlas_file):
    page = opened(atlas_file)
    elliptic, hyperbolic = (
        page.get_by_role("checkbox", name=n) for n in ("Elliptic", "Hyperbolic")
    )
    whole = drawing(page)
    reds = lambda seen: ((seen[:, 0] > seen[:, 2] + 40) & (seen[:, 3] > 100)).sum()  # noqa: E731
    assert reds(whole) > 200
    elliptic.focus()
    page.keyboard.press("Space")
    assert not elliptic.is_checked()
    without = drawing(page)
    assert reds(without) == 0
    hyperbolic.focus()
    page.keyboard.press("Space")
    page.get_by_role("checkbox", name="Saturation").focus()
    page.keyboard.press("Space")
    assert drawing(page)[:, 3].max() == 0
    for name in ("Elliptic", "Hyperbolic", "Saturation"):
        page.get_by_role("checkbox", name=name).focus()
        page.keyboard.press("Space")
    assert differ(drawing(page), whole) < 1.0


def test_sign_patterns_are_switched_together_and_each(opened, atlas_file):
    page = opened(atlas_file)
    whole = drawing(page)
    group = page.get_by_role("checkbox", name="1 minus (4)")
    group.focus()
    page.keyboard.press("Space")
    fewer = drawing(page)
    assert differ(fewer, whole) > 2
    page.locator("summary", has_text="Each pattern").click()
    single = page.get_by_role("checkbox", name="+−++", exact=True)
    assert not single.is_checked()
    single.focus()
    page.keyboard.press("Space")
    assert group.evaluate("box => box.indeterminate")
    assert differ(drawing(page), fewer) > 0.3


def test_the_time_slider_turns_array_and_momentum(opened, atlas_file):
    page = opened(atlas_file)
    assert "turning, t = 0 s" in told(page, "source")
    rotors = drawing(page, "#atlas-array canvas")
    slider = page.locator("#atlas-time")
    slider.focus()
    for _ in range(100):
        page.keyboard.press("ArrowRight")
    time = 0.1 * TIMES[-1]
    assert numbers(told(page, "source"))[0] == pytest.approx(time)
    delta = np.array([np.interp(time, TIMES, column) for column in TURNED.T])
    np.testing.assert_allclose(numbers(told(page, "momentum")), ARRAY.momentum(delta), atol=1e-3)
    np.testing.assert_allclose(numbers(told(page, "angles")), np.degrees(delta), atol=0.06)
    sigma = np.linalg.svd(ARRAY.unit_jacobian(delta), compute_uv=False)[-1]
    assert numbers(told(page, "sigma"))[0] == pytest.approx(sigma, abs=2e-4)
    assert differ(drawing(page, "#atlas-array canvas"), rotors) > 0.5
    page.keyboard.press("End")
    assert numbers(told(page, "source"))[0] == pytest.approx(TIMES[-1])
    assert slider.get_attribute("aria-valuetext") == "8 s"
    page.locator("#atlas-motion").select_option("1")
    assert numbers(told(page, "momentum")) == [0, 0, 0]


def test_play_runs_to_the_end_and_stops(opened, atlas_file):
    page = opened(atlas_file)
    page.evaluate("document.getElementById('atlas-time').value = 990")
    page.locator("#atlas-time").dispatch_event("input")
    button = page.locator("#atlas-play")
    button.focus()
    page.keyboard.press("Space")
    page.wait_for_function("() => document.getElementById('atlas-time').value === '1000'")
    page.wait_for_function("() => document.getElementById('atlas-play').textContent === 'Play'")


def test_gimbals_are_turned_by_keys(opened, atlas_file):
    page = opened(atlas_file)
    first = page.locator("[data-gimbal]").first
    first.focus()
    page.keyboard.press("Home")
    page.locator("[data-gimbal]").nth(2).focus()
    page.keyboard.press("End")
    for _ in range(3):
        page.keyboard.press("ArrowLeft")
    delta = np.radians(numbers(told(page, "angles")))
    assert abs(delta[0]) == pytest.approx(np.pi) and delta[2] == pytest.approx(np.radians(179.7))
    np.testing.assert_allclose(numbers(told(page, "momentum")), ARRAY.momentum(delta), atol=1e-3)
    sigma = np.linalg.svd(ARRAY.unit_jacobian(delta), compute_uv=False)[-1]
    assert numbers(told(page, "sigma"))[0] == pytest.approx(sigma, abs=1e-4)
    assert told(page, "source") == "set by hand"


@pytest.mark.parametrize(
    ("signs", "azimuth", "elevation"), [("−+++", 20, 10), ("++−−", -35, 48), ("++++", 70, -30)]
)
def test_a_singular_point_is_one(opened, atlas_file, signs, azimuth, elevation):
    page = opened(atlas_file)
    page.locator("#atlas-sheet").select_option(signs)
    for name, value in (("azimuth", azimuth), ("elevation", elevation)):
        page.locator(f"#atlas-{name}").evaluate(f"input => {{ input.value = {value}; }}")
        page.locator(f"#atlas-{name}").dispatch_event("input")
    page.locator("#atlas-visit").focus()
    page.keyboard.press("Space")
    assert "singular" in told(page, "sigma") and numbers(told(page, "sigma"))[0] < 1e-6
    a, e = np.radians([azimuth, elevation])
    u = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
    sign = np.array([1.0 if s == "+" else -1.0 for s in signs])
    found = nm.atlas.singular_points(ARRAY, u, sign)
    np.testing.assert_allclose(numbers(told(page, "angles")), np.degrees(found.delta), atol=0.06)
    np.testing.assert_allclose(numbers(told(page, "momentum")), found.momentum, atol=1e-3)
    kind = nm.singularity.classify(ARRAY, found.delta)
    assert told(page, "point").lower().startswith(str(kind))


def test_pointing_at_a_surface_turns_the_gimbals_there(opened, atlas_file):
    page = opened(atlas_file)
    settled(page)
    box = page.locator("#atlas-space").bounding_box()
    page.mouse.click(box["x"] + 0.5 * box["width"], box["y"] + 0.35 * box["height"])
    page.wait_for_function(
        "() => document.querySelector('[data-told=source]').textContent.includes('singular')"
    )
    assert numbers(told(page, "sigma"))[0] < 1e-6
    u = np.array(numbers(told(page, "point").partition("u = ")[2])[:3])
    assert np.linalg.norm(u) == pytest.approx(1, abs=2e-3)


def test_a_plane_cuts_the_surfaces(opened, atlas_file):
    page = opened(atlas_file)
    whole = drawing(page)
    slice_ = page.locator("#atlas-slice canvas")
    assert not slice_.is_visible()
    page.locator("#atlas-plane").select_option("0")
    assert slice_.is_visible()
    half = drawing(page)
    assert (half[:, 3] > 0).sum() < 0.8 * (whole[:, 3] > 0).sum()
    middle = drawing(page, "#atlas-slice canvas")
    page.locator("#atlas-offset").focus()
    for _ in range(40):
        page.keyboard.press("ArrowRight")
    assert differ(drawing(page, "#atlas-slice canvas"), middle) > 1
    assert "N m s" in page.locator("#atlas-offset").get_attribute("aria-valuetext")
    page.locator("#atlas-plane").select_option("view")
    assert drawing(page, "#atlas-slice canvas")[:, 3].max() > 0
    page.locator("#atlas-plane").select_option("none")
    assert not slice_.is_visible()
    assert differ(drawing(page), whole) < 1.0


def test_the_view_is_turned_by_keys_buttons_and_dragging(opened, atlas_file):
    page = opened(atlas_file)
    page.mouse.move(5, 5)
    home = drawing(page)
    page.locator("#atlas-space").focus()
    page.keyboard.press("ArrowLeft")
    page.keyboard.press("ArrowUp")
    page.keyboard.press("+")
    turned = drawing(page)
    assert differ(turned, home) > 3
    page.keyboard.press("Home")
    assert differ(drawing(page), home) < 0.5
    page.get_by_role("button", name="Turn right").click()
    assert differ(drawing(page), home) > 2
    page.get_by_role("button", name="Reset view").click()
    assert differ(drawing(page), home) < 0.5
    box = page.locator("#atlas-space").bounding_box()
    page.mouse.move(box["x"] + 200, box["y"] + 200)
    page.mouse.down()
    page.mouse.move(box["x"] + 320, box["y"] + 240, steps=4)
    page.mouse.up()
    assert differ(drawing(page), home) > 3
    assert "t = 0 s" in told(page, "source")  # dragging is not pointing


def test_everything_is_reached_by_the_tab_key(opened, atlas_file):
    page = opened(atlas_file)
    page.locator("summary", has_text="Each pattern").click()
    page.locator("#atlas-plane").select_option("2")
    wanted = page.evaluate(
        """() => { const all = [...document.querySelectorAll(
             '#atlas input, #atlas select, #atlas button, #atlas summary, #atlas [tabindex="0"]')];
           all.forEach((one, i) => { one.dataset.place = i; }); return all.length; }"""
    )
    page.evaluate("document.activeElement.blur(); window.getSelection().collapse(document.body, 0)")
    met = set()
    for _ in range(wanted + 5):
        page.keyboard.press("Tab")
        met.add(page.evaluate("document.activeElement.dataset.place ?? null"))
    assert len(met - {None}) == wanted
    unnamed = page.evaluate(
        """() => [...document.querySelectorAll('#atlas input, #atlas select, #atlas button')]
             .filter(e => !e.getAttribute('aria-label') && !e.labels?.length)
             .filter(e => !e.textContent.trim()).map(e => e.outerHTML)"""
    )
    assert unnamed == []


def test_a_graphics_card_draws_the_same(opened, atlas_file):
    page = opened(atlas_file)
    by_hand = page.locator("#atlas").get_attribute("data-drawn")
    settled(page)
    where = page.locator("#atlas-space").bounding_box()
    one = page.screenshot(clip=where)
    card = opened(atlas_file, fragment="#webgl", quiet=False)
    if card.locator("#atlas").get_attribute("data-drawn") != "webgl":
        pytest.skip("this browser has no WebGL 2")
    card.wait_for_timeout(3000)
    other = card.screenshot(clip=where)
    pixels = [_coarse(page, picture) for picture in (one, other)]
    assert differ(*pixels) < 6
    assert by_hand in ("raster", "webgl")


def _coarse(page, picture: bytes) -> np.ndarray:
    import base64

    values = page.evaluate(
        """async coded => {
          const image = new Image();
          image.src = "data:image/png;base64," + coded;
          await image.decode();
          const small = document.createElement("canvas");
          small.width = 64; small.height = 64;
          const context = small.getContext("2d");
          context.drawImage(image, 0, 0, 64, 64);
          return [...context.getImageData(0, 0, 64, 64).data];
        }""",
        base64.b64encode(picture).decode(),
    )
    return np.array(values, float).reshape(-1, 4)


@pytest.mark.parametrize(
    "array",
    [
        nm.layouts.planar(n=5),
        nm.layouts.scissored_pairs(),
        nm.layouts.roof6(),
        nm.layouts.box90(h0=[1.0, 2.0, 0.5, 1.5]),
        nm.layouts.pyramid().without(1, 0.3),
        nm.layouts.pyramid(n=8),
    ],
    ids=["planar", "pairs", "roof6", "unequal", "failed", "eight"],
)
def test_other_arrays_are_drawn(opened, tmp_path, array):
    page = opened(written(tmp_path / "atlas.html", scene(array)))
    assert told(page, "source") == "set by hand"
    np.testing.assert_allclose(
        numbers(told(page, "momentum")), array.momentum(np.zeros(array.n)), atol=1e-3
    )
    canvas = SURFACE if array.m == 3 else "#atlas-slice canvas"
    assert (drawing(page, canvas)[:, 3] > 0).mean() > 0.05


def test_time_is_shared_with_the_charts_of_a_run(opened, tmp_path):
    setup = sim.Setup(
        nm.layouts.pyramid(rate_limit=np.pi),
        nm.laws.create("pseudo-inverse"),
        np.zeros(4),
        np.array([1.0, 1.0, 1.0]),
        steps=150,
    )
    page = opened(run_report(sim.run(setup), tmp_path / "run.html", "Run"))
    page.wait_for_selector("[data-chart] .main-svg")
    page.wait_for_function("() => document.getElementById('atlas-clock').textContent === '1.5 s'")
    page.locator("#atlas-time").focus()
    page.keyboard.press("Home")
    page.wait_for_function("() => document.getElementById('cursor-time').textContent === '0 s'")
    page.locator("#cursor").focus()
    page.keyboard.press("End")
    page.wait_for_function("() => document.getElementById('atlas-clock').textContent === '1.5 s'")
