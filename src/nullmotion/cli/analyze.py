"""``nullmotion analyze``: the singularities of an array, and what it can rely on."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from nullmotion.cli import options, screen

if TYPE_CHECKING:
    from nullmotion.atlas.analysis import Analysis
    from nullmotion.scenario.array_file import ArrayFile
    from nullmotion.sim import Trajectory

RESULT, PAGE = "analysis.json", "atlas.html"
FIGURES = {kind: f"atlas.{kind}" for kind in ("pdf", "png", "svg")}


def analyze(
    array: Annotated[
        str,
        typer.Argument(
            metavar="ARRAY",
            help="TOML file with [array] or a whole scenario, or a name from "
            "`nullmotion list scenarios`.",
        ),
    ],
    out: options.Out = None,
    figure: Annotated[
        str | None, typer.Option("--figure", metavar="pdf|png|svg", help="Draw a figure as well.")
    ] = None,
    settings: options.Settings = None,
    law_file: options.LawFile = None,
    run: Annotated[
        bool, typer.Option("--run/--no-run", help="Fly the scenario, if there is one, and show it.")
    ] = True,
) -> None:
    """Find an array's singular surfaces, its envelope and the momentum it can rely on."""
    _checked_figure(figure)
    options.load_law_file(law_file)
    loaded = load(array, settings)
    target = options.writable(out or Path("out") / f"{loaded.name}-atlas")
    found = work_out(loaded)
    flown = fly(loaded) if run else None
    show(found, loaded)
    write(found, loaded, flown, target, figure)
    typer.echo(f"Results in {target} (open {PAGE})")


def load(array: str, settings: list[str] | None) -> ArrayFile:
    """Return the array of a file or of a scenario's name."""
    from nullmotion.scenario.array_file import array_file
    from nullmotion.scenario.load import find

    source = find(array)
    values = options.values(settings, None)
    return array_file(source.over(values) if values else source)


def work_out(loaded: ArrayFile) -> Analysis:
    """Return the analysis, with a progress bar if it takes long."""
    with screen.progress(f"Analysing {loaded.title}") as progress:
        from nullmotion.atlas.analysis import analyse

        return analyse(loaded.array, progress=progress)


def fly(loaded: ArrayFile) -> Trajectory | None:
    """Return the run of the file's scenario; None where it has none."""
    if loaded.scenario is None:
        return None
    from nullmotion.cli import run

    return run.fly(loaded.scenario)


def write(
    found: Analysis, loaded: ArrayFile, flown: Trajectory | None, target: Path, figure: str | None
) -> None:
    """Write all files, or none."""
    from nullmotion.report.atlas_page import atlas_page
    from nullmotion.scenario.files import replacing

    owned = (RESULT, PAGE, *FIGURES.values()) if (target / RESULT).is_file() else ()
    with replacing(target, owned) as new:
        (new / RESULT).write_text(found.to_json(), encoding="utf-8")
        text = loaded.source.effective_text()
        atlas_page(found, new / PAGE, loaded.title, loaded.home, flown, text)
        if figure is not None:
            _draw(found, loaded, flown, new / FIGURES[figure])
