"""Torque in the atlas, in a real browser: maps, colours, flat pieces, numbers to take away."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

import nullmotion as nm
from nullmotion import sim
from nullmotion.atlas.torque import TorqueMap
from nullmotion.plot.atlas_runs import motion
from nullmotion.plot.atlas_view import scene
from nullmotion.report import page as pages
from nullmotion.report.atlas_numbers import Number
from nullmotion.report.atlas_page import atlas_page
from nullmotion.report.markup import tag

pytestmark = pytest.mark.browser

ARRAY = nm.layouts.pyramid(skew=np.radians(54.73), rate_limit=1.0)
SIDE = 41
SLOWEST_S, LARGEST = 3.0, 8_000_000
NUMBERS = (
    Number("Omnidirectional momentum", 2.5214159265, 2.5229, "N m s", 1.0, "In every direction"),
    Number("Tiny", -1.25e-5, None, "N m s", 1.0, "A number that needs a power of ten"),
)


def stand_in(array, normal, rng, side=SIDE) -> TorqueMap:
    """A map of made-up numbers over a plane through the middle."""
    axis = int(np.argmax(normal))
    basis = np.eye(3)[[k for k in range(3) if k != axis]]
    x = np.linspace(-3.3, 3.3, side)
    out = np.hypot(*np.meshgrid(x, x)) > 3.1
    capability = np.where(out, np.nan, rng.uniform(0, 1.3, (side, side)))
    delta = np.where(out[..., None], np.nan, rng.uniform(-np.pi, np.pi, (side, side, array.n)))
    return TorqueMap(
        basis=basis, origin=np.zeros(3), x=x, y=x, capability=capability, delta=delta,
        sigma_min=capability, title="made up", method="pseudo-inverse",
    )  # fmt: skip


@pytest.fixture(scope="module")
def maps(request):
    rng = np.random.default_rng(8)
    return tuple(stand_in(ARRAY, axis, rng, 81) for axis in np.eye(3))


@pytest.fixture(scope="module")
def whole_file(tmp_path_factory, maps) -> Path:
    """All that a page of an analysis can have: maps, a run, further tables."""
    setup = sim.Setup(
        ARRAY, nm.laws.create("sr"), np.zeros(4), np.array([0.2, 0.1, 0.0]), dt=0.01, steps=1000
    )
    run = sim.run(setup)
    shown = scene(ARRAY, motions=[motion(run, "sr")], maps=maps)
    more = [pages.section("State", tag("p", "somewhere"), id="state")]
    path = tmp_path_factory.mktemp("whole") / "atlas.html"
    return atlas_page(path, "Atlas", shown, tag("h1", "Head"), NUMBERS, run, "[array]", more)


@pytest.fixture(scope="module")
def plain_file(tmp_path_factory, maps) -> Path:
    shown = scene(ARRAY, maps=maps)
    path = tmp_path_factory.mktemp("plain") / "atlas.html"
    return atlas_page(path, "Atlas", shown, tag("h1", "Head"), NUMBERS)


def said(page, selector: str) -> str:
    return page.locator(selector).inner_text().replace("−", "-")


def numbers(text: str) -> list[float]:
    return [float(v) for v in re.findall(r"-?\d+(?:\.\d+)?(?:e-?\d+)?", text)]


def turned(page) -> np.ndarray:
    return np.array(numbers(said(page, '[data-told="angles"]')))


def picture(page, canvas: str) -> np.ndarray:
    page.wait_for_timeout(350)
    values = page.locator(canvas).evaluate(
        """canvas => {
          const small = document.createElement("canvas");
          small.width = 64; small.height = 64;
          const context = small.getContext("2d");
          context.drawImage(canvas, 0, 0, 64, 64);
          return [...context.getImageData(0, 0, 64, 64).data];
        }"""
    )
    return np.array(values, float).reshape(-1, 4)


@pytest.mark.parametrize("width", [390, 768, 1280])
def test_a_whole_page_is_small_drawn_soon_and_fits(opened, whole_file, width):
    assert whole_file.stat().st_size < LARGEST
    page = opened(whole_file, width)
    drawn = page.evaluate("performance.getEntriesByName('atlas-drawn')[0].startTime")
    assert drawn < 1000 * SLOWEST_S
    page.wait_for_selector("[data-chart] .main-svg")
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    for part in page.locator("#torque canvas, #numbers .scroll").all():
        assert part.bounding_box()["width"] <= width


def test_links_lead_to_every_section_by_keys(opened, whole_file):
    page = opened(whole_file)
    links = page.locator("nav.links a")
    there = [link.get_attribute("href") for link in links.all()]
    assert there == ["#atlas", "#torque", "#numbers", "#state", "#history", "#file"]
    links.nth(2).focus()
    page.keyboard.press("Enter")
    page.wait_for_function("() => location.hash === '#numbers'")
    top = page.locator("#numbers").bounding_box()["y"]
    assert -1 <= top < 450
    page.keyboard.press("Tab")  # the table's box, then the button
    page.keyboard.press("Tab")
    assert page.evaluate("document.activeElement.textContent") == "Copy table"


def test_a_map_is_read_and_used_by_keys(opened, plain_file, maps):
    page = opened(plain_file)
    view = page.locator('[data-map="map-2"]')
    view.focus()
    page.keyboard.press("Home")
    for key in ("ArrowRight", "ArrowRight", "ArrowRight", "Shift+ArrowUp", "ArrowDown"):
        page.keyboard.press(key)
    shown, row, column = maps[2], 40 + 4, 40 + 3
    told = said(page, '[data-map-told="map-2"]')
    h = shown.x[column] * shown.basis[0] + shown.y[row] * shown.basis[1]
    np.testing.assert_allclose(numbers(told)[:3], h, atol=6e-4)
    assert numbers(told)[3] == pytest.approx(shown.capability[row, column], rel=1e-3)
    assert "N m in every direction" in told
    before = turned(page)
    page.keyboard.press("Enter")
    expected = np.degrees(shown.delta[row, column])
    assert not np.allclose(before, expected, atol=1)
    np.testing.assert_allclose(turned(page), expected, atol=0.06)
    assert said(page, '[data-told="source"]') == "best torque at this momentum"
    for _ in range(20):
        page.keyboard.press("Shift+ArrowRight")
    for _ in range(20):
        page.keyboard.press("Shift+ArrowUp")
    assert "cannot be reached" in said(page, '[data-map-told="map-2"]')
    page.keyboard.press(" ")
    np.testing.assert_allclose(turned(page), expected, atol=0.06)


def test_pointing_at_a_map_tells_and_clicking_turns(opened, plain_file, maps):
    page = opened(plain_file)
    view = page.locator('[data-map="map-0"]')
    view.scroll_into_view_if_needed()
    box, before = view.bounding_box(), turned(page)
    place = (box["x"] + 0.55 * box["width"], box["y"] + 0.4 * box["height"])
    page.mouse.move(*place)
    told = numbers(said(page, '[data-map-told="map-0"]'))
    shown = maps[0]
    column, row = (int(np.abs(axis - told[k]).argmin()) for axis, k in ((shown.x, 1), (shown.y, 2)))
    assert told[3] == pytest.approx(shown.capability[row, column], rel=1e-3)
    np.testing.assert_array_equal(turned(page), before)
    page.mouse.click(*place)
    expected = np.degrees(shown.delta[row, column])
    np.testing.assert_allclose(turned(page), expected, atol=0.06)


def test_a_map_shows_its_colours_and_the_lines_that_are_on(opened, plain_file):
    page = opened(plain_file)
    canvas = '[data-map="map-1"] canvas:first-of-type'
    with_lines = picture(page, canvas)
    yellow = (with_lines[:, 0] > 170) & (with_lines[:, 1] > 190) & (with_lines[:, 2] < 110)
    dark = (with_lines[:, :3].sum(axis=1) < 260) & (with_lines[:, 3] > 250)
    assert yellow.sum() > 30 and dark.sum() > 30
    for name in ("Elliptic", "Hyperbolic", "Saturation"):
        page.get_by_role("checkbox", name=name).uncheck()
    assert np.abs(picture(page, canvas) - with_lines).mean() > 1


def test_surfaces_are_coloured_by_torque(opened, plain_file):
    page = opened(plain_file)
    surface, scale = "#atlas-space canvas:nth-of-type(2)", page.locator("#atlas-scale")
    by_type = picture(page, surface)
    assert not scale.is_visible()
    page.locator("#atlas-colour").focus()
    page.keyboard.press("ArrowDown")
    assert scale.is_visible()
    by_torque = picture(page, surface)
    assert np.abs(by_torque - by_type).mean() > 5
    red, green, blue, opaque = by_torque.T
    orange = (red > green + 40) & (red > blue + 40) & (opaque > 100)
    assert orange.sum() == 0  # the colours of types are gone
    ticks = numbers(said(page, "#atlas-scale .ticks"))
    left = np.linalg.svd(
        ARRAY.unit_jacobian(nm.atlas.surfaces(ARRAY, 3000)[0].delta), compute_uv=False
    )[:, 1]
    assert min(ticks) >= 0.9 * left.min() and max(ticks) <= left.max() * 1.001
    page.locator("#atlas-plane").select_option("1")
    cut = picture(page, "#atlas-slice canvas")
    page.locator("#atlas-colour").select_option("type")
    assert np.abs(picture(page, "#atlas-slice canvas") - cut).mean() > 0.5
    page.locator("#atlas-plane").select_option("none")
    assert np.abs(picture(page, surface) - by_type).mean() < 1


def test_a_graphics_card_colours_by_torque_as_well(opened, plain_file):
    page = opened(plain_file)
    card = opened(plain_file, fragment="#webgl", quiet=False)
    if card.locator("#atlas").get_attribute("data-drawn") != "webgl":
        pytest.skip("this browser has no WebGL 2")
    for one in (page, card):
        one.locator("#atlas-colour").select_option("left")
    card.wait_for_timeout(3000)
    surface = "#atlas-space canvas:nth-of-type(2)"
    page.wait_for_timeout(300)
    shots = [one.locator(surface).screenshot() for one in (page, card)]
    small = [_coarse(page, shot) for shot in shots]
    assert np.abs(small[0] - small[1]).mean() < 6


def _coarse(page, shot: bytes) -> np.ndarray:
    import base64

    values = page.evaluate(
        """async coded => {
          const image = new Image();
          image.src = "data:image/png;base64," + coded;
          await image.decode();
          const small = document.createElement("canvas");
          small.width = 48; small.height = 48;
          const context = small.getContext("2d");
          context.drawImage(image, 0, 0, 48, 48);
          return [...context.getImageData(0, 0, 48, 48).data];
        }""",
        base64.b64encode(shot).decode(),
    )
    return np.array(values, float).reshape(-1, 4)


def test_a_flat_piece_is_pointed_at(opened, tmp_path):
    """From above, the top of a box-90 envelope is an annulus that no sheet has."""
    array = nm.layouts.box90()
    file = atlas_page(tmp_path / "a.html", "A", scene(array), tag("h1", "Head"), NUMBERS)
    page = opened(file)
    for name in ("Elliptic", "Hyperbolic", "Degenerate hyperbolic"):
        box = page.get_by_role("checkbox", name=re.compile(f"^{name}"))
        if box.count():
            box.uncheck()
    page.locator("#atlas-space").focus()
    for _ in range(25):
        page.keyboard.press("ArrowUp")
    page.wait_for_timeout(300)
    where = page.locator("#atlas-space").bounding_box()
    page.mouse.click(where["x"] + 0.5 * where["width"] + 25, where["y"] + 0.5 * where["height"])
    told = said(page, '[data-told="point"]')
    assert told.startswith("Saturation") and "Signs ○○++" in told
    delta = np.radians(turned(page))
    sigma = np.linalg.svd(array.unit_jacobian(delta), compute_uv=False)[-1]
    assert sigma < 2e-3  # angles are told to 0.1 deg
    h = numbers(said(page, '[data-told="momentum"]'))[:3]
    np.testing.assert_allclose(h, array.momentum(delta), atol=5e-3)
    assert abs(h[2]) == pytest.approx(2.0, abs=2e-3)


@pytest.mark.parametrize("allowed", [True, False])
def test_numbers_are_copied_by_keys(opened, plain_file, allowed):
    page = opened(plain_file)
    page.evaluate(
        """allowed => {
          window.taken = null;
          const put = async (text) => { if (!allowed) throw new Error("no"); window.taken = text; };
          Object.defineProperty(navigator, "clipboard", { value: { writeText: put } });
          document.addEventListener("copy", () => { window.taken = document.activeElement.value; });
        }""",
        allowed,
    )
    button = page.get_by_role("button", name="Copy table")
    button.focus()
    page.keyboard.press("Enter")
    page.wait_for_function("() => window.taken !== null")
    page.wait_for_function(
        "() => document.getElementById('atlas-table-copied').textContent === 'Copied.'"
    )
    rows = [row.split("\t") for row in page.evaluate("window.taken").split("\n")]
    assert rows[0][:4] == ["Quantity", "Lower bound", "Upper bound", "Unit"]
    assert rows[1][0] == "Omnidirectional momentum" and float(rows[1][1]) == 2.5214159265
    assert float(rows[2][1]) == -1.25e-5 and rows[2][2] == ""
    assert page.evaluate("document.activeElement.textContent") == "Copy table"


def test_numbers_are_copied_where_nothing_is_drawn(browser, tmp_path):
    file = atlas_page(tmp_path / "a.html", "A", None, tag("h1", "Head"), NUMBERS)
    page = browser.new_page()
    errors: list[str] = []
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.goto(file.as_uri())
    page.get_by_role("button", name="Copy table").click()
    page.wait_for_function("() => document.getElementById('atlas-table-copied').textContent !== ''")
    assert errors == []
    page.close()
