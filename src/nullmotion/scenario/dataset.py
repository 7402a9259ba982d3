"""What tells how a run came about: attributes, parameters with defaults put in, versions."""

from __future__ import annotations

import dataclasses
import json
import platform
import sys
from importlib.metadata import PackageNotFoundError, version
from typing import Any

import numpy as np

from nullmotion.scenario import metric_keys, sections
from nullmotion.scenario.scenario import Scenario
from nullmotion.scenario.variables import CONVENTIONS, WITH_BODY
from nullmotion.scenario.variables_vscmg import WITH_WHEELS
from nullmotion.sim.trajectory import Trajectory

_SECTIONS = (
    "array",
    "plant",
    "initial",
    "mission",
    "simulation",
    "spacecraft",
    "servo",
    "sensors",
    "disturbance",
    "desaturation",
    "reaction_wheel",
    "plan",
    "vscmg",
)


def attributes(
    trajectory: Trajectory, scenario: Scenario | None = None, law_file: str = ""
) -> dict[str, str]:
    """Return what tells how a run came about: text, all of it."""
    found = {
        "title": scenario.title
        if scenario
        else f"{trajectory.setup.law.name} on {trajectory.setup.array.label}",
        "source": f"nullmotion {versions()['nullmotion']}",
        "conventions": _conventions(trajectory),
        "law": trajectory.setup.law.name,
        "stop_reason": trajectory.stop_reason,
        "status": ", ".join(trajectory.status) or "ok",
        "summary": json.dumps(plain(trajectory.summary())),
        "parameters": json.dumps(plain(resolved(trajectory, scenario))),
        "backend": trajectory.backend,
        "instruction_set": trajectory.instruction_set,
        **{f"{name}_version": text for name, text in versions().items()},
        "platform": platform.platform(),
    }
    if scenario is None:
        return found
    return found | {
        "scenario": scenario.source.effective_text(),
        "scenario_name": scenario.source.name,
        "scenario_files": json.dumps(scenario.named_files()),
        "seed": str(scenario.plant.seed if scenario.plant else 0),
        "law_file": law_file,
    }


def _conventions(trajectory: Trajectory) -> str:
    setup = trajectory.setup
    body, wheels = bool(setup.spacecraft), setup.variable_speed
    return CONVENTIONS + (WITH_BODY if body else "") + (WITH_WHEELS if wheels else "")


def resolved(trajectory: Trajectory, scenario: Scenario | None) -> dict[str, Any]:
    """Return all parameters of a run, defaults put in."""
    setup = trajectory.setup
    found: dict[str, Any] = {"law": {"name": setup.law.name, **dataclasses.asdict(setup.law)}}
    if scenario is None:
        return found
    for name in _SECTIONS:
        section = getattr(scenario, name)
        found[name] = None if section is None else section.model_dump()
    for name, section in (("stop", scenario.stop), ("requirements", scenario.requirements)):
        found[name] = {} if section is None else metric_keys.limits(section)
    found["event"] = [event.model_dump() for event in scenario.events]
    found["array"] |= scenario.layout_parameters()
    found["law"] |= {"period_s": setup.period, "delay_s": scenario.law.delay_s}
    found["initial"] = {"gimbal_deg": np.degrees(setup.delta)}
    if setup.variable_speed:
        found["initial"]["wheel_speed_rad_s"] = setup.wheel_speed
    if setup.spacecraft is not None and setup.controller is not None:
        craft = {"inertia_kg_m2": setup.spacecraft.inertia, "q_BN": setup.spacecraft.q_BN}
        found["spacecraft"] |= {**craft, "euler_321_deg": None}
        found["controller"] = {
            "name": setup.controller.name,
            **sections.written(setup.controller),
        }
    return found


def versions() -> dict[str, str]:
    """Return the versions of what computes."""
    import nullmotion

    found = {"nullmotion": nullmotion.__version__}
    for name in ("numpy", "llvmlite"):
        try:
            found[name] = version(name)
        except PackageNotFoundError:  # pragma: no cover
            found[name] = "unknown"
    return found | {"python": sys.version.split()[0]}


def plain(value: Any) -> Any:
    """Return a value as JSON has it: lists and numbers, null for what is not finite."""
    if isinstance(value, dict):
        return {str(k): plain(v) for k, v in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(v) for v in value]
    if isinstance(value, np.ndarray):
        return plain(value.tolist())
    if isinstance(value, np.generic):
        return plain(value.item())
    if isinstance(value, float):
        return value if np.isfinite(value) else None
    return value if value is None or isinstance(value, (str, int)) else str(value)
