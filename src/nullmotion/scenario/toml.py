"""TOML beside what ``tomllib`` does: the line of every key, and writing a document."""

from __future__ import annotations

import datetime
import json
import re
from collections.abc import Iterator, Mapping
from typing import Any

Path = tuple[str | int, ...]

_HEADER = re.compile(r"(\[\[?)([^\]\n]+)\]")
_KEY = re.compile(r"""\s*((?:"[^"\n]*"|'[^'\n]*'|[^=\n"'])+)=""")
_PART = re.compile(r"""\s*(?:"([^"]*)"|'([^']*)'|([A-Za-z0-9_-]+))\s*\.?""")
_TOKEN = re.compile(
    r'''"""(?:\\.|[^\\])*?"""|\'\'\'.*?\'\'\'|"(?:\\.|[^"\\\n])*"|'[^'\n]*'|#[^\n]*|[\[\]{}\n]|[^\[\]{}\n#"']+''',
    re.DOTALL,
)
_BARE = re.compile(r"[A-Za-z0-9_-]+")


def key_lines(text: str) -> dict[Path, int]:
    """Return the line (from 1) on which each key or section of a valid document stands."""
    lines: dict[Path, int] = {}
    tables: dict[Path, int] = {}  # arrays of tables: how many so far
    prefix: Path = ()
    for line, statement in _statements(text):
        header = _HEADER.match(statement)
        if header:
            prefix = _section(header, tables)
            _note(lines, prefix, line)
        elif match := _KEY.match(statement):
            _note(lines, prefix + _parts(match[1]), line)
    return lines


def _note(lines: dict[Path, int], path: Path, line: int) -> None:
    for end in range(1, len(path) + 1):
        lines.setdefault(path[:end], line)


def _parts(text: str) -> Path:
    return tuple(a or b or c for a, b, c in _PART.findall(text))


def _section(header: re.Match[str], tables: dict[Path, int]) -> Path:
    """Return the path of a header, with the index of each array of tables in it."""
    path: Path = ()
    parts = _parts(header[2])
    for i, part in enumerate(parts):
        path += (part,)
        if header[1] == "[[" and i == len(parts) - 1:
            tables[path] = tables.get(path, 0) + 1
        if path in tables:
            path += (tables[path] - 1,)
    return path


def _statements(text: str) -> Iterator[tuple[int, str]]:
    """Yield each header or ``key = value`` with its line; a value may span lines."""
    pieces: list[str] = []
    depth, start, line = 0, 1, 1
    for token in _TOKEN.findall(text + "\n"):
        if token == "\n" and (depth == 0 or "".join(pieces).startswith("[")):
            if pieces:
                yield start, "".join(pieces)
            depth, pieces = 0, []
        elif not token.startswith("#") and (pieces or token.strip()):
            start = start if pieces else line
            pieces.append(token if pieces else token.lstrip())
            depth += (token in ("[", "{")) - (token in ("]", "}"))
        line += token.count("\n")


def value_text(value: Any) -> str:
    """Return a value as TOML writes it, on one line."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{_key(k)} = {value_text(v)}" for k, v in value.items()) + " }"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(value_text(v) for v in value) + "]"
    if isinstance(value, (datetime.date, datetime.time)):
        return value.isoformat()
    return repr(value)


def document_text(data: Mapping[str, Any]) -> str:
    """Return a document of sections, subsections and arrays of tables as TOML."""
    return "\n".join(_table_lines(data, ())) + "\n"


def _table_lines(table: Mapping[str, Any], path: tuple[str, ...]) -> Iterator[str]:
    tables = {k: v for k, v in table.items() if isinstance(v, Mapping)}
    lists = {k: v for k, v in table.items() if _is_table_list(v)}
    for key, value in table.items():
        if key not in tables and key not in lists:
            yield f"{_key(key)} = {value_text(value)}"
    for key, value in tables.items():
        here = (*path, key)
        yield f"[{'.'.join(map(_key, here))}]"
        yield from _table_lines(value, here)
    for key, values in lists.items():
        here = (*path, key)
        for value in values:
            yield f"[[{'.'.join(map(_key, here))}]]"
            yield from _table_lines(value, here)


def _is_table_list(value: Any) -> bool:
    return (
        isinstance(value, (list, tuple))
        and bool(value)
        and all(isinstance(v, Mapping) for v in value)
    )


def _key(key: str) -> str:
    return key if _BARE.fullmatch(key) else json.dumps(key)
