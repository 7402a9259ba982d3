"""nullmotion: momentum control with control moment gyroscopes.

Everything public is reached from here and imported when first used, so that
``import nullmotion`` and ``nullmotion --help`` cost nothing.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

__version__ = "0.1.0"

_WHERE = {
    "CmgArray": "nullmotion.array.model",
    "Wheels": "nullmotion.array.wheels",
    "Layout": "nullmotion.array.layout",
    "Law": "nullmotion.law",
    "Claim": "nullmotion.law",
    "Observation": "nullmotion.law",
    "prepare": "nullmotion.prepared",
    "PreparedLaw": "nullmotion.prepared",
    "load_scenario": "nullmotion.scenario.load",
    "simulate": "nullmotion.scenario.simulate",
    "simulate_batch": "nullmotion.scenario.simulate",
    "Scenario": "nullmotion.scenario.scenario",
    "Trajectory": "nullmotion.sim.trajectory",
    "BatchResult": "nullmotion.sim.batch",
    "NullmotionError": "nullmotion.errors",
    "InputError": "nullmotion.errors",
}
_MODULES = {
    "guarantee": "nullmotion.guarantee",
    "layouts": "nullmotion.array.layouts",
    "laws": "nullmotion.laws",
    "ops": "nullmotion.ops",
    "plan": "nullmotion.plan",
    "rover": "nullmotion.rover",
    "singular_lines": "nullmotion.singular_lines",
    "singularity": "nullmotion.singularity",
    "sizing": "nullmotion.sizing",
    "vscmg": "nullmotion.vscmg",
}

__all__ = ["__version__", *_WHERE, *_MODULES]


def __getattr__(name: str) -> Any:
    if name in _MODULES:
        return import_module(_MODULES[name])
    if name in _WHERE:
        return getattr(import_module(_WHERE[name]), name)
    raise AttributeError(f"module 'nullmotion' has no attribute {name!r}")
