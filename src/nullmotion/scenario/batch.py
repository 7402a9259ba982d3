"""Many runs of one scenario: values by key along a run axis."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from nullmotion.errors import InputError
from nullmotion.scenario import build, keys, merge, objects, sections
from nullmotion.scenario.scenario import Scenario
from nullmotion.scenario.toml import value_text
from nullmotion.sim.batch import BatchResult, run_batch, structure
from nullmotion.sim.setup import Setup

_START, _COMMAND = "initial.gimbal_deg", "mission.hdot_Nm"
_SEARCHED = (
    ("array",),
    ("plant",),
    ("initial",),
    ("law",),
    ("mission",),
    ("simulation",),
    ("simulation", "stop"),
)


def run(
    scenario: Scenario, values: Mapping[str, Any], metrics: tuple[str, ...] | None, **options: Any
) -> BatchResult:
    """Return the metrics of the runs that values by key describe; see `simulate_batch`."""
    columns = {dotted_key(scenario, key): value for key, value in values.items()}
    count = _count(columns)
    base = build.setup(scenario, metrics)
    delta = _start(scenario, base, columns.pop(_START, None))
    hdot = _command(base, columns.pop(_COMMAND, None))
    if not columns:
        return _simulated(base, None, delta, hdot, options)
    setups = _setups(scenario, columns, count, metrics)
    together = groups(setups)
    if len(together) > 1 and options.get("history"):
        raise InputError(
            "history", options["history"], "0 when the runs differ in more than numbers"
        )
    parts = []
    for rows in together:
        picked = [setups[i] for i in rows]
        starts, commands = (None if x is None else x[rows] for x in (delta, hdot))
        parts.append(_simulated(picked[0], picked, starts, commands, options))
    return merge.merged(parts, together)


def dotted_key(scenario: Scenario, key: str) -> str:
    """Return ``section.key`` for a key that stands in one section only."""
    if "." in key:
        return key
    known = {path: sections.section_keys(scenario.source.data, path) for path in _SEARCHED}
    found = [".".join((*path, key)) for path, names in known.items() if key in names]
    if len(found) == 1:
        return found[0]
    if found:
        raise InputError(key, "(given)", f"one section; it stands in several: {', '.join(found)}")
    raise InputError(
        key, "(given)", keys.hint(key, [name for names in known.values() for name in names])
    )


def _count(columns: Mapping[str, Any]) -> int:
    """Return the number of runs that all values agree on."""
    counts = {}
    for key, value in columns.items():
        if isinstance(value, str) or not hasattr(value, "__len__"):
            raise InputError(key, value, "a list or array with one value for each run")
        counts[key] = len(value)
    if len(set(counts.values())) != 1 or 0 in counts.values():
        raise InputError("runs", counts, "the same number of runs (at least one) in every value")
    return next(iter(counts.values()))


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


def _start(scenario: Scenario, base: Setup, value: Any) -> np.ndarray | None:
    if value is None:
        return None
    n = base.array.n
    table = _table(_START, value, (n, n + len(set(scenario.array.failed_cmgs))))
    delta = objects.working(scenario.array, np.radians(table), n)
    limits = base.array.angle_limits
    out = np.flatnonzero(
        ((delta < limits[:, 0] - 1e-12) | (delta > limits[:, 1] + 1e-12)).any(axis=1)
    )
    if len(out):
        raise InputError(
            f"{_START}[{out[0]}]", table[out[0]].tolist(), "angles within array.angle_limits_deg"
        )
    return delta


def _command(base: Setup, value: Any) -> np.ndarray | None:
    return None if value is None else _table(_COMMAND, value, (base.array.m,))


def _setups(
    scenario: Scenario, columns: Mapping[str, Any], count: int, metrics: Any
) -> list[Setup]:
    """Return one setup for each run; equal values share one."""
    lists = {
        k: v.tolist() if isinstance(v, np.ndarray) else [_plain(x) for x in v]
        for k, v in columns.items()
    }
    made: dict[str, Setup] = {}
    setups = []
    for i in range(count):
        values = {key: column[i] for key, column in lists.items()}
        mark = value_text(values)
        if mark not in made:
            made[mark] = build.setup(scenario.with_values(values, f"run {i}"), metrics)
        setups.append(made[mark])
    return setups


def _plain(value: Any) -> Any:
    return value.tolist() if isinstance(value, (np.ndarray, np.generic)) else value


def groups(setups: Sequence[Setup]) -> list[np.ndarray]:
    """Return the runs that one kernel can do together."""
    known: dict[int, Any] = {}
    rows: dict[Any, list[int]] = {}
    for i, setup in enumerate(setups):
        if id(setup) not in known:
            known[id(setup)] = (type(setup.law), setup.dt, structure(setup))
        rows.setdefault(known[id(setup)], []).append(i)
    return [np.array(r) for r in rows.values()]


def _simulated(
    base: Setup, setups: Any, delta: Any, hdot: Any, options: Mapping[str, Any]
) -> BatchResult:
    if base.law.traceable:
        return run_batch(base, setups=setups, delta=delta, hdot=hdot, **options)
    return merge.one_by_one(base, setups, delta, hdot, options.get("progress"))
