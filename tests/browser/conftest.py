"""A headless browser for the pages; tests are skipped where there is none."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

CHROMIUM = (
    shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
)


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    """The system's Chromium."""
    playwright = pytest.importorskip("playwright.sync_api", reason="playwright is not installed")
    if CHROMIUM is None:
        pytest.skip("no chromium on this machine")
    with playwright.sync_playwright() as driver:
        running = driver.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        yield running
        running.close()


@pytest.fixture
def opened(browser: Any) -> Iterator[Callable[..., Any]]:
    """Open a file; the page says nothing on the console and asks for nothing but itself."""
    pages: list[tuple[Any, ...]] = []

    def go(
        path: Path, width: int = 1280, height: int = 900, fragment: str = "", quiet: bool = True
    ) -> Any:
        page = browser.new_page(viewport={"width": width, "height": height})
        said: list[tuple[str, str]] = []
        asked: list[str] = []
        page.on("console", lambda message: said.append((message.type, message.text)))
        page.on("pageerror", lambda error: said.append(("error", str(error))))
        page.on("request", lambda request: asked.append(request.url))
        address = path.as_uri() + fragment

        def only_itself(route: Any) -> None:
            if route.request.url.partition("#")[0] == path.as_uri():
                route.continue_()
            else:
                route.abort()

        page.route("**/*", only_itself)
        page.goto(address)
        page.wait_for_selector("#atlas[data-drawn]")
        pages.append((page, said, asked, path.as_uri(), quiet))
        return page

    yield go
    for shown, said, asked, address, quiet in pages:
        assert [url.partition("#")[0] for url in asked] == [address]
        assert [entry for entry in said if quiet or entry[0] == "error"] == []
        shown.close()
