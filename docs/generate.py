"""What the documentation takes from the code: law pages, tables, the output of examples.

mkdocs calls this as a hook (see mkdocs.yml). It writes a page for each registered law to
``docs/laws/``. In all pages it puts a table at a line ``<!-- table: NAME -->``, a file at
``<!-- file: PATH -->``, and below a code block that opens with ```` ```python run ```` what the
block prints (the blocks of a page share their names). A block that fails fails the build.
"""

from __future__ import annotations

import io
import re
from contextlib import redirect_stdout
from pathlib import Path
from typing import Any

import law_pages
import reference_tables

DOCS = Path(__file__).parent
_MARK = re.compile(r"^<!-- (table|file): (\S+) -->$", re.MULTILINE)
_BLOCK = re.compile(r"^```python run\n(.*?)^```\n", re.MULTILINE | re.DOTALL)
_LANGUAGES = {".py": "python", ".toml": "toml"}


def on_config(config: Any) -> Any:
    """Write the law pages and list them where the navigation says ``laws/``."""
    pages = law_pages.write(DOCS / "laws")
    for entry in config.nav:
        for title, target in entry.items():
            if target == "laws/":
                entry[title] = pages
    return config


def on_page_markdown(markdown: str, page: Any, **_: Any) -> str:
    """Put in tables, files and the output of code blocks."""
    names: dict[str, Any] = {"__name__": page.file.src_uri}

    def run(match: re.Match[str]) -> str:
        printed = output(match[1], names, page.file.src_uri)
        return f"```python\n{match[1]}```\n\n```text\n{printed}```\n"

    return _BLOCK.sub(run, _MARK.sub(_inserted, markdown))


def output(code: str, names: dict[str, Any], where: str) -> str:
    """Return what a block of code prints."""
    printed = io.StringIO()
    with redirect_stdout(printed):
        exec(compile(code, f"<{where}>", "exec"), names)
    return printed.getvalue()


def _inserted(match: re.Match[str]) -> str:
    kind, what = match.groups()
    if kind == "table":
        return "\n".join(reference_tables.TABLES[what]())
    file = DOCS.parent / what
    text = file.read_text(encoding="utf-8") if file.exists() else ""
    if file.suffix == ".md":  # its own title would be a second one
        return re.sub(r"\A# .*\n", "", text)
    return f"```{_LANGUAGES.get(file.suffix, 'text')}\n{text}```"


if __name__ == "__main__":
    law_pages.write(DOCS / "laws")
