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
from nullmotion.spacecraft import controllers

_NEEDED = ("array", "law", "mission", "simulation")
_ATTITUDE_NEEDS = ("spacecraft", "controller")
_ATTITUDE_ONLY = (
    *_ATTITUDE_NEEDS,
    "sensors",
    "disturbance",
    "desaturation",
    "reaction_wheel",
    "vscmg",
)

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
        for key in data:
            if key not in sections.SECTIONS:
                self.add(
                    (key,), MISSING, keys.hint(key, sections.SECTIONS).replace("key", "section", 1)
                )
        for key in _NEEDED:
            if key not in data:
                self.add((key,), MISSING, "this section is missing")
        self._fit_to_mission(data)
        several = ("compare", *sections.LISTS)
        found = {
            name: self._section((name,))
            for name in sections.SECTIONS
            if name not in several and name in data
        }
        found["compare"] = self._cases(data)
        found["event"] = self._listed(("event",), data.get("event", ()))
        found["stop"] = self._stop(data)
        return found

    def section(self, name: str) -> Any:
        """Return one checked section of the document, None if it has problems."""
        return self._section((name,))

    def _fit_to_mission(self, data: Mapping[str, Any]) -> None:
        """Note sections that the kind of mission needs, or has no use for."""
        mission = data.get("mission")
        if not isinstance(mission, dict):
            return
        kind = mission.get("kind", "momentum-rate")
        if kind in ("attitude", "startup"):
            for key in _ATTITUDE_NEEDS:
                if key not in data:
                    allowed = f'this section is missing; a mission of kind "{kind}" needs it'
                    self.add((key,), MISSING, allowed)
        elif kind in ("momentum-rate", "momentum"):
            extra = [key for key in data if key in _ATTITUDE_ONLY]
            if extra:
                names = " and ".join(f"[{key}]" for key in extra)
                allowed = (
                    f'{names} only with mission.kind = "attitude" or "startup" (this is "{kind}")'
                )
                self.add((extra[0],), MISSING, allowed)

    def _cases(self, data: Mapping[str, Any]) -> list[Any]:
        compare = data.get("compare", {})
        if not isinstance(compare, dict):
            self.add(("compare",), compare, "[[compare.case]] sections")
            return []
        for key in compare:
            if key != "case":
                self.add(("compare", key), compare[key], keys.hint(key, ["case"]))
        return self._listed(("compare", "case"), compare.get("case", ()))

    def _listed(self, path: Path, items: Any) -> list[Any]:
        """Return the checked sections of a list of sections."""
        if not isinstance(items, tuple):
            self.add(path, items, f"[[{_dotted(path)}]] sections, in double brackets")
            return []
        return [self._section((*path, i)) for i in range(len(items))]

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
        known = {"array": sections.layout_names, "controller": controllers.names}
        names = known.get(str(path[0]), laws.names)()
        self.add((*path, key), value, UnknownNameError(error.kind, value, names).allowed)

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
