"""What pictures of an atlas add to the surfaces: torque, flat pieces, maps, a whole page."""

from __future__ import annotations

import base64
import re

import numpy as np
import pytest

import nullmotion as nm
from nullmotion import atlas
from nullmotion.atlas.torque import TorqueMap
from nullmotion.plot.atlas import atlas_figure
from nullmotion.plot.atlas_flats import flats
from nullmotion.plot.atlas_maps import map_title, most_capability, plane_of
from nullmotion.plot.atlas_pieces import own_places
from nullmotion.plot.atlas_signs import minus, sign_name
from nullmotion.plot.atlas_torque import SCALE, span, ticks, torque_left
from nullmotion.plot.atlas_view import scene
from nullmotion.report import page
from nullmotion.report.atlas import Atlas
from nullmotion.report.atlas_coded import angles
from nullmotion.report.atlas_data import block
from nullmotion.report.atlas_numbers import Number
from nullmotion.report.atlas_page import atlas_page
from nullmotion.report.charts import Charts
from nullmotion.report.markup import tag

PYRAMID = nm.layouts.pyramid(skew=np.radians(54.73))
TURNED = np.array([[0.0, 1.0, 0.0], [0.6, 0.0, 0.8], [0.8, 0.0, -0.6]])
SHARED = {
    "box90": nm.layouts.box90(h0=[1.0, 2.0, 0.5, 1.5]),
    "box90 equal": nm.layouts.box90(),
    "roof6": nm.layouts.roof6(h0=[1.0, 2.0, 2.5, 1.0, 1.0, 0.3]),
    "pairs": nm.layouts.scissored_pairs(),
    "failed": nm.layouts.box90().without(0, 0.3),
    "idle": nm.layouts.roof6(h0=[1.0, 0.0, 1.0, 1.0, 1.0, 1.0]),
    "turned": nm.layouts.box90().altered(torque_axes=TURNED),
    "opposite": nm.CmgArray(
        nm.layouts.box90().gimbal_axes * [[1], [-1], [1], [1]], nm.layouts.box90().spin_axes
    ),
}
NUMBERS = (Number("Omnidirectional momentum", 2.5214159, 2.5229, "N m s", 1.0, "Everywhere"),)


def decoded(data, index):
    kind, coded = data["arrays"][index].split(":")
    return np.frombuffer(base64.b64decode(coded), f"<{kind}")


def stand_in(rng, basis, origin, shape=(9, 7), n=4, most=1.3) -> TorqueMap:
    capability = rng.uniform(0, most, shape)
    delta = rng.uniform(-np.pi, np.pi, (*shape, n))
    capability[0, 0], delta[0, 0] = np.nan, np.nan
    x, y = np.linspace(-3, 2, shape[1]), np.linspace(-1, 1.5, shape[0])
    return TorqueMap(
        basis=np.array(basis, float), origin=np.array(origin, float), x=x, y=y,
        capability=capability, delta=delta, sigma_min=capability, title="made up", method="optimal",
    )  # fmt: skip


# ---- flat pieces ----
@pytest.mark.parametrize("name", SHARED)
def test_flat_pieces_are_singular_and_of_their_type(name, rng):
    """By singular values, and by the classifier of single states."""
    array = SHARED[name]
    made = flats(array)
    assert made
    for one in made:
        sigma = np.linalg.svd(array.unit_jacobian(one.delta), compute_uv=False)[:, -1]
        assert sigma.max() < 1e-12
        np.testing.assert_allclose(
            np.einsum("pm,pm->p", one.u, one.momentum - one.momentum[0]), 0, atol=1e-12
        )
    for one in made[:: max(1, len(made) // 4)]:
        for i in rng.choice(np.arange(72, len(one.u) - 72), 4, replace=False):
            assert str(nm.singularity.classify(array, one.delta[i])) == str(
                atlas.KINDS[one.kind[i]]
            )


@pytest.mark.parametrize("name", ["box90", "roof6", "pairs"])
def test_flat_pieces_hold_all_momenta_of_free_cmgs(name, rng):
    """Momenta of free CMGs at random angles lie in the annulus, and come near both its edges."""
    array = SHARED[name]
    one = flats(array)[0]
    free = one.signs == 0
    delta = np.repeat(one.delta[:1], 20_000, axis=0)
    delta[:, free] = rng.uniform(-np.pi, np.pi, (len(delta), free.sum()))
    middle = one.momentum.reshape(-1, 72, 3).mean(axis=(0, 1))
    found = np.linalg.norm(array.momentum(delta) - middle, axis=1)
    radius = np.linalg.norm(one.momentum - middle, axis=1)
    assert radius.min() - 1e-5 <= found.min() <= radius.min() + 0.05
    assert radius.max() - 0.05 <= found.max() <= radius.max() + 1e-9


def test_only_shared_gimbal_axes_have_flat_pieces():
    assert flats(PYRAMID) == () and flats(nm.layouts.planar(n=4)) == ()
    assert len(flats(nm.layouts.box90())) == 8
    assert len(flats(nm.layouts.scissored_pairs(), most=5)) == 5
    assert sign_name(np.array([0, 0, 1, -1])) == "○○+−" and minus(np.array([0, 0, 1, -1])) == 1
    shown = scene(nm.layouts.box90(), most=2000)
    assert len(shown.every) == len(shown.sheets) + 8


def test_flat_pieces_of_the_page_have_their_angles():
    array = SHARED["box90"]
    data = block(scene(array, most=3000))
    found = [sheet for sheet in data["sheets"] if "delta" in sheet]
    assert len(found) == 8 and all("margin" not in sheet for sheet in found)
    for sheet in found:
        delta = decoded(data, sheet["delta"]).reshape(-1, 4) * np.pi / 32768
        h = decoded(data, sheet["h"]).reshape(-1, 3) * data["quantum"]
        np.testing.assert_allclose(array.momentum(delta), h, atol=1e-3)
        corners = decoded(data, data["meshes"][sheet["mesh"]]["triangles"])
        assert corners.max() == len(h) - 1


def test_rims_take_the_type_of_their_own_sheet():
    """The sheet's rim at its own axis meets the envelope, but its funnel is all elliptic."""
    sheet = atlas.surfaces(PYRAMID, 3000, [[-1, 1, 1, 1]])[0]
    own = own_places(sheet)
    assert not sheet.rim[own].any()
    np.testing.assert_array_equal(own[~sheet.rim], np.flatnonzero(~sheet.rim))
    at = sheet.rim & (sheet.u @ PYRAMID.gimbal_axes[0] > 1 - 1e-9)
    assert set(sheet.kind[at]) == {0} and set(sheet.kind[own[at]]) == {1}


# ---- torque ----
@pytest.mark.parametrize("array", [PYRAMID, *SHARED.values()], ids=["pyramid", *SHARED])
def test_torque_left_is_the_second_singular_value_of_every_sheet(array, rng):
    shown = scene(array, most=4000)
    first, *others = torque_left(shown)
    assert len(others) == len(shown.flats)
    for sheet in shown.sheets[:: max(1, len(shown.sheets) // 3)]:
        expected = np.linalg.svd(array.unit_jacobian(sheet.delta), compute_uv=False)[:, 1]
        np.testing.assert_allclose(first, expected, atol=1e-10)
    data = block(shown)
    steps = decoded(data, data["meshes"][0]["left"])
    low, high = span([first, *others])
    assert steps.dtype == np.uint8
    np.testing.assert_allclose(low + (high - low) * steps / 255, first, atol=0.003 * (high - low))


def test_two_torque_dimensions_have_no_colours_by_torque():
    shown = scene(nm.layouts.planar(n=4), most=2000)
    assert torque_left(shown) == []
    data = block(shown)
    assert "left" not in data["meshes"][0]
    assert "atlas-colour" not in Atlas(shown).section()


def test_the_scale_is_viridis_and_grows_lighter_evenly():
    import matplotlib

    rgb = np.array([[int(c[i : i + 2], 16) / 255 for i in (1, 3, 5)] for c in SCALE])
    table = matplotlib.colormaps["viridis"](np.arange(256))[:, :3]
    places = np.linspace(0, 255, len(SCALE))
    known = np.stack([np.interp(places, np.arange(256), column) for column in table.T], axis=1)
    np.testing.assert_allclose(rgb, known, atol=0.003)
    linear = np.where(rgb > 0.04045, ((rgb + 0.055) / 1.055) ** 2.4, rgb / 12.92)
    lightness = 116 * np.cbrt(linear @ [0.2126, 0.7152, 0.0722]) - 16
    steps = np.diff(lightness)
    assert steps.min() > 0.6 * steps.mean() and steps.max() < 1.5 * steps.mean()


@pytest.mark.parametrize(
    ("low", "high"), [(0.0, 1.414), (0.93, 1.414), (0.0, 3.7e-4), (0.0, 250.0), (0.0, 1.0)]
)
def test_ticks_are_round_and_inside(low, high):
    found = np.array(ticks(low, high))
    assert 2 <= len(found) <= 6 and low <= found.min() and found.max() <= high * (1 + 1e-9)
    assert np.ptp(np.diff(found)) < 1e-9 * high
    assert "-0.0" not in map(str, found)
    assert ticks(0.0, 0.0) == [0.0]


# ---- maps ----
def test_maps_of_the_page_are_those_given(rng):
    maps = (
        stand_in(rng, [[0, 1, 0], [0, 0, 1]], [0.5, 0, 0]),
        stand_in(rng, [[0, 0, 1], [1, 0, 0]], [0, 0.25, 0]),  # turned to x before z
        stand_in(rng, [[0.6, 0.8, 0], [0, 0, 1]], [0.8, -0.6, 0.0], most=0.7),
    )
    shown = scene(PYRAMID, maps=maps, most=2000)
    data = block(shown)
    assert [made["names"] for made in data["maps"]][:2] == [["hy", "hz"], ["hx", "hz"]]
    assert [map_title(shown, m) for m in maps[:2]] == ["hx = 0.5 N m s", "hy = 0.25 N m s"]
    for made, given in zip(data["maps"], maps, strict=True):
        value = decoded(data, made["value"]).reshape(made["y"][2], made["x"][2])
        assert made["most"] == most_capability(shown)
        reached = value != 65535
        x, y = (np.linspace(*made[key]) for key in "xy")
        basis = np.array(made["basis"])
        h = made["origin"] + x[:, None] * basis[0] + (y[:, None] * basis[1])[:, None]
        delta = np.full((*value.shape, 4), np.nan)
        delta[reached] = decoded(data, made["delta"]).reshape(-1, 4) * np.pi / 32768
        for j, i in np.ndindex(given.capability.shape):
            there = given.origin + given.x[i] * given.basis[0] + given.y[j] * given.basis[1]
            at = np.unravel_index(np.linalg.norm(h - there, axis=-1).argmin(), value.shape)
            np.testing.assert_allclose(h[at], there, atol=1e-12)
            assert reached[at] == np.isfinite(given.capability[j, i])
            if reached[at]:
                found = value[at] / 65534 * made["most"]
                assert found == pytest.approx(given.capability[j, i], abs=2e-5 * made["most"])
                np.testing.assert_allclose(delta[at], given.delta[j, i], atol=1e-4)


def test_maps_are_drawn_in_body_axes(rng):
    array = PYRAMID.altered(torque_axes=TURNED)
    shown = scene(array, maps=[stand_in(rng, [[1, 0, 0], [0, 1, 0]], [0, 0, 0.5])], most=2000)
    made = block(shown)["maps"][0]
    basis = np.array([[1, 0, 0], [0, 1, 0]]) @ TURNED
    np.testing.assert_allclose(made["basis"], basis, atol=1e-12)
    np.testing.assert_allclose(made["origin"], np.array([0, 0, 0.5]) @ TURNED, atol=1e-12)
    assert made["names"][0] == "hy" and made["names"][1].startswith("h along (0.6, 0, 0.8)")


def test_coordinates_are_components_of_momentum(rng):
    shown = stand_in(rng, [[1, 0, 0], [0, 1, 0]], [0.4, -0.2, 0.7])
    where = plane_of(shown)
    np.testing.assert_allclose(where.foot, [0, 0, 0.7], atol=1e-12)
    np.testing.assert_allclose(where.x, shown.x + 0.4)
    np.testing.assert_allclose(where.y, shown.y - 0.2)


@pytest.mark.parametrize("most", [np.nan, np.inf, 0.0])
def test_maps_without_torque_are_left_away(rng, most):
    given = stand_in(rng, [[0, 1, 0], [0, 0, 1]], [0, 0, 0])
    given.capability[:] = most
    shown = scene(PYRAMID, maps=[given], most=2000)
    assert block(shown)["maps"] == [] and Atlas(shown).maps() == ""


def test_angles_keep_to_16_bits(rng):
    given = np.array([-np.pi, np.pi, 0.0, 3 * np.pi, *rng.uniform(-9, 9, 20)])
    away = angles(given) * np.pi / 32768 - given
    assert np.abs((away + np.pi) % (2 * np.pi) - np.pi).max() < 1e-4


# ---- a whole page and figure ----
def test_a_page_has_all_parts_and_its_numbers_in_full(tmp_path, rng):
    shown = scene(PYRAMID, maps=[stand_in(rng, [[0, 1, 0], [0, 0, 1]], [0, 0, 0])], most=4000)
    more = [page.section("State", tag("p", "<somewhere>"), id="state")]
    path = atlas_page(
        tmp_path / "a.html", "A & B", shown, tag("h1", "Head"), NUMBERS, text="[array]", more=more
    )
    content = path.read_text(encoding="utf-8")
    order = [
        content.index(f'<section id="{key}"')
        for key in ("atlas", "torque", "numbers", "state", "file")
    ]
    assert order == sorted(order)
    links = re.findall(r'<a href="#(\w+)"', content)
    assert links == ["atlas", "torque", "numbers", "state", "file"]
    assert 'data-value="2.5214159"' in content and "A &amp; B" in content
    assert "&lt;somewhere&gt;" in content and "[data-copy]" in content


def test_maps_cost_little(rng):
    maps = [stand_in(rng, basis, [0, 0, 0], (81, 81)) for basis in ([[0, 1, 0], [0, 0, 1]],) * 3]
    sizes = []
    for given in ((), maps):
        shown = scene(PYRAMID, maps=given)
        atlas_part = Atlas(shown)
        parts = [atlas_part.section(), atlas_part.maps()]
        sizes.append(
            len(page.document("A", parts, Charts(), page.versions(), *atlas_part.extras()))
        )
    assert sizes[1] - sizes[0] < 400_000


@pytest.mark.parametrize("name", [pytest.param("box90", marks=pytest.mark.slow), "planar"])
def test_figures_have_maps(tmp_path, rng, name):
    if name == "planar":
        array, basis, origin = nm.layouts.planar(n=3), np.eye(2), np.zeros(2)
    else:
        array, basis, origin = SHARED[name], [[1, 0, 0], [0, 0, 1]], [0, 0.3, 0]
    given = stand_in(rng, basis, origin, n=array.n)
    sizes = []
    for maps in ((), (given,)):
        path = atlas_figure(scene(array, maps=maps, most=3000), tmp_path / "atlas.svg", "T")
        sizes.append(path.stat().st_size)
        content = path.read_text(encoding="utf-8")
        assert ("Torque capability [N m]" in content) == bool(maps)
    assert sizes[0] < sizes[1] < 3_000_000
