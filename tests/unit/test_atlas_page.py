"""The atlas as a part of a page: its numbers, its text, its size; the figure for papers."""

from __future__ import annotations

import base64
import json
import re
from html.parser import HTMLParser
from types import SimpleNamespace

import numpy as np
import pytest

import nullmotion as nm
from nullmotion import atlas
from nullmotion.errors import InputError
from nullmotion.plot import atlas_runs
from nullmotion.plot.atlas import atlas_figure
from nullmotion.plot.atlas_looks import LOOKS
from nullmotion.plot.atlas_pieces import cut, pieces
from nullmotion.plot.atlas_signs import minority, sign_name
from nullmotion.plot.atlas_view import Ball, Motion, scene
from nullmotion.report import page
from nullmotion.report.atlas import Atlas
from nullmotion.report.atlas_data import MOST_BYTES, block
from nullmotion.report.charts import Charts

EVIL = """<img src=x onerror="alert(1)"></script><script>alert('2')</script>&amp;"""
ARRAYS = {
    "pyramid": nm.layouts.pyramid(skew=np.radians(54.73)),
    "three": nm.layouts.pyramid().without(0, 0.4),
    "unequal": nm.layouts.box90(h0=[1.0, 2.0, 0.5, 1.5]),
    "roof6": nm.layouts.roof6(),
    "planar": nm.layouts.planar(n=5),
    "turned": nm.CmgArray(
        nm.layouts.pyramid().gimbal_axes,
        nm.layouts.pyramid().spin_axes,
        torque_axes=np.array([[0.0, 1.0, 0.0], [0.6, 0.0, 0.8], [0.8, 0.0, -0.6]]),
    ),
}


def decoded(data, index):
    kind, coded = data["arrays"][index].split(":")
    return np.frombuffer(base64.b64decode(coded), f"<{kind}")


def document(shown, title="Atlas"):
    made = Atlas(shown)
    return page.document(title, [made.section()], Charts(), page.versions(), *made.extras())


class Elements(HTMLParser):
    def __init__(self, content):
        super().__init__()
        self.found, self.text = [], ""
        self.feed(content)

    def handle_starttag(self, name, attributes):
        self.found.append((name, dict(attributes)))

    def handle_data(self, data):
        self.text += data


@pytest.mark.parametrize("name", ARRAYS)
def test_points_of_the_page_are_singular(name):
    """Momenta of the page are those of its u and signs, worked out apart."""
    array = ARRAYS[name]
    data = block(scene(array, most=4000))
    u = decoded(data, data["meshes"][0]["u"]).reshape(-1, array.m) / 32767
    axes = np.eye(3) if array.m == 3 else array.torque_axes
    u = u / np.linalg.norm(u, axis=1, keepdims=True)
    sheets = [sheet for sheet in data["sheets"] if sheet["mesh"] == 0]
    for sheet in sheets[:: max(1, len(sheets) // 5)]:
        h = decoded(data, sheet["h"]).reshape(-1, array.m) * data["quantum"]
        across = (u @ axes)[:, None] - (u @ axes @ array.gimbal_axes.T)[
            ..., None
        ] * array.gimbal_axes
        size = np.linalg.norm(across, axis=2)
        away = (size > 0.02).all(axis=1)  # nearer to a gimbal axis 16 bits of u are not enough
        rotor = across[away] / size[away, :, None]
        rotor = rotor * (np.array(sheet["signs"]) * array.h0)[:, None]
        expected = (rotor.sum(axis=1) + array.momentum_bias) @ (
            np.eye(3) if array.m == 3 else array.torque_axes.T
        )
        np.testing.assert_allclose(h[away], expected, atol=3e-3)
        kind = decoded(data, sheet["kind"])
        assert len(kind) == len(h) and kind.max() < len(LOOKS)
    corners = decoded(data, data["meshes"][0]["triangles"])
    assert corners.max() == len(u) - 1 and len(corners) % array.m == 0


def test_types_of_the_page_are_those_of_the_points(rng):
    array = ARRAYS["pyramid"]
    data = block(scene(array, most=8000))
    for sheet in data["sheets"]:
        kind = decoded(data, sheet["kind"])
        u = decoded(data, data["meshes"][0]["u"]).reshape(-1, 3) / 32767
        for i in rng.choice(len(u), 12, replace=False):
            point = atlas.singular_points(array, u[i], sheet["signs"])
            if (point.across > 0.1).all():
                assert LOOKS[kind[i]].key == nm.singularity.classify(array, point.delta)


@pytest.mark.parametrize("n", [1, 2, 3, 4, 5, 6])
def test_minority_keeps_every_pattern_once(n):
    array = nm.layouts.planar(n=max(n, 2)) if n > 1 else nm.layouts.planar(n=2).without(0)
    signs = atlas.patterns(array)
    turned = minority(signs, np.ones(array.n, bool))
    minus = (turned < 0).sum(axis=1)
    assert (2 * minus <= array.n).all() and (np.diff(minus) >= 0).all() and minus[0] == 0
    both = {tuple(s) for s in turned} | {tuple(-s) for s in turned}
    assert both == {tuple(s) for s in signs} | {tuple(-s) for s in signs}
    assert len(turned) == len(signs)
    assert sign_name(turned[0]) == "+" * array.n


def test_a_page_is_small_and_asks_for_nothing():
    content = document(scene(ARRAYS["pyramid"]))
    assert len(content) < 2_000_000
    elements = Elements(content)
    ids = [a["id"] for _, a in elements.found if "id" in a]
    assert len(ids) == len(set(ids))
    for name, attributes in elements.found:
        assert name not in ("iframe", "object", "embed", "img", "base")
        assert "src" not in attributes
        assert not any(key.startswith("on") for key in attributes)
    assert not re.search(r"https?://(?!www\.w3\.org)", content)
    for name, attributes in elements.found:
        if "for" in attributes and name == "label":
            assert attributes["for"] in ids


def test_eight_cmgs_stay_small_and_more_are_told():
    eight = scene(nm.layouts.pyramid(n=8))
    assert len(document(eight)) < 8_000_000
    nine = scene(nm.layouts.planar(n=9))
    assert len(nine.sheets) == 128 and nine.left_out == 128
    assert "128 sign patterns with more minus signs are not shown" in document(nine)


def test_text_of_the_user_stays_text():
    array = ARRAYS["pyramid"].altered(label=EVIL)
    t, delta = np.linspace(0, 1, 5), np.zeros((5, 4))
    motions = [Motion(EVIL, t, delta, array.momentum(delta)), Motion("b", t, delta, delta[:, :3])]
    balls = (Ball("a", EVIL, 1.0, "#008a65", "solid"),)
    content = document(scene(array, balls=balls, motions=motions, most=2000), EVIL)
    elements = Elements(content)
    names = [name for name, _ in elements.found]
    assert "img" not in names and names.count("script") == 2
    assert elements.text.count(EVIL) >= 3
    data = json.loads(re.search(r'id="atlas-data">(.*?)</script>', content)[1])
    assert data["motions"][0]["label"] == EVIL


def test_long_motions_are_thinned_to_a_size(rng):
    array = ARRAYS["pyramid"]
    t = np.linspace(0, 100, 50_001)
    delta = np.sin(t[:, None] * rng.uniform(0.1, 1, 4))
    motions = [Motion(str(i), t, delta + i, array.momentum(delta + i)) for i in range(12)]
    data = block(scene(array, motions=motions, most=2000))
    kept = [decoded(data, m[key]) for m in data["motions"] for key in ("t", "delta", "h")]
    assert sum(values.nbytes for values in kept) < 1.1 * MOST_BYTES
    first = data["motions"][0]
    times, table = decoded(data, first["t"]), decoded(data, first["delta"]).reshape(-1, 4)
    assert times[0] == 0 and times[-1] == 100
    rows = np.searchsorted(t, times - 1e-4)
    np.testing.assert_allclose(table, delta[rows], atol=1e-3)


def test_what_has_no_surfaces_has_no_part():
    assert Atlas(None).section() == "" and Atlas(None).extras() == ("", "")
    one = nm.CmgArray([[0, 0, 1.0]], [[1.0, 0, 0]], torque_axes=[[1.0, 0, 0]])
    assert not atlas_runs.drawable(one)
    run = SimpleNamespace(setup=SimpleNamespace(array=one), t=np.zeros(1), delta=np.zeros((1, 1)),
                          momentum=np.zeros((1, 1)), measures={})  # fmt: skip
    assert atlas_runs.run_scene(run) is None
    assert atlas_runs.case_scene([SimpleNamespace(trajectory=None)]) is None


def test_cuts_lie_in_the_plane_and_on_the_surface():
    """Every point of a cut is near a singular point of its sheet, found by search over u."""
    array = ARRAYS["pyramid"]
    sheets = atlas.surfaces(array, 6000, [[1, 1, 1, 1], [-1, 1, 1, 1]])
    normal = np.array([0.6, 0.0, 0.8])
    for sheet in sheets:
        made = pieces([sheet])
        found = cut(made, normal, 0.7)
        assert len(found.ends) > 50
        np.testing.assert_allclose(found.ends @ normal, 0.7, atol=1e-12)
        gap = np.linalg.norm(found.ends[:, None, 0] - sheet.momentum, axis=2).min(axis=1)
        assert gap.max() < 0.12


def test_pieces_are_of_one_type_and_cover_the_sheet():
    """Cutting triangles along the edge of a type keeps their area."""
    array = ARRAYS["pyramid"]
    sheet = atlas.surfaces(array, 3000, [[-1, 1, 1, 1]])[0]
    assert np.ptp(sheet.kind) > 0

    def area(corner):
        return np.linalg.norm(
            np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]), axis=1
        ).sum()

    made = pieces([sheet])
    assert len(made.kind) > len(sheet.cells)
    assert area(made.corner) == pytest.approx(area(sheet.momentum[sheet.cells]), rel=1e-9)
    np.testing.assert_allclose(np.linalg.norm(made.normal, axis=1), 1, atol=1e-12)


@pytest.mark.parametrize(
    ("name", "suffix"), [pytest.param("pyramid", "pdf", marks=pytest.mark.slow), ("planar", "png")]
)
def test_figures_are_written(tmp_path, name, suffix):
    array = ARRAYS[name]
    t = np.linspace(0, 1, 9)
    delta = np.outer(t, np.ones(array.n))
    motion = Motion("turning", t, delta, array.momentum(delta))
    balls = (Ball("a", "a ball", 1.0, "#008a65", "dash"),)
    shown = scene(array, balls=balls, motions=(motion,), most=3000)
    path = atlas_figure(shown, tmp_path / f"atlas.{suffix}", "Title")
    head = path.read_bytes()[:5]
    assert head.startswith(b"%PDF" if suffix == "pdf" else b"\x89PNG")
    assert path.stat().st_size > 20_000
    assert [p.name for p in tmp_path.iterdir()] == [path.name]


def test_a_figure_of_another_kind_is_refused(tmp_path):
    with pytest.raises(InputError, match=r"\.pdf"):
        atlas_figure(scene(ARRAYS["planar"]), tmp_path / "atlas.gif")
