"""``nullmotion compare``: laws x metrics on one scenario."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from nullmotion.cli import comparison_table, options, screen

if TYPE_CHECKING:
    from nullmotion.campaign import Comparison
    from nullmotion.scenario import Scenario

OWNED = ("compare.json", "compare.png", "compare.html", "report.html")


def compare(
    scenario: options.ScenarioArgument,
    laws: Annotated[
        str | None,
        typer.Option(
            "--laws",
            metavar="A,B,C",
            help="Laws to run on defaults in place of the file's compare cases.",
        ),
    ] = None,
    vary: Annotated[
        str | None,
        typer.Option(
            "--vary",
            metavar="KEY=A:B:STEP",
            help="A key and its values: array.skew_deg=40:60:1 or =40,50.",
        ),
    ] = None,
    out: options.Out = None,
    settings: options.Settings = None,
    law_file: options.LawFile = None,
    seed: options.Seed = None,
) -> None:
    """Compare steering laws on one scenario."""
    own, _ = options.load_law_file(law_file)
    loaded = options.load(scenario, options.values(settings, seed))
    names = None if laws is None else [name.strip() for name in laws.split(",")]
    target = options.writable(out or Path("out") / f"{loaded.name}-compare")
    comparison = fly(loaded, names, vary, own)
    write(comparison, target, figure=True)
    console = screen.console()
    for made in comparison_table.tables(comparison):
        console.print(made)
    typer.echo(f"Results in {target} (open report.html)")


def fly(
    scenario: Scenario,
    names: Sequence[str] | None,
    vary: str | None = None,
    more: Sequence[str] = (),
) -> Comparison:
    """Return the comparison, with a progress bar if it takes long."""
    from nullmotion.campaign.compare import compare as run_cases
    from nullmotion.campaign.vary import parse

    varied = None if vary is None else parse(vary)
    with screen.progress(f"Comparing laws on {scenario.name}") as progress:
        return run_cases(scenario, names, varied, progress, more)


def write(comparison: Comparison, target: Path, figure: bool) -> None:
    """Write a comparison's files, all of them or none."""
    from nullmotion.campaign.compare import write as write_json
    from nullmotion.report.compare import compare_report
    from nullmotion.scenario.files import replacing

    owned = OWNED if (target / "compare.json").is_file() else ()
    with replacing(target, owned) as new:
        write_json(comparison, new)
        compare_report(comparison, new / "report.html", comparison.title)
        if figure and any(case.trajectory is not None for case in comparison.cases):
            from nullmotion.plot.figures import compare_figure

            compare_figure(comparison, new / "compare.png", comparison.title)
