"""Tables that are made from the registries and from the schema of scenario files."""

from __future__ import annotations

import dataclasses
import inspect
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from nullmotion import guarantee, layouts, metrics, papers
from nullmotion.compile import elementary
from nullmotion.metrics.base import PLAIN
from nullmotion.plan import costs
from nullmotion.scenario import (
    library_names,
    load_scenario,
    schema,
    schema_spacecraft,
    schema_vscmg,
    sections,
)
from nullmotion.spacecraft import controllers

_SECTIONS: dict[str, type[schema.Section]] = {
    "[scenario]": schema.About,
    "[array]": schema.ArraySection,
    "[plant]": schema.PlantSection,
    "[initial]": schema.InitialSection,
    "[law]": schema.LawSection,
    "[mission]": schema.MissionSection,
    "[spacecraft]": schema_spacecraft.SpacecraftSection,
    "[controller]": schema_spacecraft.ControllerSection,
    "[servo]": schema_spacecraft.ServoSection,
    "[vscmg]": schema_vscmg.VscmgSection,
    "[sensors]": schema_spacecraft.SensorsSection,
    "[disturbance]": schema_spacecraft.DisturbanceSection,
    "[desaturation]": schema_spacecraft.DesaturationSection,
    "[reaction_wheel]": schema_spacecraft.ReactionWheelSection,
    "[[event]]": schema_spacecraft.EventSection,
    "[simulation]": schema.SimulationSection,
    "[plan]": schema_spacecraft.PlanSection,
    "[[compare.case]]": schema.CaseSection,
}
_BESIDE = {
    "[array]": "the parameters of the layout: see [the layouts](arrays.md#layouts)",
    "[law]": "the parameters of the law: see [its page](laws/index.md)",
    "[[compare.case]]": "the parameters of the law: see [its page](laws/index.md)",
    "[controller]": "the parameters of the controller: see [attitude](attitude.md#controllers)",
}
_WORDS = {
    "number": "number",
    "integer": "whole number",
    "string": "text",
    "boolean": "true or false",
    "object": "section",
}
_BOUNDS = {"minimum": "from", "exclusiveMinimum": "above", "exclusiveMaximum": "below"}


def table(heads: Sequence[str], rows: Iterable[Sequence[Any]]) -> Iterator[str]:
    """Return the lines of a Markdown table."""
    yield "| " + " | ".join(heads) + " |"
    yield "|" + "---|" * len(heads)
    for row in rows:
        yield "| " + " | ".join(str(cell).replace("|", "\\|") for cell in row) + " |"


def summary(entry: Any) -> str:
    """Return the first line of a docstring, without its full stop."""
    return (entry.__doc__ or "").strip().split("\n")[0].rstrip(".").replace("``", "`")


def layout_table() -> Iterable[str]:
    """Return the layouts with their parameters in files."""
    rows = []
    for layout in map(layouts.get, layouts.names()):
        array, fields = layouts.create(layout.name), dataclasses.fields(layout)
        keys = ", ".join(f"`{sections.file_key(f)} = {_in_file(f)}`" for f in fields)
        rows.append((f"`{layout.name}`", array.n, array.m, keys, summary(layout), layout.citation))
    return table(("Layout", "n", "m", "Parameters", "Geometry", "Source"), rows)


def _in_file(field: dataclasses.Field[Any]) -> str:
    degrees = field.metadata.get("unit") == "deg"
    return f"{np.degrees(field.default) if degrees else field.default:.6g}"


def metric_table() -> Iterable[str]:
    """Return the metrics with the names of their sums."""
    rows = []
    for metric in map(metrics.get, metrics.names()):
        sums = ", ".join(
            f"`{metric.name}`" if reduction in PLAIN else f"`{reduction}_{metric.name}`"
            for reduction in metric.reductions
        )
        rows.append((metric.title, sums, metric.unit, summary(metric), metric.citation))
    return table(("Metric", "In summaries", "Unit", "Meaning", "Source"), rows)


def controller_table() -> Iterable[str]:
    """Return the controllers with their parameters."""
    rows = []
    for entry in map(controllers.get, controllers.names()):
        keys = ", ".join(f"`{sections.file_key(f)}`" for f in dataclasses.fields(entry))
        rows.append((f"`{entry.name}`", keys, summary(entry), entry.citation))
    return table(("Controller", "Parameters", "Torque on the vehicle", "Source"), rows)


def constraint_table() -> Iterable[str]:
    """Return the constraint functions with their parameters."""
    rows = []
    for entry in map(guarantee.get, guarantee.names()):
        keys = ", ".join(f"`{f.name}`" for f in dataclasses.fields(entry))
        rows.append((f"`{entry.name}`", f"`{entry.layout}`", keys, summary(entry), entry.citation))
    return table(("Constraint", "Layout", "Parameters", "Gimbal angles", "Source"), rows)


def cost_table() -> Iterable[str]:
    """Return the costs of plans."""
    found = map(costs.get, costs.names())
    rows = [(f"`{entry.name}`", summary(entry), entry.citation) for entry in found]
    return table(("Cost", "Meaning", "Source"), rows)


def scenario_table() -> Iterable[str]:
    """Return the scenarios of the library."""
    rows = []
    for scenario in map(load_scenario, library_names()):
        words = (f"`{scenario.name}`", scenario.array.layout, f"`{scenario.law.name}`")
        rows.append((*words, scenario.about.description))
    return table(("Scenario", "Array", "Law", "About"), rows)


def paper_table() -> Iterable[str]:
    """Return the papers that can be computed again."""
    found = map(papers.get, papers.names())
    rows = [(f"`{paper.name}`", paper.title, paper.citation) for paper in found]
    return table(("Name", "Title", "Where"), rows)


def key_tables() -> Iterator[str]:
    """Return the keys of every section of a scenario file."""
    for title, model in _SECTIONS.items():
        about = summary(model).partition(": ")[2]
        yield f"\n### `{title}`\n\n{about[:1].upper()}{about[1:]}.\n"
        properties = model.model_json_schema()["properties"]
        rows = []
        for key, field in model.model_fields.items():
            default = "required" if field.is_required() else _shown(field.default)
            rows.append((f"`{key}`", kind(properties[key]), default))
        yield from table(("Key", "Value", "Default"), rows)
        if title in _BESIDE:
            yield f"\nBeside these, {_BESIDE[title]}."
    yield "\n### `[simulation.stop]`\n\nThe run ends as soon as one of these is passed:\n"
    yield ", ".join(f"`{key}`" for key in sections.stop_model().model_fields) + "."


def _shown(value: Any) -> str:
    if value is None or value == "":
        return ""
    return f"`{list(value) if isinstance(value, tuple) else value}`"


def kind(entry: Mapping[str, Any]) -> str:
    """Return in words what a JSON schema allows."""
    options = [o for o in entry.get("anyOf", entry.get("oneOf", ())) if o.get("type") != "null"]
    if options:
        return " or ".join(dict.fromkeys(kind(option) for option in options))
    if "enum" in entry or "const" in entry:
        return " or ".join(f'`"{value}"`' for value in entry.get("enum", [entry.get("const")]))
    if entry.get("type") == "array":
        return _list_kind(entry)
    limits = [f"{text} {entry[key]:g}" for key, text in _BOUNDS.items() if key in entry]
    return " ".join([_WORDS.get(entry.get("type", ""), "value"), *limits])


def _list_kind(entry: Mapping[str, Any]) -> str:
    if "prefixItems" in entry:
        return {2: "pair", 3: "triple"}.get(len(entry["prefixItems"]), "list")
    inner = kind(entry.get("items", {}))
    many = inner.replace("number", "numbers", 1) if "number" in inner else f"{inner}s"
    return f"list of {many}"


def public_names() -> Iterator[str]:
    """Return the names that ``import nullmotion as nm`` offers."""
    import nullmotion

    for name in nullmotion.__all__:
        item = getattr(nullmotion, name)
        if not isinstance(item, str):
            yield f"- `nm.{name}`: {summary(item)}"


def elementary_table() -> Iterable[str]:
    """Return the elementary functions with the largest errors found, from their docstrings."""
    rows = []
    for name, function in inspect.getmembers(elementary, inspect.isfunction):
        found = re.search(r"error below ([\d.]+) ulp", function.__doc__ or "")
        if found and not name.startswith("_"):
            about = summary(function).partition(";")[0].removeprefix("Return ")
            rows.append((f"`{name}`", found[1], about))
    return table(("Function", "Error below", "What it returns"), rows)


TABLES: dict[str, Callable[[], Iterable[str]]] = {
    "layouts": layout_table,
    "metrics": metric_table,
    "controllers": controller_table,
    "constraints": constraint_table,
    "costs": cost_table,
    "scenarios": scenario_table,
    "papers": paper_table,
    "keys": key_tables,
    "names": public_names,
    "elementary": elementary_table,
}
