"""From the text of a requirement file to checked sections, with every problem collected."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from pydantic import ValidationError

from nullmotion.errors import InputError
from nullmotion.scenario import keys
from nullmotion.scenario.problems import MISSING
from nullmotion.scenario.source import Source
from nullmotion.scenario.toml import Path
from nullmotion.scenario.validate import Validator
from nullmotion.sizing import schema

NEEDED = ("spacecraft", "slew")
_ALLOWED = {
    "float_type": "a number",
    "int_type": "a whole number",
    "int_from_float": "a whole number",
    "string_type": "a text in quotes",
    "tuple_type": "a list",
    "finite_number": "a finite number",
    "greater_than": "above {gt:g}",
    "greater_than_equal": "at least {ge:g}",
    "less_than": "below {lt:g}",
    "less_than_equal": "at most {le:g}",
    "literal_error": "{expected}",
    "too_short": "a list of at least {min_length}",
    "missing": "this key is missing",
}


class Reader:
    """Checks a document section by section and keeps what is wrong."""

    def __init__(self, source: Source) -> None:
        """Start without problems."""
        self.source = source
        self._found = Validator(source)
        self.add: Callable[[Path, Any, str], None] = self._found.add
        self.raise_problems: Callable[[], None] = self._found.raise_problems

    def sections(self) -> dict[str, Any]:
        """Return the sections by name; what is not in the file has its defaults.

        Raises:
            ScenarioError: With everything that is wrong, each with key, value, what is
                allowed, file and line.
        """
        data, models = self.source.data, schema.models()
        for key in data:
            if key not in models:
                hint = keys.hint(key, models).replace("key", "section", 1)
                self.add((key,), MISSING, hint)
        for key in NEEDED:
            if key not in data:
                self.add((key,), MISSING, "this section is missing")
        found = {
            name: self._section(name, model)
            for name, model in models.items()
            if name in data or name not in NEEDED
        }
        self.raise_problems()
        return found

    def attempt(self, path: Path, make: Callable[[], Any]) -> Any:
        """Return what is made, or None with the InputError noted at a path of the document."""
        try:
            return make()
        except InputError as error:
            self.add(path, self.source.value(path), error.allowed)
            return None

    def _section(self, name: str, model: type[Any]) -> Any:
        raw = self.source.data.get(name, {})
        if not isinstance(raw, dict):
            self.add((name,), raw, "a section with keys")
            return None
        try:
            return model.model_validate(raw)
        except ValidationError as error:
            self._collect(name, model, error)
        return None

    def _collect(self, name: str, model: type[Any], error: ValidationError) -> None:
        """Note pydantic's errors at the keys they are about, one for each key."""
        merged: dict[Path, list[str]] = {}
        for item in error.errors(include_url=False):
            path: Path = (name, *item["loc"][:1])
            kind, key = item["type"], str(item["loc"][0])
            said = _ALLOWED.get(kind, "").format(**item.get("ctx", {})) or item["msg"]
            if kind == "extra_forbidden":
                said = keys.hint(key, list(model.model_fields))
            texts = merged.setdefault(path, [])
            if said not in texts:
                texts.append(said)
        for path, texts in merged.items():
            value = self.source.data[name].get(path[1], MISSING)
            self.add(path, value, " or ".join(texts))
