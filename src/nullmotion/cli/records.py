"""What there is, as plain records for lists and JSON."""

from __future__ import annotations

import dataclasses
from typing import Any

from nullmotion import guarantee as constraint_package
from nullmotion import laws as law_package
from nullmotion import metrics as metric_package
from nullmotion.array import layouts as layout_package
from nullmotion.cli.rover_records import rovers as rovers
from nullmotion.plan import costs as cost_package
from nullmotion.scenario.load import library_names, load_scenario
from nullmotion.scenario.sections import file_key
from nullmotion.spacecraft import controllers as controller_package

LONG = ("parameters", "claims", "description", "aliases")  # in JSON only


def laws() -> list[dict[str, Any]]:
    """Return the steering laws with their claims and sources."""
    return [
        {
            "name": cls.name,
            "full_name": cls.full_name,
            "aliases": list(cls.aliases),
            "citation": cls.citation,
            "claims": [
                {"name": claim.name.lower(), "text": str(claim)} for claim in sorted(cls.claims)
            ],
            "information": list(cls.information),
            "parameters": _parameters(cls),
            "description": _first_line(cls),
        }
        for cls in map(law_package.get, law_package.names())
    ]


def layouts() -> list[dict[str, Any]]:
    """Return the array layouts."""
    return [
        {
            "name": cls.name,
            "full_name": cls.full_name,
            "citation": cls.citation,
            "parameters": _parameters(cls),
            "description": _first_line(cls),
        }
        for cls in map(layout_package.get, layout_package.names())
    ]


def constraints() -> list[dict[str, Any]]:
    """Return the constraint functions: what an array can be held to, with guarantees."""
    return [
        {
            "name": cls.name,
            "full_name": cls.full_name,
            "layout": cls.layout,
            "aliases": list(cls.aliases),
            "torque_capability_of": cls.method,
            "citation": cls.citation,
            "parameters": _parameters(cls),
            "description": _first_line(cls),
        }
        for cls in map(constraint_package.get, constraint_package.names())
    ]


def costs() -> list[dict[str, Any]]:
    """Return what a plan can maximise."""
    return [
        {
            "name": cls.name,
            "meaning": _first_line(cls),
            "citation": cls.citation,
            "parameters": _parameters(cls),
        }
        for cls in map(cost_package.get, cost_package.names())
    ]


def controllers() -> list[dict[str, Any]]:
    """Return the attitude controllers."""
    return [
        {
            "name": cls.name,
            "full_name": cls.full_name,
            "aliases": list(cls.aliases),
            "citation": cls.citation,
            "follows_profile": cls.follows_profile,
            "parameters": _parameters(cls),
            "description": _first_line(cls),
        }
        for cls in map(controller_package.get, controller_package.names())
    ]


def metrics() -> list[dict[str, Any]]:
    """Return the metrics of a run."""
    return [
        {
            "name": cls.name,
            "title": cls.title,
            "unit": cls.unit,
            "summed_up_as": [f"{r}_{cls.name}" for r in cls.reductions],
            "citation": cls.citation,
            "description": _first_line(cls),
        }
        for cls in map(metric_package.get, metric_package.names())
    ]


def papers() -> list[dict[str, Any]]:
    """Return the papers whose tables and figures can be computed again."""
    from nullmotion.papers import registry

    entries = [registry.get(name) for name in registry.names()]
    return [
        {"name": e.name, "title": getattr(e, "title", ""), "citation": getattr(e, "citation", "")}
        for e in entries
    ]


def scenarios() -> list[dict[str, Any]]:
    """Return the scenarios that come with nullmotion."""
    found = [load_scenario(name) for name in library_names()]
    return [
        {
            "name": s.name,
            "title": s.title,
            "array": s.array.layout,
            "law": s.law.name,
            "about": s.about.description,
        }
        for s in found
    ]


def _parameters(cls: type[Any]) -> list[dict[str, Any]]:
    return [
        {"key": file_key(f), "type": str(f.type), "default": _default(f)}
        for f in dataclasses.fields(cls)
    ]


def _default(field: dataclasses.Field[Any]) -> Any:
    if field.default is dataclasses.MISSING:
        return None
    if field.metadata.get("unit") == "deg" and isinstance(field.default, float):
        return round(field.default * 57.29577951308232, 10)
    return field.default


def _first_line(cls: type[Any]) -> str:
    return (cls.__doc__ or "").strip().partition("\n")[0]
