"""From a document to checked sections, with every problem collected."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pydantic import ValidationError

from nullmotion import laws
from nullmotion.errors import UnknownNameError
from nullmotion.scenario import keys, schema, sections
from nullmotion.scenario.problems import MISSING, Problem, ScenarioError
from nullmotion.scenario.source import Source
from nullmotion.scenario.toml import Path

LATER_KINDS = ("attitude", "momentum", "startup")
_LATER_SECTIONS = ("spacecraft", "controller", "plan")
_NEEDED = ("array", "law", "mission", "simulation")

_ALLOWED = {
    "float_type": "a number",
    "int_type": "a whole number",
    "int_from_float": "a whole number",
    "bool_type": "true or false",
    "string_type": "a text in quotes",
    "tuple_type": "a list",
    "dict_type": "a section",
    "model_type": "a section",
    "model_attributes_type": "a section",
    "finite_number": "a finite number",
    "greater_than": "above {gt:g}",
    "greater_than_equal": "at least {ge:g}",
    "less_than": "below {lt:g}",
    "less_than_equal": "at most {le:g}",
    "literal_error": "{expected}",
    "too_short": "a list of at least {min_length}",
    "too_long": "a list of at most {max_length}",
    "none_required": "",
}


class Validator:
    """Checks the sections of one document and keeps what is wrong."""

    def __init__(self, source: Source) -> None:
        """Start without problems."""
        self.source = source
        self.problems: list[Problem] = []

    def raise_problems(self) -> None:
        """Raise what was found, in the order of the file."""
        if self.problems:
            raise ScenarioError(sorted(self.problems, key=_line))

    def add(self, path: Path, value: Any, allowed: str) -> None:
        """Note a problem at a path of the document."""
        self.problems.append(Problem(_dotted(path), value, allowed, self.source.where(path)))

    def sections(self) -> dict[str, Any]:
        """Return the checked sections by name; those with problems are left out."""
        data = self.source.data
        if self._later_kind(data):
            return {}
        for key in data:
            if key not in sections.SECTIONS:
                self.add(
                    (key,), MISSING, keys.hint(key, sections.SECTIONS).replace("key", "section", 1)
                )
        for key in _NEEDED:
            if key not in data:
                self.add((key,), MISSING, "this section is missing")
        found = {
            name: self._section((name,))
            for name in sections.SECTIONS
            if name != "compare" and name in data
        }
        found["compare"] = self._cases(data)
        found["stop"] = self._stop(data)
        return found

    def _later_kind(self, data: Mapping[str, Any]) -> bool:
        mission = data.get("mission")
        kind = mission.get("kind") if isinstance(mission, dict) else None
        later = [key for key in _LATER_SECTIONS if key in data]
        if kind in LATER_KINDS:
            self.add(
                ("mission", "kind"), kind, 'this version of nullmotion flies "momentum-rate" only'
            )
        for key in later:
            self.add(
                (key,),
                MISSING,
                'this version of nullmotion has no such section; it flies "momentum-rate" only',
            )
        return bool(later) or kind in LATER_KINDS

    def _cases(self, data: Mapping[str, Any]) -> list[Any]:
        compare = data.get("compare", {})
        if not isinstance(compare, dict):
            self.add(("compare",), compare, "[[compare.case]] sections")
            return []
        for key in compare:
            if key != "case":
                self.add(("compare", key), compare[key], keys.hint(key, ["case"]))
        cases = compare.get("case", ())
        if not isinstance(cases, tuple):
            self.add(("compare", "case"), cases, "[[compare.case]] sections, in double brackets")
            return []
        return [self._section(("compare", "case", i)) for i in range(len(cases))]

    def _stop(self, data: Mapping[str, Any]) -> Any:
        simulation = data.get("simulation")
        has = isinstance(simulation, dict) and "stop" in simulation
        return self._section(("simulation", "stop")) if has else schema.StopSection()

    def _section(self, path: Path) -> Any:
        """Return one checked section, None if it has problems."""
        raw = self.source.value(path)
        if not isinstance(raw, dict):
            self.add(path, raw, "a section with keys")
            return None
        if path == ("simulation",):
            raw = {k: v for k, v in raw.items() if k != "stop"}
        try:
            model = sections.model_at(self.source.data, path)
            assert model is not None
            return model.model_validate(raw)
        except UnknownNameError as error:
            self._unknown_name(path, error)
        except ValidationError as error:
            self._collect(path, error)
        return None

    def _unknown_name(self, path: Path, error: UnknownNameError) -> None:
        key = "layout" if path == ("array",) else "name"
        value = self.source.value((*path, key))
        if not isinstance(value, str):
            self.add((*path, key), value, "a text in quotes")
            return
        known = sections.layout_names() if key == "layout" else laws.names()
        self.add((*path, key), value, UnknownNameError(error.kind, value, known).allowed)

    def _collect(self, section: Path, error: ValidationError) -> None:
        """Turn pydantic's errors into problems; the branches of a union become one."""
        merged: dict[Path, tuple[Any, list[str]]] = {}
        for item in error.errors(include_url=False):
            path, value = self._resolve(section, item["loc"])
            if item["type"] == "missing":
                path, value = (*section, *item["loc"]), MISSING
            texts = merged.setdefault(path, (value, []))[1]
            text = self._allowed(section, path, item)
            if text and text not in texts:
                texts.append(text)
        for path, (value, texts) in merged.items():
            self.add(path, value, " or ".join(texts) or "not allowed here")

    def _resolve(self, section: Path, loc: Path) -> tuple[Path, Any]:
        """Return the part of a location that exists in the document (union tags do not)."""
        path, found = section, self.source.value(section)
        for part in loc:
            try:
                found = found[part]
            except (KeyError, IndexError, TypeError):
                continue
            path = (*path, part)
        return path, found

    def _allowed(self, section: Path, path: Path, item: Any) -> str:
        kind = item["type"]
        if kind == "extra_forbidden":
            return keys.hint(str(path[-1]), sections.section_keys(self.source.data, section))
        if kind == "missing":
            return "this key is missing"
        template = _ALLOWED.get(kind)
        return item["msg"] if template is None else template.format(**item.get("ctx", {}))


def _line(problem: Problem) -> int:
    line = problem.where.rpartition(":")[2]
    return int(line) if line.isdigit() else 0


def _dotted(path: Path) -> str:
    text = ""
    for part in path:
        text += f"[{part}]" if isinstance(part, int) else f"{'.' if text else ''}{part}"
    return text
