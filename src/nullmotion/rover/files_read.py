"""From the text of a rover or mission file to checked sections, with every problem collected."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any, TypeVar

from pydantic import ValidationError

from nullmotion.errors import InputError
from nullmotion.scenario import keys
from nullmotion.scenario.problems import MISSING, Problem, ScenarioError
from nullmotion.scenario.schema import Section
from nullmotion.scenario.source import Source
from nullmotion.scenario.toml import Path
from nullmotion.scenario.validate import Validator

T = TypeVar("T")

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
    """Checks a document section by section and keeps what is wrong.

    Args:
        source: The document.
        models: Its sections by name.
        elsewhere: Sections that are allowed and read by someone else.
    """

    def __init__(
        self, source: Source, models: Mapping[str, type[Section]], elsewhere: Iterable[str] = ()
    ) -> None:
        """Note the sections that are not known."""
        self.source, self._models = source, models
        self._found = Validator(source)
        self.add: Callable[[Path, Any, str], None] = self._found.add
        self.raise_problems: Callable[[], None] = self._found.raise_problems
        known = [*models, *elsewhere]
        for key in source.data:
            if key not in known:
                self.add((key,), MISSING, keys.hint(key, known).replace("key", "section", 1))

    def given(self, name: str) -> bool:
        """Return whether the document has a section."""
        return name in self.source.data

    def section(self, name: str, needed: bool = False) -> Any:
        """Return a section, checked; one that is not there has its defaults.

        Returns:
            The section; None if it has problems, or is not there but needed.
        """
        if needed and not self.given(name):
            self.add((name,), MISSING, "this section is missing")
            return None
        raw = self.source.data.get(name, {})
        if not isinstance(raw, dict):
            self.add((name,), raw, "a section with keys")
            return None
        try:
            return self._models[name].model_validate(raw)
        except ValidationError as error:
            self._collect(name, error)
        return None

    def attempt(self, name: str, made: Callable[[], T], /, **written: str) -> T | None:
        """Return what is made of a section, or None with the reason noted.

        Args:
            name: The section.
            made: Makes it; an `InputError` of it is noted.
            **written: What the error's keys are called in the section.
        """
        try:
            return made()
        except InputError as error:
            key = written.get(error.key.rpartition(".")[2])
            path: Path = (name,) if key is None else (name, key)
            value = value_at(self.source, path)
            self.add(path, MISSING if isinstance(value, dict) else value, error.allowed)
        return None

    def _collect(self, name: str, error: ValidationError) -> None:
        """Note pydantic's errors at the keys they are about, one for each key."""
        merged: dict[Path, list[str]] = {}
        for item in error.errors(include_url=False):
            path: Path = (name, *item["loc"][:1])
            kind = item["type"]
            said = _ALLOWED.get(kind, "").format(**item.get("ctx", {})) or item["msg"]
            if kind == "extra_forbidden":
                said = keys.hint(str(item["loc"][0]), list(self._models[name].model_fields))
            texts = merged.setdefault(path, [])
            if said not in texts:
                texts.append(said)
        for path, texts in merged.items():
            self.add(path, value_at(self.source, path), " or ".join(texts))


@contextmanager
def located(source: Source, written: Mapping[str, Path]) -> Iterator[None]:
    """Say file and line in an `InputError` that comes up later.

    Args:
        source: The document.
        written: Where the document has what the error's keys name.
    """
    try:
        yield
    except ScenarioError:
        raise
    except InputError as error:
        path = written.get(error.key)
        if error.where or path is None:
            raise
        value = value_at(source, path)
        dotted, shown = ".".join(map(str, path)), MISSING if isinstance(value, dict) else value
        raise ScenarioError([Problem(dotted, shown, error.allowed, source.where(path))]) from error


def value_at(source: Source, path: Path) -> Any:
    """Return what stands at a path of a document, `MISSING` if nothing does."""
    try:
        return source.value(path)
    except (KeyError, IndexError, TypeError):
        return MISSING
