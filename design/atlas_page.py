"""How the atlas page compares with plotly on the same surfaces: size, first drawing, turning.

python design/atlas_page.py      # needs playwright and Chromium; the table of atlas_page.md
"""

from __future__ import annotations

import shutil
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import plotly.graph_objects as go
from playwright.sync_api import Page, sync_playwright

import nullmotion as nm
from nullmotion.plot.atlas_looks import LOOKS
from nullmotion.plot.atlas_pieces import pieces
from nullmotion.plot.atlas_view import Scene, scene
from nullmotion.report import page
from nullmotion.report.atlas import Atlas
from nullmotion.report.charts import Charts

REPEATS, TURNS = 5, 6
TWO_FRAMES = "new Promise(r => requestAnimationFrame(() => requestAnimationFrame(r)))"
FIGURE = "document.querySelector('.js-plotly-plot')"


def ours(shown: Scene) -> str:
    """Return the page as it is."""
    atlas = Atlas(shown)
    return page.document("Atlas", [atlas.section()], Charts(), page.versions(), *atlas.extras())


def by_face(shown: Scene) -> str:
    """Return a plotly page: a mesh a sheet, its faces coloured one by one."""
    meshes = []
    for sheet in shown.sheets:
        colours = [LOOKS[kind].colour for kind in sheet.kind[sheet.cells[:, 0]]]
        meshes.append(_mesh(sheet.momentum, sheet.cells, facecolor=colours, opacity=0.4))
    return _plotly(meshes)


def by_type(shown: Scene) -> str:
    """Return a plotly page: a mesh a type, cut where types part, that a legend switches."""
    made, meshes = pieces(shown.sheets), []
    for kind, look in enumerate(LOOKS):
        corner = made.corner[made.kind == kind].reshape(-1, 3)
        if len(corner):
            cells = np.arange(len(corner), dtype=np.int32).reshape(-1, 3)
            meshes.append(_mesh(corner, cells, color=look.colour, opacity=0.4, name=look.name))
    return _plotly(meshes)


def _mesh(points: np.ndarray, cells: np.ndarray, **more: Any) -> go.Mesh3d:
    x, y, z = points.astype(np.float32).T
    i, j, k = cells.T
    return go.Mesh3d(x=x, y=y, z=z, i=i, j=j, k=k, showlegend="name" in more, **more)


def _plotly(meshes: list[go.Mesh3d]) -> str:
    figure = go.Figure(meshes).update_layout(scene_aspectmode="data", width=676, height=560)
    return str(figure.to_html(include_plotlyjs=True))


def on_screen(tab: Page) -> None:
    """Wait until what was drawn is on the screen: a picture of it has been taken."""
    tab.screenshot(clip={"x": 300, "y": 400, "width": 2, "height": 2})


def seen_from(k: int) -> str:
    """Return what turns a plotly figure."""
    eye = f"{{x: 1.5 * Math.cos({0.1 * k}), y: 1.5 * Math.sin({0.1 * k}), z: 0.6}}"
    return f"Plotly.relayout({FIGURE}, {{'scene.camera.eye': {eye}}}).then(() => {TWO_FRAMES})"


def measured(browser: Any, file: Path, ready: str, turn: Callable[[int], str]) -> tuple[float, ...]:
    """Return seconds from opening a file to its first picture, and of one turn; the least found."""
    first, turns = [], []
    for _ in range(REPEATS):
        tab = browser.new_page(viewport={"width": 1280, "height": 900})
        start = time.perf_counter()
        tab.goto(file.as_uri())
        tab.wait_for_selector(ready)
        on_screen(tab)
        first.append(time.perf_counter() - start)
        for k in range(TURNS):
            start = time.perf_counter()
            tab.evaluate(turn(k))
            on_screen(tab)
            turns.append(time.perf_counter() - start)
        tab.close()
    return min(first), min(turns)


def main() -> None:
    """Print the table."""
    shown = scene(nm.layouts.pyramid(skew=np.radians(54.73)))
    press = f"document.querySelector('[data-steer=left]').click(), {TWO_FRAMES}"
    gl = ".js-plotly-plot canvas"
    pages = (
        ("ours", ours, "#atlas[data-drawn]", lambda k: press),
        ("plotly, a mesh a sheet", by_face, gl, seen_from),
        ("plotly, a mesh a type", by_type, gl, seen_from),
    )
    triangles = sum(len(sheet.cells) for sheet in shown.sheets)
    with sync_playwright() as driver, tempfile.TemporaryDirectory() as folder:
        path = shutil.which("chromium")
        browser = driver.chromium.launch(executable_path=path, args=["--no-sandbox"])
        print(f"{triangles} triangles, Chromium {browser.version}, no graphics card")
        print("| page | size [MB] | first picture [s] | one turn [s] |\n|---|---|---|---|")
        for name, make, ready, turn in pages:
            file = Path(folder, "page.html")
            file.write_text(make(shown), encoding="utf-8")
            first, turned = measured(browser, file, ready, turn)
            print(f"| {name} | {file.stat().st_size / 1e6:.1f} | {first:.1f} | {turned:.2f} |")
        browser.close()


if __name__ == "__main__":
    main()
