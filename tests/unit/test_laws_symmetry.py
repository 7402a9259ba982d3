"""Symmetries of the pyramid that laws must inherit."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from nullmotion import Observation, laws, layouts

ARRAY = layouts.create("pyramid", rate_limit=np.pi)
QUARTER = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])


def rates(law: Any, delta: Any, hdot: Any, t: float = 0.0) -> np.ndarray:
    return law.step(ARRAY, Observation(delta, hdot, t), law.init(ARRAY, delta))[0]


def states(count: int) -> list[tuple[np.ndarray, np.ndarray]]:
    rng = np.random.default_rng(11)
    draws = [(rng.uniform(-np.pi, np.pi, 4), rng.normal(size=3)) for _ in range(3 * count)]
    least = [np.linalg.svd(ARRAY.unit_jacobian(d), compute_uv=False)[-1] for d, _ in draws]
    return [draw for draw, sigma in zip(draws, least, strict=True) if sigma > 0.05][:count]


@pytest.mark.parametrize(
    ("law", "quarters"), [("pseudo-inverse", 1), ("vcbsae", 1), ("local-gradient", 1), ("nd", 2)]
)
@pytest.mark.parametrize("published", [False, True])
def test_turning_the_pyramid_renumbers_its_cmgs(law: str, quarters: int, published: bool) -> None:
    has_readings = "as_published" in laws.get(law).__dataclass_fields__
    steering = laws.create(law, **({"as_published": published} if has_readings else {}))
    turn = np.linalg.matrix_power(QUARTER, quarters)
    for delta, hdot in states(30):
        here = rates(steering, delta, hdot)
        there = rates(steering, np.roll(delta, quarters), turn @ hdot)
        np.testing.assert_allclose(
            there, np.roll(here, quarters), atol=1e-9 * (1 + abs(here).max())
        )


def test_a_half_of_the_turn_reverses_non_directional_null_motion() -> None:
    law = laws.create("nd")
    for delta, _ in states(10):
        here = rates(law, delta, np.zeros(3))
        there = rates(law, np.roll(delta, 1), np.zeros(3))
        np.testing.assert_allclose(there, -np.roll(here, 1), atol=1e-9)


def test_odsr1_and_odsr2_swap_in_the_mirror() -> None:
    mirror = [1, 0, 3, 2]
    first = laws.create("odsr", w=(0.01, 1.0, 1.0, 1.0), as_published=True)
    second = laws.create("odsr", w=(1.0, 0.01, 1.0, 1.0), as_published=True)
    for k, (delta, hdot) in enumerate(states(30)):
        here = rates(first, delta, hdot, 0.1 * k)
        there = rates(second, -delta[mirror], -hdot[[1, 0, 2]], 0.1 * k)
        np.testing.assert_allclose(there, -here[mirror], atol=1e-9 * (1 + abs(here).max()))


def test_symmetry_stays_exact_through_the_pseudo_inverse() -> None:
    """Gimbals that stand still by symmetry get zero, not rounding, on both paths."""
    law = laws.create("pseudo-inverse")
    rng = np.random.default_rng(2)
    for angle in rng.uniform(-np.pi, np.pi, 50):
        got = rates(law, np.array([-angle, 0.0, angle, 0.0]), np.array([1.0, 0.0, 0.0]))
        assert got[1] == got[3] == 0.0
        assert got[0] == -got[2]
