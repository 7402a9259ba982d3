"""``nullmotion analyze``: the singularities of an array, and what it can rely on."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from nullmotion.cli import analyze_screen, options, screen

if TYPE_CHECKING:
    from nullmotion.atlas.analysis import Analysis
    from nullmotion.scenario.array_file import ArrayFile
    from nullmotion.sim import Trajectory

RESULT, PAGE = "analysis.json", "atlas.html"
FIGURES = ("pdf", "png", "svg")
_LEVEL = 0.5


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
    gimbal: Annotated[
        str | None,
        typer.Option(
            "--gimbal-deg",
            metavar="A,B,...",
            help="Gimbal angles to look at: singular or not, and what null motion can do. The "
            "scenario's start by default.",
        ),
    ] = None,
    level: Annotated[
        float,
        typer.Option(
            "--torque-capability",
            help="Torque of the guaranteed radius, over h0 times the rate limit.",
        ),
    ] = _LEVEL,
    figure: Annotated[
        str | None, typer.Option("--figure", metavar="pdf|png|svg", help="Draw a figure as well.")
    ] = None,
    quick: Annotated[
        bool, typer.Option("--quick", help="Leave out volume, failed CMGs and torque maps.")
    ] = False,
    run: Annotated[
        bool, typer.Option("--run/--no-run", help="Fly the scenario, if there is one, and show it.")
    ] = True,
    settings: options.Settings = None,
    law_file: options.LawFile = None,
) -> None:
    """Find an array's singular surfaces, its envelope and the momentum it can rely on."""
    _checked_figure(figure)
    names, _ = options.load_law_file(law_file)
    loaded = load(array, settings, names)
    start = angles(gimbal, loaded)
    target = options.writable(out or Path("out") / f"{loaded.name}-atlas")
    flown = fly(loaded) if run else None
    found = work_out(loaded, start, level, quick)
    write(found, loaded, flown, target, figure)
    analyze_screen.show(found, loaded.title)
    typer.echo(f"Results in {target} (open {PAGE})")


def load(array: str, settings: list[str] | None, law_names: list[str]) -> ArrayFile:
    """Return the array of a file or of a scenario's name."""
    from nullmotion.scenario.array_file import FLOWN, array_file
    from nullmotion.scenario.load import find

    source = find(array)
    values = options.values(settings, None)
    if any(name in source.data for name in FLOWN):
        return array_file(options.load(array, values, law_names).source)
    return array_file(source.over(values) if values else source)


def angles(gimbal: str | None, loaded: ArrayFile) -> Any:
    """Return the gimbal angles to look at [rad], (n,).

    Raises:
        InputError: For text that is not one number for each CMG.
    """
    import numpy as np

    from nullmotion.errors import InputError

    if gimbal is None:
        return loaded.start
    allowed = f"{loaded.array.n} angles in degrees, parted by commas"
    try:
        found = np.array([float(word) for word in gimbal.split(",")])
    except ValueError:
        raise InputError("--gimbal-deg", gimbal, allowed) from None
    if found.shape != (loaded.array.n,) or not np.isfinite(found).all():
        raise InputError("--gimbal-deg", gimbal, allowed)
    return np.radians(found)


def work_out(loaded: ArrayFile, start: Any, level: float, quick: bool) -> Analysis:
    """Return the analysis, with a progress bar if it takes long."""
    from nullmotion.atlas.analysis import analyse
    from nullmotion.errors import InputError

    if not 0 < level < float("inf"):
        raise InputError("--torque-capability", level, "a number above 0")
    with screen.progress(f"Analysing {loaded.title}") as progress:
        return analyse(loaded.array, start, (level,), quick, progress)


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
    from nullmotion.plot.atlas import atlas_figure
    from nullmotion.report.analysis import analysis_page, shown
    from nullmotion.scenario.files import replacing

    home = loaded.start if found.state is None else found.state.delta
    scene = shown(found, home, flown)  # type: ignore[arg-type]
    figures = [f"atlas.{kind}" for kind in FIGURES]
    owned = (RESULT, PAGE, *figures) if (target / RESULT).is_file() else ()
    with replacing(target, owned) as new:
        (new / RESULT).write_text(found.to_json(), encoding="utf-8")
        text = loaded.source.effective_text()
        analysis_page(new / PAGE, loaded.title, found, scene, flown, text)  # type: ignore[arg-type]
        if figure is not None and scene is not None:
            atlas_figure(scene, new / f"atlas.{figure}", loaded.title)


def _checked_figure(figure: str | None) -> None:
    from nullmotion.errors import InputError

    if figure is not None and figure not in FIGURES:
        raise InputError("--figure", figure, f"one of {', '.join(FIGURES)}")
