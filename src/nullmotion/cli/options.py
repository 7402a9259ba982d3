"""Options that several commands share, and what they mean."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from nullmotion.scenario import Scenario

ScenarioArgument = Annotated[
    str,
    typer.Argument(
        metavar="SCENARIO", help="TOML file, or a name from `nullmotion list scenarios`."
    ),
]
Settings = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="KEY=VALUE",
        help="Set a value over the file: law.sigma_c=0.05. May be repeated.",
    ),
]
LawFile = Annotated[
    Path | None,
    typer.Option("--law-file", metavar="FILE", help="Python file with a law of your own."),
]
Out = Annotated[
    Path | None,
    typer.Option("--out", metavar="DIR", help="Folder for the results; out/NAME by default."),
]
Seed = Annotated[
    int | None, typer.Option("--seed", metavar="N", help="Seed of plant errors and sensor noise.")
]


_SEED = "--seed"
_SEEDED = ("plant", "sensors")


def values(settings: Sequence[str] | None, seed: int | None) -> dict[str, Any]:
    """Return the values that --set and --seed give, by dotted key."""
    from nullmotion.scenario.source import parse_setting

    found = dict(parse_setting(setting) for setting in settings or ())
    return found if seed is None else found | {_SEED: seed}


def writable(target: Path) -> Path:
    """Return a folder for results if it can be made and written to: told before the work."""
    import os

    from nullmotion.errors import InputError

    there = next(p for p in (target, *target.absolute().parents) if p.exists())
    if not there.is_dir() or not os.access(there, os.W_OK):
        raise InputError("--out", str(target), "a folder that can be written to")
    return target


def load(scenario: str, settings: Mapping[str, Any], law_names: Sequence[str] = ()) -> Scenario:
    """Return the scenario; a law file's only law flies unless the scenario names one of the file's.

    Args:
        scenario: File or name.
        settings: Values by dotted key.
        law_names: Names of the laws in the law file.
    """
    from nullmotion.errors import InputError
    from nullmotion.scenario.load import find
    from nullmotion.scenario.scenario import checked

    source = find(scenario)
    settings = dict(settings)
    if _SEED in settings:
        seed = settings.pop(_SEED)
        present = {*source.data, *(key.partition(".")[0] for key in settings)}
        drawn = [name for name in _SEEDED if name in present] or ["plant"]
        settings |= {f"{name}.seed": seed for name in drawn}
    law = source.data.get("law")
    named = {**(law if isinstance(law, dict) else {}), "name": settings.get("law.name", _name(law))}
    if law_names and "law.name" not in settings and named["name"] not in law_names:
        if len(law_names) > 1:
            raise InputError(
                "--law-file", ", ".join(law_names), "choose one with --set law.name=..."
            )
        kept = {k: v for k, v in named.items() if k in ("period_s", "delay_s")}
        source = source.over({"law": {"name": law_names[0], **kept}}, "--law-file")
    return checked(source.over(settings) if settings else source)


def _name(law: Any) -> Any:
    return law.get("name") if isinstance(law, dict) else None


def load_law_file(path: Path | None) -> tuple[list[str], str]:
    """Register the laws of a file; return their names and the file's text."""
    if path is None:
        return [], ""
    from nullmotion import laws

    found = laws.load_file(path)
    return [law.name for law in found], path.read_text(encoding="utf-8")
