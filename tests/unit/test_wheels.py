"""The flywheels of variable-speed CMGs: what their motors can do, and as part of an array."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nullmotion import CmgArray, InputError, layouts, tree
from nullmotion.array.wheels import Wheels
from nullmotion.compile import compile_function

I_W = 6.95e-4


def test_one_number_serves_all_and_lists_one_each() -> None:
    wheels = Wheels(np.array(I_W), torque_limit=np.array([1.0, 2.0, 3.0]))
    assert wheels.inertia.tolist() == [I_W] * 3
    assert wheels.torque_limit.tolist() == [1.0, 2.0, 3.0]
    assert np.isinf(wheels.speed_limit).all() and np.isinf(wheels.power_limit).all()
    four = Wheels(np.array(I_W)).for_n(4)
    assert all(getattr(four, key).shape == (4,) for key in four.__dataclass_fields__)
    kept = wheels.kept([0, 2])
    assert kept.torque_limit.tolist() == [1.0, 3.0] and kept.inertia.shape == (2,)


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("inertia", 0.0),
        ("inertia", -1.0),
        ("inertia", np.inf),
        ("inertia", np.nan),
        ("torque_limit", -1e-3),
        ("speed_limit", -1.0),
        ("power_limit", -1.0),
        ("torque_limit", np.nan),
        ("torque_limit", [1.0, 2.0, 3.0]),
    ],
)
def test_what_cannot_be_is_refused_by_its_key(key: str, value: Any) -> None:
    fields = {"inertia": np.full(4, I_W)} | {key: np.array(value)}
    if key == "inertia":
        fields["inertia"] = np.array(value)
    with pytest.raises(InputError, match=f"wheels.{key}"):
        Wheels(**fields)


def test_an_array_has_as_many_wheels_as_cmgs() -> None:
    with pytest.raises(InputError, match="wheels"):
        CmgArray(*layouts.get("pyramid")().axes(), wheels=Wheels(np.full(3, I_W)))


def test_the_torque_limit_is_over_the_inertia() -> None:
    wheels = Wheels(np.array([1e-3, 2e-3]), torque_limit=np.array([5e-3, 0.0]))
    low, high = wheels.bounds(np.array([100.0, 100.0]), 0.01)
    np.testing.assert_allclose(high, [5.0, 0.0])
    np.testing.assert_allclose(low, [-5.0, 0.0])


def test_the_power_limit_bounds_torque_times_speed_whatever_the_sign() -> None:
    wheels = Wheels(np.full(3, 1e-3), torque_limit=np.array(0.1), power_limit=np.array(2.0))
    speed = np.array([10.0, 200.0, -400.0])
    np.testing.assert_allclose(wheels.greatest(speed), [0.1, 0.01, 0.005])
    low, high = wheels.bounds(speed, 0.01)
    np.testing.assert_allclose(high, [100.0, 10.0, 5.0])
    np.testing.assert_allclose(low, -high)
    still = wheels.greatest(np.zeros(3))
    np.testing.assert_allclose(still, 0.1)  # at rest power limits nothing


def test_the_speed_limit_is_reached_and_not_passed() -> None:
    wheels = Wheels(np.full(4, 1e-3), speed_limit=np.array(300.0))
    speed, period = np.array([0.0, 299.0, 300.0, -300.0]), 0.5
    low, high = wheels.bounds(speed, period)
    np.testing.assert_allclose(speed + period * high, 300.0)
    np.testing.assert_allclose(speed + period * low, -300.0)
    assert high[2] == 0.0 and low[3] == 0.0


def test_a_wheel_that_is_too_fast_is_slowed_as_its_motor_can() -> None:
    wheels = Wheels(
        np.full(3, 1e-3), torque_limit=np.array([1e-3, np.inf, 0.0]), speed_limit=np.array(300.0)
    )
    low, high = wheels.bounds(np.full(3, 310.0), 0.1)
    np.testing.assert_allclose(high, [-1.0, -100.0, 0.0])
    np.testing.assert_allclose(low, [-1.0, -6100.0, 0.0])


wheel_numbers = st.tuples(
    st.floats(1e-5, 1.0),
    st.floats(0.0, 1.0) | st.just(np.inf),
    st.floats(1.0, 1e3) | st.just(np.inf),
    st.floats(0.0, 10.0) | st.just(np.inf),
    st.floats(-1.0, 1.0),
    st.floats(1e-4, 10.0),
)


@settings(deadline=None)
@given(wheel_numbers)
def test_bounds_are_what_every_limit_allows_together(drawn: tuple[float, ...]) -> None:
    inertia, torque, fastest, power, share, period = drawn
    wheels = Wheels(*(np.array([x]) for x in (inertia, torque, fastest, power)))
    speed = np.array([share * min(fastest, 1e3)])
    low, high = wheels.bounds(speed, period)
    assert low <= 0.0 <= high
    for a in (low[0], high[0]):
        if not np.isfinite(a):
            assert np.isinf([torque, fastest]).all() and (speed == 0.0 or np.isinf(power))
            continue
        slack = 1.0 + 1e-12
        assert abs(inertia * a) <= torque * slack
        if abs(speed[0]) > 1e-9:
            assert abs(inertia * a * speed[0]) <= power * slack + 1e-300
        assert abs(speed[0] + period * a) <= fastest * slack


def test_bounds_run_in_a_kernel(rng: np.random.Generator) -> None:
    wheels = Wheels(
        np.full(4, I_W), np.array([5e-3, 0.0, np.inf, 1e-2]), np.array(300.0), np.array(1.0)
    ).for_n(4)

    def both(given: Wheels, speed: Any, period: Any) -> Any:
        return np.concatenate(given.bounds(speed, period))

    compiled = compile_function(both, wheels, np.zeros(4), 0.01)
    speed = rng.uniform(-310.0, 310.0, (50, 4))
    leaves = np.tile(np.array(tree.flatten(wheels), float), (50, 1))
    found = compiled(leaves, speed, np.full(50, 0.1))
    expected = [np.concatenate(wheels.bounds(row, 0.1)) for row in speed]
    np.testing.assert_allclose(found, expected, rtol=1e-14)


def test_the_array_knows_the_speed_it_was_designed_for() -> None:
    inertia = np.array([1e-3, 2e-3, 3e-3, 4e-3])
    array = CmgArray(*layouts.get("pyramid")().axes(), h0=0.6, wheels=Wheels(inertia))
    np.testing.assert_allclose(array.design_speed, [600.0, 300.0, 200.0, 150.0])
    assert array.flywheels is array.wheels
    without = array.without(1)
    assert without.wheels is not None
    np.testing.assert_allclose(without.wheels.inertia, inertia[[0, 2, 3]])
    with pytest.raises(InputError, match="array.wheels"):
        _ = layouts.create("pyramid").flywheels


def test_axes_of_the_wheels_by_turning_them(rng: np.random.Generator) -> None:
    """C_W is s turned about g by delta, C_T its derivative, A = C_T diag(h0)."""
    for layout in layouts.names():
        array = layouts.create(layout, h0=2.5)
        delta = rng.uniform(-np.pi, np.pi, array.n)
        turned = []
        for d, g, s in zip(delta, array.gimbal_axes, array.spin_axes, strict=True):
            K = np.array([[0, -g[2], g[1]], [g[2], 0, -g[0]], [-g[1], g[0], 0]])
            turned.append((np.eye(3) + np.sin(d) * K + (1 - np.cos(d)) * K @ K) @ s)
        basis = array.torque_axes
        np.testing.assert_allclose(
            array.wheel_axes(delta), basis @ np.transpose(turned), atol=1e-14
        )
        across = np.cross(array.gimbal_axes, turned)
        found = array.transverse_directions(delta)
        np.testing.assert_allclose(found, basis @ across.T, atol=1e-14)
        np.testing.assert_allclose(array.jacobian(delta), 2.5 * found, atol=1e-14)
        many = rng.uniform(-np.pi, np.pi, (3, array.n))
        each = [array.wheel_axes(row) for row in many]
        np.testing.assert_allclose(array.wheel_axes(many), each, atol=1e-15)
