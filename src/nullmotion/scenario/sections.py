"""Models of the sections whose keys depend on a name in them."""

from __future__ import annotations

import dataclasses
import types
import typing
from collections.abc import Mapping
from functools import cache
from typing import Any

import numpy as np
from pydantic import BeforeValidator, Field, create_model

from nullmotion import laws
from nullmotion.array import layouts
from nullmotion.scenario import schema, schema_spacecraft, schema_vscmg
from nullmotion.scenario.metric_keys import requirements_model, stop_model
from nullmotion.spacecraft import controllers

CUSTOM = "custom"


def layout_names() -> list[str]:
    """Return what ``array.layout`` may be."""
    return [*layouts.names(), CUSTOM]


def array_model(layout: str) -> type[schema.ArraySection]:
    """Return the model of ``[array]`` for a layout."""
    if layout == CUSTOM:
        return schema.CustomArraySection
    return _extended(schema.ArraySection, layouts.get(layout))  # type: ignore[arg-type]


def law_model(name: str) -> type[schema.LawSection]:
    """Return the model of ``[law]`` for a law."""
    return _extended(schema.LawSection, laws.get(name))  # type: ignore[arg-type]


def case_model(name: str) -> type[schema.CaseSection]:
    """Return the model of ``[[compare.case]]`` for a law."""
    return _extended(schema.CaseSection, laws.get(name))  # type: ignore[arg-type]


def controller_model(name: str) -> type[schema_spacecraft.ControllerSection]:
    """Return the model of ``[controller]`` for a controller."""
    return _extended(schema_spacecraft.ControllerSection, controllers.get(name))  # type: ignore[arg-type]


def file_key(field: dataclasses.Field[Any]) -> str:
    """Return the key of a parameter in files: an angle carries its unit."""
    return field.name + ("_deg" if field.metadata.get("unit") == "deg" else "")


def parameters(section: schema.Section, cls: type[Any]) -> dict[str, Any]:
    """Return the values that a file gives for the fields of a layout, law or controller, in SI."""
    return {
        f.name: _from_file(f, getattr(section, file_key(f)))
        for f in dataclasses.fields(cls)
        if section.given(file_key(f))
    }


def written(record: Any) -> dict[str, Any]:
    """Return the fields of a layout, law or controller as files have them."""
    found = {}
    for f in dataclasses.fields(record):
        value = getattr(record, f.name)
        degrees = f.metadata.get("unit") == "deg" and value is not None
        found[file_key(f)] = np.degrees(value).tolist() if degrees else value
    return found


def _from_file(field: dataclasses.Field[Any], value: Any) -> Any:
    if field.metadata.get("unit") != "deg" or value is None:
        return value
    turned = np.radians(value)
    return float(turned) if np.ndim(turned) == 0 else tuple(turned.tolist())


@cache
def _extended(base: type[Any], cls: type[Any]) -> type[Any]:
    """Return a section with the fields of a dataclass as further keys."""
    hints = typing.get_type_hints(cls, include_extras=True)
    fields: dict[str, Any] = {}
    for f in dataclasses.fields(cls):
        if f.init:
            required = f.default is dataclasses.MISSING and f.default_factory is dataclasses.MISSING
            fields[file_key(f)] = (_file_type(hints[f.name]), Field(... if required else None))
    return create_model(f"{base.__name__}_{cls.__name__}", __base__=base, **fields)


def _file_type(hint: Any) -> Any:
    """Return the type of a value in a file: lists are tuples, unknown types are not checked."""
    origin = typing.get_origin(hint)
    if hint in (float, int, bool, str) or hint is type(None) or origin is typing.Literal:
        return hint
    if origin is tuple:
        parts = typing.get_args(hint)
        found: Any = tuple[tuple(a if a is ... else _file_type(a) for a in parts)]  # type: ignore[misc]
        counted = ... not in parts
        return (
            typing.Annotated[found, BeforeValidator(schema.sized(len(parts)))] if counted else found
        )
    if origin in (typing.Union, types.UnionType):
        return typing.Union[tuple(_file_type(a) for a in typing.get_args(hint))]  # noqa: UP007
    return Any


def section_keys(data: Mapping[str, Any], path: tuple[str | int, ...]) -> list[str]:
    """Return the keys that are known in a section, given what the file names there."""
    model = model_at(data, path)
    if model is None:
        return ["case"] if path == ("compare",) else list(SECTIONS) if path == () else []
    extra = ["stop"] if path == ("simulation",) else []
    return [*model.model_fields, *extra]


def model_at(data: Mapping[str, Any], path: tuple[str | int, ...]) -> type[schema.Section] | None:
    """Return the model of the section at a path; None where there is none.

    Raises:
        UnknownNameError: If the section names a layout, law or controller that does not exist.
    """
    found: Any = data
    for part in path:
        found = found.get(part, {}) if isinstance(found, Mapping) else found[part]
    match path:
        case ("array",):
            return array_model(str(found["layout"])) if "layout" in found else schema.ArraySection
        case ("law",):
            return law_model(str(found["name"])) if "name" in found else schema.LawSection
        case ("compare", "case", int()):
            return case_model(str(found["name"])) if "name" in found else schema.CaseSection
        case ("controller",) if "name" in found:
            return controller_model(str(found["name"]))
        case ("event", int()):
            return schema_spacecraft.EventSection
        case ("simulation", "stop"):
            return stop_model()
        case ("requirements",):
            return requirements_model()
        case (str(name),):
            return _PLAIN.get(name)
    return None


_PLAIN: dict[str, type[schema.Section]] = {
    "scenario": schema.About,
    "plant": schema.PlantSection,
    "initial": schema.InitialSection,
    "mission": schema.MissionSection,
    "simulation": schema.SimulationSection,
    "spacecraft": schema_spacecraft.SpacecraftSection,
    "controller": schema_spacecraft.ControllerSection,
    "servo": schema_spacecraft.ServoSection,
    "sensors": schema_spacecraft.SensorsSection,
    "disturbance": schema_spacecraft.DisturbanceSection,
    "desaturation": schema_spacecraft.DesaturationSection,
    "reaction_wheel": schema_spacecraft.ReactionWheelSection,
    "plan": schema_spacecraft.PlanSection,
    "vscmg": schema_vscmg.VscmgSection,
}
LISTS = ("event",)
SECTIONS = (*_PLAIN, "array", "law", "requirements", *LISTS, "compare")
