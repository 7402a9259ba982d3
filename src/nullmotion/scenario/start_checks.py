"""Checks of the state that a run starts from."""

from __future__ import annotations

import numpy as np

from nullmotion.array import CmgArray
from nullmotion.errors import InputError
from nullmotion.scenario import mission_checks, objects, start
from nullmotion.scenario.schema import ArraySection, InitialSection
from nullmotion.scenario.validate import Validator


def check(section: ArraySection, initial: InitialSection, array: CmgArray, v: Validator) -> None:
    """Note gimbal angles or a momentum that the array cannot start from."""
    angles = initial.gimbal_deg
    total = array.n + len(set(section.failed_cmgs))
    if angles is not None and len(angles) not in (array.n, total):
        v.add(
            ("initial", "gimbal_deg"),
            angles,
            f"{_counts(array.n, total)} numbers, one for each CMG (this has {len(angles)})",
        )
        return
    if initial.momentum_Nms is not None:
        _check_momentum(section, initial, array, v)
        return
    delta = objects.start(section, angles, array.n)
    low, high = array.angle_limits[:, 0], array.angle_limits[:, 1]
    if np.any((delta < low - 1e-12) | (delta > high + 1e-12)):
        value = np.round(np.degrees(delta), 6).tolist() if angles is None else angles
        v.add(("initial", "gimbal_deg"), value, "angles within array.angle_limits_deg")


def _check_momentum(
    section: ArraySection, initial: InitialSection, array: CmgArray, v: Validator
) -> None:
    path = ("initial", "momentum_Nms")
    assert initial.momentum_Nms is not None
    if initial.gimbal_deg is not None:
        v.add(path, initial.momentum_Nms, "give one of gimbal_deg and momentum_Nms")
    elif mission_checks.torque_dimensions(v, path, initial.momentum_Nms, array.m):
        try:
            start.angles(section, initial, array)
        except InputError as error:
            v.add(path, error.value, error.allowed)


def _counts(n: int, total: int) -> str:
    return str(n) if n == total else f"{n} or {total}"
