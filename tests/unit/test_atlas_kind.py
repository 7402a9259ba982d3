"""Types of singular states against known ones, and against null motion that is solved for."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import null_space
from scipy.optimize import least_squares

import nullmotion as nm
from nullmotion import atlas
from nullmotion.singular_kind import form
from nullmotion.singular_vicinity import neighbours

classify = nm.singularity.classify
PYRAMID = nm.layouts.pyramid(skew=np.radians(54.73))
BOX = nm.layouts.box90()
TRIANGLE = nm.layouts.triangle()
SHARP = {"xtol": 3e-16, "ftol": 3e-16, "gtol": 3e-16, "max_nfev": 60}

KNOWN = [
    (PYRAMID, [-90, 0, 90, 0], "elliptic"),  # Papakonstantinou et al. (2021), Eq 26
    (PYRAMID, [90, 180, -90, 180], "elliptic"),  # its mirror image
    (PYRAMID, [0, 0, 0, 0], "regular"),
    (PYRAMID, [90, 90, 90, 90], "saturation"),  # all rotors lean to +z
    (PYRAMID, [-90, 180, 90, 0], "saturation"),  # along +x
    (PYRAMID, [90, 180, -90, 0], "hyperbolic"),
    (
        nm.layouts.pyramid(skew=np.arcsin(0.8)),
        [63.434949, 110.323137, -70.346176, -102.528808],
        "hyperbolic",
    ),
    (BOX, [0, 0, 0, 0], "saturation"),
    (BOX, [0, 0, 180, 180], "hyperbolic"),
    (BOX, [30, 210, 40, 220], "degenerate-hyperbolic"),  # two pairs that cancel
    (BOX, [30, 210, 70, 70], "degenerate-hyperbolic"),  # one pair that cancels
    (BOX, [90, -90, 90, -90], "hyperbolic"),  # both may open along x
    (BOX, [90, -90, 40, 220], "degenerate-hyperbolic"),  # only one of them
    (BOX, [30, 30, 90, -90], "hyperbolic"),  # only beyond the second order
    (BOX, [90, 90, 90, 90], "saturation"),  # two singular directions
    (BOX, [10, 190, 90, 90], "saturation"),  # null motion within the face of a disc
    (TRIANGLE, [-120, 0, 120], "saturation"),  # 3h
    (TRIANGLE, [-120, 0, 300], "hyperbolic"),  # 1h
    (nm.layouts.planar(n=2), [0, 180], "degenerate-hyperbolic"),
    (nm.layouts.planar(n=2), [0, 90], "regular"),
    (nm.layouts.planar(n=4), [0, 180, 0, 180], "hyperbolic"),
    (nm.CmgArray([[0, 0, 1], [1, 0, 0]], [[1, 0, 0], [0, 1, 0]]), [10, 20], "saturation"),
]  # fmt: skip


@pytest.mark.parametrize(("array", "delta", "kind"), KNOWN)
def test_known_states(array: nm.CmgArray, delta: list[float], kind: str) -> None:
    assert classify(array, np.radians(delta)) == kind
    turned = np.radians(delta) + 2 * np.pi * np.arange(array.n)
    assert classify(array, turned) == kind
    scaled = array.altered(h0=array.h0 * 70.0)
    assert classify(scaled, np.radians(delta)) == kind
    assert atlas.passable(array, np.radians(delta)) == (kind in ("regular", "hyperbolic"))


@pytest.mark.sampled(5)
@pytest.mark.parametrize(("array", "delta", "kind"), KNOWN)
def test_known_states_by_solving_for_null_motion(
    array: nm.CmgArray, delta: list[float], kind: str
) -> None:
    """SciPy looks for angles of the same momentum near by: regular, singular, or none."""
    if kind == "regular":
        return
    centre, radius = np.radians(delta), 0.05
    momentum = array.momentum(centre)

    def missing(x: np.ndarray) -> np.ndarray:
        return np.append(
            array.momentum(x) - momentum, (x - centre) @ (x - centre) / radius - radius
        )

    rng = np.random.default_rng(5)
    sigma = []
    axes = null_space(array.jacobian(centre), rcond=1e-9).T
    starts = [*axes, *-axes, *rng.normal(size=(12, array.n))]
    for start in starts:
        away = radius * start / np.linalg.norm(start)
        found = least_squares(missing, centre + away, **SHARP)
        if np.abs(found.fun).max() < 1e-11:
            sigma.append(np.linalg.svd(array.jacobian(found.x))[1][-1])
    if kind == "hyperbolic":
        assert max(sigma) > 1e-4
    elif kind == "elliptic":
        assert not sigma
    elif kind == "degenerate-hyperbolic":
        assert sigma and max(sigma) < 1e-4
    elif kind == "saturation":
        assert max(sigma, default=0.0) < 1e-4


def test_eq_26() -> None:
    """M of Papakonstantinou et al. at [-90, 0, 90, 0] deg: the same eigenvalues, as printed."""
    found = form(PYRAMID, np.radians([-90, 0, 90, 0]))
    assert found is not None
    side = np.sign(found.u[0, 0])
    assert side * found.u[:, 0] == pytest.approx([1, 0, 0], abs=1e-12)
    assert side * found.along[:, 0] == pytest.approx([0.5774, -1, 0.5774, 1], abs=2e-4)
    value = np.linalg.eigvalsh(found.matrix(np.array([[side]]))[0])
    assert value == pytest.approx([0.1444, 0.5774], abs=2e-4)


def test_random_points_by_solving_for_null_motion(rng: np.random.Generator) -> None:
    """Elliptic points are alone with their momentum near by, hyperbolic ones are not."""
    array = nm.CmgArray(PYRAMID.gimbal_axes, PYRAMID.spin_axes, [1.0, 0.6, 1.3, 0.9])
    seen = set()
    for u, signs in zip(rng.normal(size=(30, 3)), rng.choice([-1, 1], (30, 4)), strict=True):
        delta = atlas.singular_points(array, u, signs).delta
        kind = classify(array, delta)
        found = neighbours(array, delta, 0.02, 1e-6)
        assert (len(found) > 0) == (kind == "hyperbolic")
        assert array.momentum(found) == pytest.approx(
            np.tile(array.momentum(delta), (len(found), 1))
        )
        seen.add(str(kind))
    assert seen >= {"elliptic", "hyperbolic"}


def test_batches() -> None:
    delta = np.radians([[-90, 0, 90, 0], [0, 0, 0, 0], [90, 180, -90, 0], [90, 90, 90, 90]])
    found = classify(PYRAMID, delta.reshape(2, 2, 4))
    assert found.tolist() == [["elliptic", "regular"], ["hyperbolic", "saturation"]]
    assert isinstance(classify(PYRAMID, delta[0]), str)


def test_the_tolerance_says_what_is_singular() -> None:
    delta = np.radians([-90, 1e-5, 90, 0])
    beside = np.radians([-90, 0.1, 90, 0])
    assert classify(PYRAMID, delta) == "elliptic"
    assert classify(PYRAMID, delta, tolerance=1e-9) == "regular"
    assert classify(PYRAMID, beside) == "regular"
    assert classify(PYRAMID, beside, tolerance=1e-2) == "elliptic"


@pytest.mark.parametrize("tolerance", [0.0, 1.0, -1e-6, np.nan])
def test_bad_tolerances_are_refused(tolerance: float) -> None:
    with pytest.raises(nm.InputError, match="tolerance"):
        classify(PYRAMID, np.zeros(4), tolerance)


def test_bad_angles_are_refused() -> None:
    for delta in (np.zeros(3), np.full(4, np.nan), np.zeros((0,))):
        with pytest.raises(nm.InputError, match="delta"):
            classify(PYRAMID, delta)
    with pytest.raises(nm.InputError, match="delta"):
        atlas.passable(PYRAMID, np.zeros((2, 4)))
    for direction in (np.zeros(3), [1.0, 0.0], [np.inf, 0, 0]):
        with pytest.raises(nm.InputError, match="direction"):
            atlas.passable(PYRAMID, np.radians([-90, 0, 90, 0]), direction)


def test_collapsed_sheets_are_degenerate() -> None:
    """Pairs of parallel CMGs that cancel leave a circle, or nothing, of a sheet of momenta."""
    for sheet in atlas.surfaces(BOX, 300):
        cancel = sheet.signs[0] != sheet.signs[1], sheet.signs[2] != sheet.signs[3]
        inside = ~sheet.rim
        names = {atlas.KINDS[k] for k in sheet.kind[inside]}
        assert (names == {"degenerate-hyperbolic"}) == any(cancel)
        assert np.isinf(sheet.curvature[inside]).any() == any(cancel)


def test_stopped_wheels_do_not_count() -> None:
    idle = nm.CmgArray(PYRAMID.gimbal_axes, PYRAMID.spin_axes, [1.0, 1.0, 0.0, 1.0])
    gone = PYRAMID.without(2)
    delta = atlas.singular_points(gone, [1, 2, 3], [1, -1, 1]).delta
    assert classify(idle, np.insert(delta, 2, 0.4)) == classify(gone, delta) == "elliptic"
    assert not atlas.passable(idle, np.insert(delta, 2, 0.4))


def numeric(array: nm.CmgArray, delta: np.ndarray, d: np.ndarray) -> bool:
    """Return whether SciPy finds angles close by with the momentum a little further along d."""
    ahead, near = 1e-5, 0.06
    wanted = array.momentum(delta) + ahead * d / np.linalg.norm(d)
    rng = np.random.default_rng(3)
    for start in delta + 0.02 * rng.normal(size=(25, array.n)):
        found = least_squares(
            lambda x: array.momentum(x) - wanted, start, **SHARP | {"max_nfev": 400}
        )
        if np.abs(found.fun).max() < 1e-13 and np.linalg.norm(found.x - delta) < near:
            return True
    return False


@pytest.mark.sampled(2)
@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("kind", ["elliptic", "hyperbolic"])
def test_directions_that_pass(kind: str, seed: int) -> None:
    """Across the sheet, and along it (both signs of curvature)."""
    array = nm.CmgArray(PYRAMID.gimbal_axes, PYRAMID.spin_axes, [1.0, 1.2, 0.9, 1.1])
    rng = np.random.default_rng([20191211, seed])
    while True:
        point = atlas.singular_points(array, rng.normal(size=3), rng.choice([-1, 1], 4))
        found = form(array, point.delta)
        assert found is not None
        stiff = np.abs(np.linalg.eigvalsh(found.matrix(np.ones((1, 1)))[0])).min()
        # with a smaller one the gimbals would go farther than `numeric` looks
        if classify(array, point.delta) == kind and stiff > 0.03:
            break
    along = np.cross(point.u, rng.normal(size=3))
    directions = (point.u, -point.u, along, np.cross(point.u, along))
    passed = [atlas.passable(array, point.delta, d) for d in directions]
    assert passed == [numeric(array, point.delta, d) for d in directions]
    assert passed[:2].count(True) == (2 if kind == "hyperbolic" else 1)


@pytest.mark.sampled(2)
@pytest.mark.parametrize(
    ("delta", "direction", "expected"),
    [
        ([10, 190, 90, 90], [0, 0, -1], True),  # back from a face of the envelope
        ([10, 190, 90, 90], [0, 0, 1], False),
        ([30, 210, 40, 220], [1, 0, 0], False),  # pairs would first have to turn
        ([90, 90, 90, 90], [0, -1, -1], True),
        ([90, 90, 90, 90], [0, 1, 1], False),
    ],
)
def test_directions_where_the_second_order_is_silent(
    delta: list[float], direction: list[float], expected: bool
) -> None:
    assert atlas.passable(BOX, np.radians(delta), direction) == expected
    assert numeric(BOX, np.radians(delta), np.array(direction)) == expected


def test_a_corner_of_the_elliptic_state() -> None:
    delta = np.radians([-90, 0, 90, 0])
    assert not atlas.passable(PYRAMID, delta, [1, 0, 0])
    assert atlas.passable(PYRAMID, delta, [-1, 0, 0])
