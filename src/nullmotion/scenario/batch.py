"""Many runs of one scenario: values by key along a run axis."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from nullmotion.errors import InputError
from nullmotion.scenario import build, columns, keys, merge, sections, startup
from nullmotion.scenario.scenario import Scenario
from nullmotion.scenario.toml import value_text
from nullmotion.sim.batch import BatchResult, run_batch, structure
from nullmotion.sim.setup import Setup

_NOT_SEARCHED = ("scenario", "compare", "event", "plan", "requirements")
_SEARCHED = (
    *((name,) for name in sections.SECTIONS if name not in _NOT_SEARCHED),
    ("simulation", "stop"),
)


def run(
    scenario: Scenario, values: Mapping[str, Any], metrics: tuple[str, ...] | None, **options: Any
) -> BatchResult:
    """Return the metrics of the runs that values by key describe; see `simulate_batch`."""
    given = {dotted_key(scenario, key): value for key, value in values.items()}
    count = _count(given)
    base = build.setup(scenario, metrics)
    arrays, others = columns.split(scenario, base, given)
    if not others:
        return _simulated(base, None, arrays, options)
    setups = _setups(scenario, others, count, metrics)
    together = groups(setups)
    if len(together) > 1 and options.get("history"):
        raise InputError(
            "history", options["history"], "0 when the runs differ in more than numbers"
        )
    parts = []
    for rows in together:
        picked = [setups[i] for i in rows]
        own = {key: table[rows] for key, table in arrays.items()}
        parts.append(_simulated(picked[0], picked, own, options))
    found = merge.merged(parts, together)
    if scenario.mission.kind == "startup":
        return startup.judged_batch(scenario, setups, found)
    return found


def dotted_key(scenario: Scenario, key: str) -> str:
    """Return ``section.key`` for a key that stands in one section only."""
    if "." in key:
        return key
    data = scenario.source.data
    paths = [*_SEARCHED, *(("event", i) for i in range(len(scenario.events)))]
    known = {path: sections.section_keys(data, path) for path in paths}
    found = [path for path, names in known.items() if key in names]
    found = [path for path in found if path[0] in data] or found
    dotted = sorted(".".join(map(str, (*path, key))) for path in found)
    if len(dotted) == 1:
        return dotted[0]
    if dotted:
        raise InputError(key, "(given)", f"one section; it stands in several: {', '.join(dotted)}")
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


def compiled(setup: Setup) -> bool:
    """Return whether a setup can run in a kernel."""
    return setup.law.traceable and setup.integrator != "dop853"


def _simulated(
    base: Setup, setups: Any, arrays: Mapping[str, Any], options: Mapping[str, Any]
) -> BatchResult:
    if compiled(base):
        return run_batch(base, setups=setups, **arrays, **options)
    return merge.one_by_one(base, setups, arrays, options)
