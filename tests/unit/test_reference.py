"""Tables of a reference attitude against numerical differentiation and closed forms."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from nullmotion.errors import InputError
from nullmotion.spacecraft.reference import eigenaxis_slew, from_csv_table

components = st.lists(st.floats(-1.0, 1.0), min_size=4, max_size=4).filter(
    lambda q: np.linalg.norm(q) > 0.1
)


def active(q: Any) -> Rotation:
    """Return what turns vectors of R into N."""
    return Rotation.from_quat(np.roll(np.atleast_2d(q), -1, axis=1))


def check_derivatives(rows: Any, times: np.ndarray, h: float, accuracy: float) -> None:
    """Check that rates belong to attitudes and accelerations to rates; differences are central."""
    before, now, after = rows(times - h), rows(times), rows(times + h)
    turned = (active(before[:, :4]).inv() * active(after[:, :4])).as_rotvec() / (2.0 * h)
    np.testing.assert_allclose(turned, now[:, 4:7], atol=accuracy)
    slope = (after[:, 4:7] - before[:, 4:7]) / (2.0 * h)
    np.testing.assert_allclose(slope, now[:, 7:], atol=accuracy)


def check_rows(rows: np.ndarray) -> None:
    """Check unit quaternions that nowhere jump to the other sign."""
    assert rows.shape[1] == 10 and np.isfinite(rows).all()
    np.testing.assert_allclose(np.linalg.norm(rows[:, :4], axis=1), 1.0, atol=1e-12)
    assert np.all(np.sum(rows[1:, :4] * rows[:-1, :4], axis=1) > 0)


@given(components, components, st.floats(0.5, 100.0))
@settings(max_examples=60, deadline=None)
def test_slew(start: list[float], end: list[float], seconds: float) -> None:
    def rows(times: Any) -> np.ndarray:
        return eigenaxis_slew(start, end, seconds, times)

    times = np.linspace(-0.2, 1.3, 61) * seconds
    table = rows(times)
    check_rows(table)
    smooth = times[np.abs(times / seconds * (1.0 - times / seconds)) > 1e-3]
    check_derivatives(rows, smooth, 1e-5 * seconds, 1e-6)
    total = active(start).inv() * active(end)
    angle = total.magnitude()[0]
    first, last = times <= 0, times >= seconds
    assert (active(start).inv() * active(table[first, :4])).magnitude().max() < 1e-7
    assert (active(end).inv() * active(table[last, :4])).magnitude().max() < 1e-7
    assert not table[first | last, 4:].any()
    speed = np.linalg.norm(rows([0.5 * seconds])[0, 4:7])
    assert speed == pytest.approx(1.875 * angle / seconds, rel=1e-9, abs=1e-9)
    fastest = np.linalg.norm(rows(np.linspace(0, seconds, 4001))[:, 7:], axis=1).max()
    assert fastest == pytest.approx(10.0 / np.sqrt(3.0) * angle / seconds**2, rel=1e-5, abs=1e-9)
    across = np.cross(table[:, 4:7], total.as_rotvec()[0])
    if angle < np.pi - 1e-6:
        assert np.abs(across).max() < 1e-9
        assert np.all(table[:, 4:7] @ total.as_rotvec()[0] > -1e-12)


def test_slew_without_a_turn_stands_still() -> None:
    q = np.array([0.5, -0.5, 0.5, 0.5])
    for end in (q, -q):
        table = eigenaxis_slew(q, end, 3.0, np.linspace(0, 4, 9))
        np.testing.assert_allclose(table[:, :4], np.tile(q, (9, 1)), atol=1e-12)
        assert np.abs(table[:, 4:]).max() < 1e-12


def test_half_turn() -> None:
    table = eigenaxis_slew([1, 0, 0, 0], [0, 0, 0, -1], 2.0, np.linspace(0, 2, 21))
    check_rows(table)
    assert abs(table[-1, 3]) == pytest.approx(1.0)


@pytest.mark.parametrize("seconds", [0.0, -1.0, np.inf, np.nan])
def test_slew_time_that_is_refused(seconds: float) -> None:
    with pytest.raises(InputError, match="slew_time"):
        eigenaxis_slew([1, 0, 0, 0], [0, 1, 0, 0], seconds, [0.0])
    with pytest.raises(InputError, match="q_end"):
        eigenaxis_slew([1, 0, 0, 0], [0, 0, 0, 0], 1.0, [0.0])


def coning(t: Any) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return attitude, rate and acceleration of a coning motion, in closed form.

    q = (turn by a t about z) * (tilt b about x) * (turn by -c t about z)
    """
    a, b, c = 0.7, 0.4, 1.1
    t = np.asarray(t, float)
    zero = np.zeros_like(t)

    def about_z(angle: Any) -> Rotation:
        return Rotation.from_rotvec(np.stack([zero, zero, angle], axis=-1))

    turn = about_z(a * t) * Rotation.from_rotvec([b, 0.0, 0.0]) * about_z(-c * t)
    # a z_N seen from R, less c z_R
    tilted = np.array([0.0, np.sin(b), np.cos(b)])
    omega = a * about_z(c * t).apply(tilted) - [0.0, 0.0, c]
    sine, cosine = np.sin(c * t), np.cos(c * t)
    alpha = a * c * np.sin(b) * np.stack([-cosine, -sine, zero], axis=-1)
    return np.roll(turn.as_quat(), 1, axis=1), omega, alpha


def test_the_closed_form_itself() -> None:
    times = np.linspace(0, 9, 40)
    check_derivatives(lambda t: np.concatenate(coning(t), axis=1), times, 1e-4, 1e-7)


@pytest.mark.parametrize("step", [0.1, 0.05])
def test_table_without_rates(step: float) -> None:
    """The rates come of the attitudes, in R, to third order in the step of the table."""
    t = np.arange(0.0, 10.0 + step / 2, step)
    q = coning(t)[0] * np.random.default_rng(1).choice([-1.0, 2.0], (len(t), 1))
    times = np.linspace(0.01, 9.99, 333)

    def rows(at: Any) -> np.ndarray:
        return from_csv_table(t, q, None, None, at)

    check_rows(rows(times))
    check_derivatives(rows, times, 1e-5, 1e-6)
    inner = times[(times > 2) & (times < 8)]
    table, (truth, omega, alpha) = rows(inner), coning(inner)
    assert (active(truth).inv() * active(table[:, :4])).magnitude().max() < 0.02 * step**4
    assert np.abs(table[:, 4:7] - omega).max() < 0.1 * step**3
    assert np.abs(table[:, 7:] - alpha).max() < 0.5 * step**2


def test_table_goes_through_its_rows() -> None:
    t = np.array([0.0, 1.0, 1.5, 4.0, 4.2])
    q, omega, alpha = coning(t)
    table = from_csv_table(t, q, omega, alpha, t)
    assert (active(q).inv() * active(table[:, :4])).magnitude().max() < 1e-7
    np.testing.assert_allclose(table[:, 4:], np.concatenate([omega, alpha], axis=1), atol=1e-12)
    between = from_csv_table(t, q, omega, None, [1.25])[0]
    np.testing.assert_allclose(between[4:7], 0.5 * (omega[1] + omega[2]), atol=1e-12)
    own = from_csv_table(t, q, None, None, [1.25])[0]
    np.testing.assert_array_equal(between[7:], own[7:])


def test_table_stands_still_outside() -> None:
    t = np.array([1.0, 2.0, 3.0])
    q, omega, alpha = coning(t)
    for given_rates in ((None, None), (omega, alpha)):
        table = from_csv_table(t, q, *given_rates, np.array([0.0, 1.0, 3.0, 3.001, 50.0]))
        assert not table[[0, 3, 4], 4:].any() and np.abs(table[[1, 2], 4:7]).min() > 0
        np.testing.assert_allclose(table[0, :4], table[1, :4], atol=1e-12)
        np.testing.assert_allclose(table[3:, :4], table[[2, 2], :4], atol=1e-12)


def test_small_tables() -> None:
    one = from_csv_table([2.0], [[0, 0, 3, 0]], None, None, [0.0, 2.0, 5.0])
    np.testing.assert_array_equal(one, np.tile([0, 0, 1.0, 0, 0, 0, 0, 0, 0, 0], (3, 1)))
    two = from_csv_table([0, 2], [[1, 0, 0, 0], [1, 0, 0, 1]], None, None, [0.0, 0.5, 2.0])
    np.testing.assert_allclose(two[:, 4:7], np.tile([0, 0, np.pi / 4], (3, 1)), atol=1e-12)
    still = from_csv_table(np.arange(9.0), [[1, 2, 3, 4]] * 9, None, None, np.arange(0, 8, 0.3))
    assert np.abs(still[:, 4:]).max() < 1e-12


GOOD: dict[str, Any] = {
    "t": [0.0, 1.0, 2.0],
    "q": [[1, 0, 0, 0], [1, 0.1, 0, 0], [1, 0.2, 0, 0]],
    "omega": np.zeros((3, 3)),
    "alpha": np.zeros((3, 3)),
}
BAD: list[tuple[str, Any]] = [
    ("t", [0.0, 1.0, 1.0]),
    ("t", [0.0, 2.0, 1.0]),
    ("t", [0.0, np.nan, 2.0]),
    ("t", [0.0, 1.0]),
    ("t", []),
    ("q", [[1, 0, 0, 0], [0, 0, 0, 0], [1, 0, 0, 0]]),
    ("q", [[1, 0, 0, 0], [1, np.inf, 0, 0], [1, 0, 0, 0]]),
    ("q", np.zeros((3, 3))),
    ("omega", np.full((3, 3), np.nan)),
    ("omega", np.zeros((2, 3))),
    ("alpha", np.zeros(3)),
]


@pytest.mark.parametrize(("part", "value"), BAD)
def test_tables_that_are_refused(part: str, value: Any) -> None:
    from_csv_table(**GOOD, times=[0.5])
    with pytest.raises(InputError) as refused:
        from_csv_table(**GOOD | {part: value}, times=[0.5])
    assert refused.value.key == "profile"


def test_rows_too_far_apart_for_a_curve_are_refused() -> None:
    rng = np.random.default_rng(1)
    t, q = np.sort(rng.uniform(0, 10, 12)), rng.normal(size=(12, 4))
    with pytest.raises(InputError, match="close enough"):
        from_csv_table(t, q, None, None, [5.0])
