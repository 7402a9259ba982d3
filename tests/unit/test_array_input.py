"""Bad input to an array: refused with the key, the value and what is allowed."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import nullmotion as nm

G = [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]
S = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
GOOD: dict[str, Any] = {"gimbal_axes": G, "spin_axes": S}
NAN, INF = np.nan, np.inf

CASES: list[tuple[str, Any, str, str]] = [
    # argument, value, key in the message, what the message says is allowed
    ("gimbal_axes", [[0, 0, 1.1], [1, 0, 0]], "gimbal_axes[0]", "unit vector"),
    ("gimbal_axes", [[0, 0, 1], [0, 0, 0]], "gimbal_axes[1]", "unit vector"),
    ("gimbal_axes", [[0, 0, 1], [1, NAN, 0]], "gimbal_axes", "finite"),
    ("gimbal_axes", [[0, 0, 1], [1, INF, 0]], "gimbal_axes", "finite"),
    ("gimbal_axes", [[0, 1], [1, 0]], "gimbal_axes", "3 numbers"),
    ("gimbal_axes", [[0, 0, 1], [1, 0]], "gimbal_axes", "three numbers"),
    ("gimbal_axes", "z", "gimbal_axes", "three numbers"),
    ("gimbal_axes", [], "gimbal_axes", "3 numbers"),
    ("spin_axes", [[1, 0, 0]], "spin_axes", "2 x 3 numbers"),
    ("spin_axes", [[1, 0, 0], [0, 2, 0]], "spin_axes[1]", "unit vector"),
    ("spin_axes", [[1, 0, 0], [1, 0, 0]], "spin_axes[1]", "parallel"),
    ("spin_axes", [[0.6, 0, 0.8], [0, 1, 0]], "spin_axes[0]", "not perpendicular"),
    ("spin_axes", [[1, 0, 0], [0, NAN, 1]], "spin_axes", "finite"),
    ("h0", -1.0, "h0", "not negative"),
    ("h0", [1.0, -0.1], "h0", "not negative"),
    ("h0", 0.0, "h0", "at least one CMG with momentum"),
    ("h0", NAN, "h0", "not negative"),
    ("h0", INF, "h0", "finite"),
    ("h0", [1.0, 1.0, 1.0], "h0", "one number or 2"),
    ("h0", "heavy", "h0", "one number or 2"),
    ("rate_limit", 0.0, "rate_limit", "above 0"),
    ("rate_limit", [1.0, -2.0], "rate_limit", "above 0"),
    ("rate_limit", NAN, "rate_limit", "above 0"),
    ("rate_limit", [1.0] * 3, "rate_limit", "one number or 2"),
    ("rate_limit_mode", "squash", "rate_limit_mode", "'scale' or 'clip'"),
    ("angle_limits", [1.0, -1.0], "angle_limits", "lowest below highest"),
    ("angle_limits", [1.0, 1.0], "angle_limits", "lowest below highest"),
    ("angle_limits", [NAN, 1.0], "angle_limits", "lowest below highest"),
    ("angle_limits", [1.0, 2.0, 3.0], "angle_limits", "two numbers, or 2 x 2"),
    ("angle_limits", "none", "angle_limits", "two numbers, or 2 x 2"),
    ("momentum_bias", [1.0, 2.0], "momentum_bias", "1 x 3 numbers"),
    ("momentum_bias", [0.0, NAN, 0.0], "momentum_bias", "finite"),
    ("torque_axes", [[1, 0, 0], [1, 0, 0]], "torque_axes", "orthonormal"),
    ("torque_axes", [[2, 0, 0]], "torque_axes", "orthonormal"),
    ("torque_axes", [[1, 0], [0, 1]], "torque_axes", "3 numbers"),
    ("torque_axes", np.eye(3)[[0, 1, 2, 0]], "torque_axes", "orthonormal"),
]


@pytest.mark.parametrize(("argument", "value", "key", "allowed"), CASES)
def test_refused(argument: str, value: Any, key: str, allowed: str) -> None:
    with pytest.raises(nm.InputError) as caught:
        nm.CmgArray(**(GOOD | {argument: value}))
    error, message = caught.value, str(caught.value)
    assert error.key == key and key in message
    assert repr(error.value) in message
    assert allowed in error.allowed and error.allowed in message
    assert isinstance(error, nm.NullmotionError)


def test_the_good_array_is_good() -> None:
    array = nm.CmgArray(**GOOD)
    assert (array.n, array.m) == (2, 3)


@pytest.mark.parametrize("failed", [-1, 4, [], [0, 0], [0, 1, 2, 3], [1, 7]])
def test_impossible_failures(failed: Any) -> None:
    with pytest.raises(nm.InputError, match="indices 0 to 3, at least one CMG left"):
        nm.layouts.pyramid().without(failed)


@pytest.mark.parametrize("angle", [np.nan, np.inf, [0.1, 0.2, 0.3], "up"])
def test_impossible_frozen_angles(angle: Any) -> None:
    with pytest.raises(nm.InputError, match="frozen_at"):
        nm.layouts.pyramid().without([0, 1], frozen_at=angle)


def test_inputs_are_copied() -> None:
    gimbal = np.array(G)
    array = nm.CmgArray(gimbal, S)
    gimbal[:] = 0
    assert np.array_equal(array.gimbal_axes, G)
