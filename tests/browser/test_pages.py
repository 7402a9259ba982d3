"""Pages in a real browser: they draw, ask for nothing, fit a phone, move together."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import nullmotion as nm
from nullmotion import sim
from nullmotion.report import run_report
from nullmotion.spacecraft import Event

pytestmark = pytest.mark.browser

RANGES = "[...document.querySelectorAll('[data-chart]')].map(c => c.layout.xaxis.range.map(Number))"


@pytest.fixture(scope="module")
def page_file(tmp_path_factory) -> Path:
    array = nm.layouts.pyramid(rate_limit=np.pi)
    setup = sim.Setup(
        array, nm.laws.create("pseudo-inverse"), np.zeros(4), np.array([1.0, 1.0, 1.0]), steps=150
    )
    return run_report(sim.run(setup), tmp_path_factory.mktemp("page") / "run.html", "Run", "[law]")


def opened(browser, path, width=1280, height=900):
    """Open a page; return it with what it said and asked for."""
    page = browser.new_page(viewport={"width": width, "height": height})
    said, asked = [], []
    page.on("console", lambda message: said.append(message.text))
    page.on("pageerror", lambda error: said.append(str(error)))
    page.on("request", lambda request: asked.append(request.url))
    page.goto(path.as_uri())
    page.wait_for_selector("[data-chart] .main-svg")
    return page, said, asked


@pytest.mark.parametrize("width", [390, 1280])
def test_it_draws_quietly_and_fits(browser, page_file, width):
    page, said, asked = opened(browser, page_file, width)
    assert asked == [page_file.as_uri()]
    drawn = page.evaluate("document.querySelectorAll('[data-chart] .scatterlayer .trace').length")
    assert drawn > 20
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    assert said == []
    page.close()


@pytest.fixture(scope="module")
def attitude_file(tmp_path_factory, slew) -> Path:
    faults = (Event("stuck", 1, 1.0, detected_after=0.5), Event("slow", 2, 3.0, rate_limit=0.1))
    required = {"name": "settling_time_s_below", "limit": 9.0, "value": None, "margin": None}
    file = tmp_path_factory.mktemp("page") / "attitude.html"
    run = slew(steps=100, events=faults)
    return run_report(run, file, "Slew", "", [{**required, "passed": False}])


@pytest.mark.parametrize("width", [390, 1280])
def test_a_page_of_an_attitude_draws_quietly_and_fits(browser, attitude_file, width):
    page, said, asked = opened(browser, attitude_file, width)
    assert asked == [attitude_file.as_uri()]
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    assert said == []
    error = page.locator("[data-chart=pointing_error]")
    assert error.locator(".yaxislayer-above text").count() >= 2
    inside = error.bounding_box()
    for name in error.locator(".annotation-text").all():
        box = name.bounding_box()
        assert inside["x"] <= box["x"] and box["x"] + box["width"] <= inside["x"] + inside["width"]
    page.close()


def test_zoom_and_cursor_are_shared(browser, page_file):
    page, said, _ = opened(browser, page_file)
    chart = page.locator("[data-chart=rates]")
    chart.scroll_into_view_if_needed()
    box = chart.bounding_box()
    page.mouse.move(box["x"] + 200, box["y"] + 100)
    page.wait_for_function("() => document.getElementById('cursor-time').textContent !== '1.5 s'")
    places = page.evaluate("[...document.querySelectorAll('.cursor')].map(c => c.style.left)")
    assert len(set(places)) == 1
    page.mouse.down()
    page.mouse.move(box["x"] + 350, box["y"] + 103, steps=5)
    page.mouse.up()
    page.wait_for_function(f"() => {RANGES}.every(r => r[0] > 0.1 && r[1] < 1.4)")
    assert np.ptp(page.evaluate(RANGES), axis=0).max() < 1e-9
    page.click("#reset")
    page.wait_for_function(f"() => {RANGES}.every(r => r[0] === 0)")
    assert said == []
    page.close()


def test_legend_works_from_the_keyboard(browser, page_file):
    page, _, _ = opened(browser, page_file)
    entry = page.locator(".legend button").first
    entry.focus()
    page.keyboard.press("Enter")
    page.wait_for_function(
        "() => document.querySelector('[data-chart=torque]').data[0].visible === false"
    )
    assert entry.get_attribute("aria-pressed") == "false"
    page.close()
