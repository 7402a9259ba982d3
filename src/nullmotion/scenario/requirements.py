"""Requirements: limits that numbers of a run's summary have to keep."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from nullmotion.metrics.base import Metric
from nullmotion.scenario import metric_keys
from nullmotion.scenario.scenario import Scenario
from nullmotion.scenario.toml import Path
from nullmotion.scenario.validate import Validator


def evaluate(scenario: Scenario, summary: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Return each requirement with its limit, the run's value, the margin and whether it passed.

    Args:
        scenario: What was flown.
        summary: Numbers of the run by name.

    Returns:
        ``name`` is the key in the file. ``margin`` is above 0 when the requirement passed;
        ``value`` and ``margin`` are None for what did not happen (a run that never settled),
        which fails.
    """
    if scenario.requirements is None:
        return []
    limits = metric_keys.limits(scenario.requirements)
    return [
        _judged(key, limits[key], summary.get(metric_keys.split(key)[0]))
        for key in scenario.source.data["requirements"]  # in the order of the file
    ]


def _judged(key: str, limit: float, value: Any) -> dict[str, Any]:
    found = {"name": key, "limit": limit, "value": None, "margin": None, "passed": False}
    if value is None or not math.isfinite(value):
        return found
    margin = limit - value if key.endswith("_below") else value - limit
    return found | {"value": value, "margin": margin, "passed": bool(margin > 0)}


def passed(results: list[dict[str, Any]]) -> bool | None:
    """Return whether all requirements passed; None if there are none."""
    return all(result["passed"] for result in results) if results else None


def check(scenario: Scenario, validator: Validator) -> None:
    """Add limits on what this run does not have: attitude, or wheels whose speed changes."""
    known = metric_keys.summary_names()
    required = {} if scenario.requirements is None else metric_keys.limits(scenario.requirements)
    rows: list[tuple[Path, float, type[Metric] | None]] = [
        (("requirements", k), v, known[metric_keys.split(k)[0]]) for k, v in required.items()
    ]
    stops = metric_keys.limits(scenario.stop).items()
    rows += [(("simulation", "stop", k), v, metric_keys.metric(k)) for k, v in stops]
    for path, value, metric in rows:
        if metric is None:
            continue
        if metric.needs_body and not scenario.mission.turns_body:
            kind = scenario.mission.kind
            allowed = f'only with mission.kind = "attitude" or "startup" (this is "{kind}")'
            validator.add(path, value, allowed)
        if metric.needs_wheels and not scenario.variable_speed:
            validator.add(path, value, "only with a law that turns the wheels, or [vscmg]")
