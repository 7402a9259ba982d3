"""One page for each registered steering law, and the page that lists them."""

from __future__ import annotations

import dataclasses
import inspect
import re
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from reference_tables import summary, table

from nullmotion import laws, layouts
from nullmotion.law import Claim, Law

_ALWAYS = ("delta", "hdot", "t", "period")
_INDEX = """# Steering laws

A steering law turns a wanted rate of momentum into gimbal rates. Each is one file,
`src/nullmotion/laws/NAME.py`, and one frozen dataclass whose fields are its parameters.
"""
_CLAIMS = """
## Claims

What a law claims is tested on every layout it supports, singular states included.
"""
_EXAMPLE = """From zero angles, 1 N m about x drives a pyramid towards its internal elliptic
singularity; the run ends when the momentum along the command is used up, or after 10 s.

```python run
import nullmotion as nm

scenario = nm.load_scenario("elliptic-singularity", {"law.name": "NAME"})
run = nm.simulate(scenario)
found = run.summary()
print(f"{found['stop_reason']} at {found['duration_s']:.2f} s")
print("momentum [N m s]:", run.momentum[-1].round(3) + 0.0)
print(f"least sigma_min: {found['min_sigma_min']:.4f}")
print(f"off-axis torque, peak: {found['max_off_axis_torque_fraction']:.4f} of the command")
print(f"largest rate step: {found['max_rate_step_rad_s']:.3f} rad/s")
```
"""
_WHEELS = _EXAMPLE.replace("drives a pyramid", "drives a pyramid of variable-speed CMGs").replace(
    '{"law.name": "NAME"}', '{"law.name": "NAME", "array.wheel_inertia_kg_m2": 0.01}'
)
_RAMP = """It does not steer the pyramid. From zero momentum, constant torque drives a box-90
towards its envelope; the status says what did not hold on the way.

```python run
import nullmotion as nm

scenario = nm.load_scenario("box90-ramp", {"law.name": "NAME"})
run = nm.simulate(scenario)
found = run.summary()
print(f"{found['stop_reason']} at {found['duration_s']:.2f} s; status:", ", ".join(found["status"]))
print("momentum [N m s]:", run.momentum[-1].round(3) + 0.0)
print(f"least sigma_min: {found['min_sigma_min']:.4f}")
print(f"off-axis torque, peak: {found['max_off_axis_torque_fraction']:.4f} of the command")
```
"""


def write(folder: Path) -> list[dict[str, str]]:
    """Write the pages; return their entries in the navigation."""
    entries = [laws.get(name) for name in laws.names()]
    pages = {f"{law.name}.md": "\n".join(page(law)) for law in entries}
    pages["index.md"] = "\n".join(index(entries))
    folder.mkdir(exist_ok=True)
    for old in folder.glob("*.md"):
        if old.name not in pages:
            old.unlink()
    for name, text in pages.items():
        file = folder / name
        if not file.exists() or file.read_text(encoding="utf-8") != text:  # keeps `serve` calm
            file.write_text(text, encoding="utf-8")
    listed = [{law.full_name: f"{folder.name}/{law.name}.md"} for law in entries]
    return [{"All laws": f"{folder.name}/index.md"}, *listed]


def index(entries: list[type[Law]]) -> Iterator[str]:
    """Return the list of laws and the table of claims."""
    yield _INDEX
    rows = [(f"[`{x.name}`]({x.name}.md)", x.full_name, summary(x), x.citation) for x in entries]
    yield from table(("Name", "Law", "In short", "Source"), rows)
    yield _CLAIMS
    yield from table(("Claim", "Promise"), [(_words(claim), claim.value) for claim in Claim])
    yield ""
    marks = [(f"`{x.name}`", *("yes" if c in x.claims else "" for c in Claim)) for x in entries]
    yield from table(("Law", *map(_words, Claim)), marks)


def _words(claim: Claim) -> str:
    return claim.name.lower().replace("_", " ")


def page(law: type[Law]) -> Iterator[str]:
    """Return the page of one law."""
    text, arguments = split_docstring(law)
    yield f"# {law.full_name}\n"
    yield ", ".join(f"`{name}`" for name in (law.name, *law.aliases)) + f". {law.citation}.\n"
    yield _linked(text, law.name)
    yield "\n## Parameters\n"
    yield from _parameters(law, arguments)
    yield "\n## What it claims\n"
    yield from _claims(law)
    yield "\n## What it reads\n"
    reads = [f"`{key}`" for key in (*_ALWAYS, *law.information)]
    yield f"{', '.join(reads[:-1])} and {reads[-1]}."
    if not law.traceable:
        yield "\nIt solves a problem while it runs and is stepped from Python, not compiled."
    yield "\n## Example\n"
    yield _example(law)


def split_docstring(law: type[Law]) -> tuple[str, dict[str, str]]:
    """Return the text of a Google docstring and the description of each argument."""
    text, _, rest = inspect.cleandoc(law.__doc__ or "").partition("\nArgs:\n")
    arguments: dict[str, str] = {}
    for item in re.split(r"\n(?=    \w+: )", f"\n{rest}")[1:]:
        key, _, meaning = item.strip().partition(": ")
        arguments[key] = " ".join(meaning.split())
    return text.strip(), arguments


def _linked(text: str, own: str) -> str:
    """Link the names of other laws in a text."""
    others = "|".join(re.escape(name) for name in laws.names() if name != own)
    return re.sub(rf"`({others})`", r"[`\1`](\1.md)", text)


def _parameters(law: type[Law], arguments: Mapping[str, str]) -> Iterable[str]:
    fields = [f for f in dataclasses.fields(law) if f.init]
    if not fields:
        return ["It has none."]
    rows = [(f"`{f.name}`", _default(f), arguments.get(f.name, "")) for f in fields]
    return table(("Parameter", "Default", "Meaning"), rows)


def _default(field: dataclasses.Field[Any]) -> str:
    if field.default is dataclasses.MISSING:
        return "required" if field.default_factory is dataclasses.MISSING else "none"
    if isinstance(field.default, tuple):
        return ", ".join(f"{v:.6g}" for v in field.default)
    return f"{field.default:.6g}" if isinstance(field.default, float) else f"`{field.default}`"


def _claims(law: type[Law]) -> Iterator[str]:
    for claim in Claim:
        if claim in law.claims:
            where = _where_exact(law) if claim is Claim.EXACT_TORQUE else ""
            yield f"- {claim.value}{where}"
    missing = [claim.value for claim in Claim if claim not in law.claims]
    if missing:
        yield "\nNot claimed:\n"
        yield from (f"- {text}" for text in missing)


def _where_exact(law: type[Law]) -> str:
    """Return from which sigma_min on the torque is exact, on the pyramid and on defaults."""
    array = layouts.pyramid()
    if _needs_values(law) or law().supports(array):
        return ""
    return f" (on the pyramid: where sigma_min is above {law().exact_above(array):.4g})"


def _needs_values(law: type[Law]) -> bool:
    return any(_default(f) == "required" for f in dataclasses.fields(law) if f.init)


def _example(law: type[Law]) -> str:
    if law.turns_wheels:
        return _WHEELS.replace("NAME", law.name)
    for array, text in ((layouts.pyramid(), _EXAMPLE), (layouts.box90(), _RAMP)):
        if not _needs_values(law) and not law().supports(array):
            return text.replace("NAME", law.name)
    return f"`nm.laws.create({law.name!r}, ...)` makes one. It does not steer the pyramid as is."
