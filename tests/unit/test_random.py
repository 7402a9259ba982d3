"""Random numbers of traced source against the published generator and statistics."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
from scipy import stats

from nullmotion.compile import compile_function
from nullmotion.errors import InputError
from nullmotion.spacecraft.random import M1, M2, normals, seeded, uniform

# of L'Ecuyer's RngStreams, every word of the state 12345: the first five, the thousandth
PUBLISHED = [
    0.12701112204657714,
    0.3185275653967945,
    0.30918601558327008,
    0.82584686292711362,
    0.2216299157820229,
]
THOUSANDTH = 0.98607848680213228


def integers(state: Any, count: int) -> tuple[list[int], list[int]]:
    """Return z_n of MRG32k3a by whole numbers of Python, u_n = z_n / (m1 + 1), and the state."""
    m1, m2 = 2**32 - 209, 2**32 - 22853
    x, y = [int(v) for v in state[:3]], [int(v) for v in state[3:]]
    out = []
    for _ in range(count):
        x.append((1403580 * x[-2] - 810728 * x[-3]) % m1)
        y.append((527612 * y[-1] - 1370589 * y[-3]) % m2)
        out.append((x[-1] - y[-1]) % m1 or m1)
    return out, x[-3:] + y[-3:]


def drawn(state: Any, count: int) -> tuple[np.ndarray, Any]:
    values = []
    for _ in range(count):
        u, state = uniform(state)
        values.append(u)
    return np.array(values), state


@cache
def kernel(draw: Any, count: int, fuse: bool = True) -> Any:
    return compile_function(lambda s: draw(s, count), np.zeros(6), fuse=fuse)


def starts(count: int) -> np.ndarray:
    return np.array([seeded(i) for i in range(count)])


def test_first_numbers_are_the_published_ones() -> None:
    values, _ = drawn(np.full(6, 12345.0), 1000)
    assert values[:5].tolist() == PUBLISHED
    assert values[999] == THOUSANDTH


@pytest.mark.parametrize("seed", [0, 1, 2**40])
def test_numbers_are_exactly_those_of_whole_numbers(seed: int) -> None:
    values, state = drawn(seeded(seed), 10_000)
    expected, after = integers(seeded(seed), 10_000)
    assert np.rint(values * (M1 + 1.0)).tolist() == expected
    assert values.tolist() == [z * (1.0 / (M1 + 1.0)) for z in expected]
    assert state.tolist() == after


def extremes() -> np.ndarray:
    """Return states whose products and quotients are as large as they get."""
    ends = [[0.0, 1.0, M1 - 1.0, (M1 - 1.0) / 2.0], [0.0, 1.0, M2 - 1.0, (M2 - 1.0) / 2.0]]
    return np.array(np.meshgrid(*[ends[0]] * 3, *[ends[1]] * 3)).reshape(6, -1).T


@pytest.mark.parametrize("fuse", [True, False])
def test_compiled_numbers_are_the_same(fuse: bool) -> None:
    state = np.concatenate([extremes(), starts(500)])
    values, after = kernel(drawn, 20, fuse)(state)
    for i in range(0, len(state), 7):
        expected, last = integers(state[i], 20)
        assert values[i].tolist() == [z * (1.0 / (M1 + 1.0)) for z in expected]
        assert after[i].tolist() == last
        assert drawn(state[i], 20)[0].tolist() == values[i].tolist()


def test_compiled_normals_agree_with_floats() -> None:
    state = starts(500)
    values, after = kernel(normals, 5)(state)
    assert values.shape == (500, 5) and kernel(normals, 5).program.guards == {}
    for row, s, last in zip(values, state, after, strict=True):
        expected, moved = normals(s, 5)
        np.testing.assert_allclose(row, expected, rtol=1e-13, atol=1e-14)
        np.testing.assert_array_equal(last, moved)


def test_normals_take_two_uniforms_for_each_pair() -> None:
    start = seeded(8)
    for count, uniforms in ((0, 0), (1, 2), (2, 2), (3, 4), (6, 6)):
        values, after = normals(start, count)
        assert values.shape == (count,)
        np.testing.assert_array_equal(after, drawn(start, uniforms)[1])
    np.testing.assert_array_equal(normals(start, 3)[0], normals(start, 4)[0][:3])


@cache
def many() -> np.ndarray:
    """Return 10^5 normals: 10 draws of 10 on 1000 streams, (1000, 100)."""
    state, rows = np.array([seeded(2024, stream) for stream in range(1000)]), []
    for _ in range(10):
        values, state = kernel(normals, 10)(state)
        rows.append(values)
    return np.concatenate(rows, axis=1)


def test_normals_are_normal() -> None:
    values = many().ravel()
    assert len(values) == 100_000
    assert stats.kstest(values, "norm").pvalue > 0.01
    assert abs(values.mean()) < 4.0 / np.sqrt(len(values))
    assert values.var() == pytest.approx(1.0, abs=4.0 * np.sqrt(2.0 / len(values)))
    assert stats.skew(values) == pytest.approx(0.0, abs=4.0 * np.sqrt(6.0 / len(values)))
    assert stats.kurtosis(values) == pytest.approx(0.0, abs=4.0 * np.sqrt(24.0 / len(values)))
    # one stream over time, too
    assert stats.kstest(normals(seeded(5), 2000)[0], "norm").pvalue > 0.01


def test_uniforms_are_uniform() -> None:
    values, _ = kernel(drawn, 50)(starts(2000))
    assert values.min() > 0.0 and values.max() < 1.0
    assert stats.kstest(values.ravel(), "uniform").pvalue > 0.01


def largest_correlation(rows: np.ndarray) -> float:
    """Return the largest correlation of two rows, in standard deviations of chance."""
    found = np.corrcoef(rows) - np.eye(len(rows))
    return float(np.abs(found).max() * np.sqrt(rows.shape[1]))


def test_draws_of_one_call_are_independent() -> None:
    values = many().reshape(-1, 10).T
    assert largest_correlation(values) < 4.0
    assert largest_correlation(values**2) < 4.0


def test_seeds_and_streams_are_independent() -> None:
    state = np.array([seeded(i, j) for i in range(15) for j in range(2)])
    assert len(np.unique(state)) == state.size
    rows = []
    for _ in range(40):
        values, state = kernel(drawn, 50)(state)
        rows.append(values)
    assert largest_correlation(np.concatenate(rows, axis=1)) < 4.5


def test_seeded_states_are_valid_and_repeat() -> None:
    state = starts(2000)
    assert np.array_equal(state, np.rint(state)) and state.min() >= 1.0
    assert state[:, :3].max() < M1 and state[:, 3:].max() < M2
    np.testing.assert_array_equal(seeded(np.int64(7), 3), seeded(7, 3))


@pytest.mark.parametrize(("seed", "stream", "key"), [(-1, 0, "seed"), (0, -1, "stream")])
def test_refusals(seed: int, stream: int, key: str) -> None:
    with pytest.raises(InputError) as refused:
        seeded(seed, stream)
    assert refused.value.key == key
    for wrong in (1.0, True, "1", None):
        with pytest.raises(InputError):
            seeded(wrong)  # type: ignore[arg-type]
