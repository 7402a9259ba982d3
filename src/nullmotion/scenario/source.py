"""Where a scenario comes from: its text, what was set over it, the files beside it."""

from __future__ import annotations

import copy
import re
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache
from pathlib import Path
from typing import Any

from nullmotion.errors import InputError
from nullmotion.scenario import toml
from nullmotion.scenario.problems import MISSING, Problem, ScenarioError

_INDEX = re.compile(r"\[(\d+)\]")


@dataclass(frozen=True)
class Source:
    """Text of a scenario and the values set over it.

    Attributes:
        text: TOML as written.
        name: What messages call it: the path as given, or the library's name.
        folder: Where files named in it are looked for; anything with ``/`` and ``read_text``.
        overrides: Values by dotted key, set over the text.
        origin: What messages call the overrides.
        files: Text of files named in it, by name; looked up before ``folder``.
    """

    text: str
    name: str = "scenario"
    folder: Any = None
    overrides: Mapping[str, Any] = field(default_factory=dict)
    origin: str = "--set"
    files: Mapping[str, str] = field(default_factory=dict)

    @cached_property
    def data(self) -> dict[str, Any]:
        """The document with its overrides, lists as tuples.

        Raises:
            ScenarioError: For text that is not TOML, with file and line.
        """
        data = copy.deepcopy(self._parsed)
        for key, value in self.overrides.items():
            self._put(data, key, value)
        found: dict[str, Any] = _tuples(data)
        return found

    @cached_property
    def _parsed(self) -> dict[str, Any]:
        try:
            return _parse(self.text)
        except tomllib.TOMLDecodeError as error:
            raise ScenarioError([self._syntax_problem(str(error))]) from None

    def _syntax_problem(self, message: str) -> Problem:
        what, _, place = message.rpartition(" (at ")
        line = "".join(c for c in place.partition(",")[0] if c.isdigit())
        line = line or str(self.text.count("\n") + 1)
        lines = self.text.splitlines() or [""]
        text = lines[min(int(line), len(lines)) - 1].strip()
        said = what or message
        return Problem("TOML", text or MISSING, said[:1].lower() + said[1:], f"{self.name}:{line}")

    def _put(self, data: dict[str, Any], key: str, value: Any) -> None:
        *sections, last = key.split(".")
        table: Any = data
        for section in sections:
            if isinstance(table, list):
                table = self._item(table, section, key, value)
            else:
                table = table.setdefault(section, {})
            if not isinstance(table, (dict, list)):
                raise ScenarioError(
                    [Problem(key, value, f"{section!r} is not a section", self.origin)]
                )
        if isinstance(table, list):
            allowed = f"{key}.<key>, or the whole list as {'.'.join(sections)}"
            raise ScenarioError([Problem(key, value, allowed, self.origin)])
        table[last] = _lists(value)

    def _item(self, items: list[Any], index: str, key: str, value: Any) -> Any:
        """Return one section of a list of sections, such as the 0 of ``event.0.at_s``."""
        if index.isdigit() and int(index) < len(items):
            return items[int(index)]
        allowed = f"{index!r} is not one of the {len(items)} in the list, counted from 0"
        raise ScenarioError([Problem(key, value, allowed, self.origin)])

    @cached_property
    def _lines(self) -> dict[toml.Path, int]:
        return toml.key_lines(self.text)

    def where(self, path: toml.Path) -> str:
        """Return ``file:line`` of a key, of its section if the key is not there."""
        dotted = ".".join(map(str, path))
        if any(dotted == key or dotted.startswith(key + ".") for key in self.overrides):
            return self.origin
        if path not in self._lines and any(key.startswith(dotted + ".") for key in self.overrides):
            return self.origin
        for end in range(len(path), 0, -1):
            if path[:end] in self._lines:
                return f"{self.name}:{self._lines[path[:end]]}"
        return f"{self.name}:1" if self.text else self.name

    def value(self, path: toml.Path) -> Any:
        """Return what stands at a path; KeyError, IndexError or TypeError if nothing does."""
        found: Any = self.data
        for part in path:
            found = found[part]
        return found

    def read(self, name: str) -> str:
        """Return the text of a file named in the scenario.

        Raises:
            OSError: If there is no such file.
        """
        if name in self.files:
            return self.files[name]
        folder = Path() if self.folder is None else self.folder
        target = Path(name) if Path(name).is_absolute() else folder / name
        return target.read_text(encoding="utf-8-sig")

    def over(self, values: Mapping[str, Any], origin: str = "--set") -> Source:
        """Return the source with more values set over it."""
        named = {_INDEX.sub(r".\1", key): value for key, value in values.items()}
        return replace(self, overrides={**self.overrides, **named}, origin=origin)

    def effective_text(self) -> str:
        """Return TOML that says it all: the text itself unless values were set over it."""
        return toml.document_text(self.data) if self.overrides else self.text


def parse_setting(setting: str) -> tuple[str, Any]:
    """Return key and value of ``section.key=value``; the value is TOML, a text may come bare.

    Raises:
        InputError: For anything else.
    """
    key, equals, text = (part.strip() for part in setting.partition("="))
    if not equals or not text or not all(part.strip() for part in key.split(".")):
        raise InputError("--set", setting, "section.key=value, such as law.sigma_c=0.05")
    return key, parse_value(text, key)


def parse_value(text: str, key: str) -> Any:
    """Return a TOML value; a text without quotes, brackets or braces is itself."""
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except tomllib.TOMLDecodeError:
        if any(c in text for c in "[]{}\"'\n="):
            raise InputError(
                f"--set {key}", text, "a TOML value, such as 0.05, true, [1, 0, 0] or a word"
            ) from None
        return text


@lru_cache(maxsize=8)
def _parse(text: str) -> dict[str, Any]:
    """Return a document; shared by the many scenarios that differ in overrides only."""
    return tomllib.loads(text)


def _lists(value: Any) -> Any:
    """Return a copy in which tuples are lists."""
    if isinstance(value, dict):
        return {k: _lists(v) for k, v in value.items()}
    return [_lists(v) for v in value] if isinstance(value, (list, tuple)) else value


def _tuples(value: Any) -> Any:
    if isinstance(value, dict):
        return {k: _tuples(v) for k, v in value.items()}
    return tuple(map(_tuples, value)) if isinstance(value, list) else value
