"""Plans for scenarios: what ``[plan]`` asks for, and the scenario that flies a plan."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from nullmotion.laws.follow_plan import FollowPlan
from nullmotion.plan import costs
from nullmotion.plan.result import PlanResult
from nullmotion.sim.setup import Setup

Scenario = Any  # nullmotion.scenario.Scenario, which is above this package

_TIMING = ("period_s", "delay_s")
_KEYS = {"depth": "depth", "levels": "levels", "k_max": "k_max", "lag": "lag"} | {
    "duration_s": "duration"
}


def setup_of(scenario: Scenario | str | Path) -> tuple[Setup, dict[str, Any]]:
    """Return the run of a scenario and what its section ``[plan]`` asks for.

    Args:
        scenario: A scenario, or what `nullmotion.load_scenario` takes.
    """
    from nullmotion.scenario import build, load_scenario  # above this package

    loaded = load_scenario(scenario) if isinstance(scenario, (str, Path)) else scenario
    return build.setup(loaded), wanted(loaded)


def wanted(scenario: Scenario) -> dict[str, Any]:
    """Return what ``[plan]`` asks for as arguments of `nullmotion.plan.search`."""
    section = scenario.plan
    if section is None:
        return {}
    given = {k: getattr(section, k) for k in section.model_fields_set}
    given = {k: v for k, v in given.items() if v is not None}
    if "rate_threshold_deg_s" in given:
        given["rate_threshold"] = float(np.radians(given["rate_threshold_deg_s"]))
    own = {f.name for f in dataclasses.fields(costs.get(section.cost))}
    cost = costs.create(section.cost, **{k: v for k, v in given.items() if k in own})
    return {"cost": cost} | {name: given[k] for k, name in _KEYS.items() if k in given}


def follower(result: PlanResult, scenario: Scenario) -> tuple[str, dict[str, str]]:
    """Return the scenario that flies a plan, as TOML, and the text of the files it names.

    Its law follows the plan on top of the scenario's own law; where the plan is a start,
    it begins there.
    """
    source = scenario.source
    values: dict[str, Any] = {}
    if result.delta is None:
        values["law"] = _following(result, source.data["law"])
    else:
        start = source.data.get("initial", {})
        kept = {k: v for k, v in start.items() if k not in ("gimbal_deg", "momentum_Nms")}
        values["initial"] = kept | {"gimbal_deg": tuple(np.degrees(result.delta).tolist())}
    files = {Path(name).name: text for name, text in scenario.named_files().items()}
    if files:
        values["mission.profile"] = next(iter(files))
    return source.over(values, "plan").effective_text(), files


def _following(result: PlanResult, law: Mapping[str, Any]) -> dict[str, Any]:
    planned = law["name"] == FollowPlan.name
    own = {k: v for k, v in law.items() if k not in ("name", *_TIMING)}
    return {
        "name": FollowPlan.name,
        "base": law.get("base", FollowPlan.base) if planned else law["name"],
        "knots": result.knots,
        "duration_s": result.duration_s,
        "k_max": result.k_max,
        "lag": result.lag,
        **{k: law[k] for k in _TIMING if k in law},
        "base_parameters": law.get("base_parameters", {}) if planned else own,
    }
