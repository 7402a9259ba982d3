"""Values of a batch that go to the kernel as arrays, without a scenario for each run."""

from __future__ import annotations

import inspect
from collections.abc import Mapping
from typing import Any

import numpy as np

from nullmotion import rotation
from nullmotion.errors import InputError
from nullmotion.scenario import attitude, objects
from nullmotion.scenario.scenario import Scenario
from nullmotion.sim.batch import run_batch
from nullmotion.sim.setup import Setup

_ARGUMENTS = {
    "initial.gimbal_deg": "delta",
    "mission.hdot_Nm": "hdot",
    "mission.target_q_BN": "target",
    "mission.target_euler_321_deg": "target",
    "spacecraft.q_BN": "q_BN",
    "spacecraft.euler_321_deg": "q_BN",
    "spacecraft.omega_BN_B": "omega_BN_B",
}


def split(
    scenario: Scenario, base: Setup, given: Mapping[str, Any]
) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
    """Return arrays by argument of `run_batch`, and the values that need a scenario each.

    Raises:
        InputError: For shapes and numbers that cannot be.
    """
    known = inspect.signature(run_batch).parameters
    arrays, others = {}, {}
    for key, value in given.items():
        argument = _ARGUMENTS.get(key, "")
        twice = [k for k in given if _ARGUMENTS.get(k) == argument]
        if argument in known and len(twice) == 1 and _is_free(scenario, base, argument):
            arrays[argument] = _array(scenario, base, key, value)
        else:
            others[key] = value
    return arrays, others


def _is_free(scenario: Scenario, base: Setup, argument: str) -> bool:
    """Return whether an argument can change without anything else that depends on it.

    In a startup all do: its momentum budget is checked for each run.
    """
    mission = scenario.mission
    if mission.kind == "startup":
        return False
    match argument:
        case "delta":
            return scenario.vscmg is None  # inertia without units depends on the angles
        case "hdot":
            return mission.kind == "momentum-rate"
        case "target":
            return base.target is not None
        case "q_BN":
            return base.spacecraft is not None and mission.slew_time_s is None
        case "omega_BN_B":
            return base.spacecraft is not None
    return True


def _array(scenario: Scenario, base: Setup, key: str, value: Any) -> np.ndarray:
    if key == "initial.gimbal_deg":
        return _start(scenario, base, key, value)
    if key.endswith("euler_321_deg"):
        angles = np.radians(_table(key, value, (3,)))
        return np.array([rotation.from_euler_321(row) for row in angles])
    if key.endswith("q_BN"):
        return _quaternions(key, _table(key, value, (4,)))
    return _table(key, value, (base.array.m,))


def _table(key: str, value: Any, widths: tuple[int, ...]) -> np.ndarray:
    try:
        table = np.asarray(value, float)
    except (TypeError, ValueError):
        raise InputError(key, type(value).__name__, "numbers, one row for each run") from None
    if table.ndim != 2 or table.shape[1] not in widths:
        raise InputError(
            key, table.shape, f"shape (runs, {' or '.join(map(str, sorted(set(widths))))})"
        )
    bad = np.flatnonzero(~np.isfinite(table).all(axis=1))
    if len(bad):
        raise InputError(f"{key}[{bad[0]}]", table[bad[0]].tolist(), "finite numbers")
    return table


def _quaternions(key: str, table: np.ndarray) -> np.ndarray:
    length = np.linalg.norm(table, axis=1, keepdims=True)
    none = np.flatnonzero(length[:, 0] < attitude.LEAST_LENGTH)
    if len(none):
        allowed = "a quaternion that is not zero"
        raise InputError(f"{key}[{none[0]}]", table[none[0]].tolist(), allowed)
    unit: np.ndarray = table / length
    return unit


def _start(scenario: Scenario, base: Setup, key: str, value: Any) -> np.ndarray:
    n = base.array.n
    table = _table(key, value, (n, n + len(set(scenario.array.failed_cmgs))))
    delta = objects.working(scenario.array, np.radians(table), n)
    limits = base.array.angle_limits
    out = np.flatnonzero(
        ((delta < limits[:, 0] - 1e-12) | (delta > limits[:, 1] + 1e-12)).any(axis=1)
    )
    if len(out):
        raise InputError(
            f"{key}[{out[0]}]", table[out[0]].tolist(), "angles within array.angle_limits_deg"
        )
    return delta
